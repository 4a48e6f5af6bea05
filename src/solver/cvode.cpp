#include "solver/cvode.hpp"

#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <new>
#include <utility>

#include <fmt/format.h>

namespace crashsim {
namespace {

template <class T>
T* require(T* p) {
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

SUNContext new_context() {
  SUNContext context = nullptr;
  if (sundials::create_context(&context) != 0) throw std::bad_alloc();
  return context;
}

void silent(int, const char*, const char*, char*, void*) {}  // every return code is checked instead

}  // namespace

Cvode::Cvode(int length, Rhs rhs, NewVector new_vector)
    : rhs_(std::move(rhs)),
      context_(new_context()),
      state_(require(new_vector(length, context_.get()))),
      atol_(require(new_vector(length, context_.get()))),
      derivative_(require(new_vector(length, context_.get()))),
      memory_(require(CVodeCreate(CV_ADAMS, context_.get()))),
      nonlinear_solver_(require(SUNNonlinSol_FixedPoint(state_.get(), 0, context_.get()))) {
#if SUNDIALS_VERSION_MAJOR < 7
  check(CVodeSetErrHandlerFn(memory_.get(), silent, nullptr), "CVodeSetErrHandlerFn");
#else
  SUNContext_ClearErrHandlers(context_.get());
#endif
}

void Cvode::set_tolerances(double rtol, std::span<const double> atol) {
  rtol_ = rtol;
  std::copy(atol.begin(), atol.end(), N_VGetArrayPointer(atol_.get()));
}

void Cvode::set_weights(std::span<const double> weights) { weights_.assign(weights.begin(), weights.end()); }

void Cvode::set_iteration_error(double fraction) {
  check(CVodeSetNonlinConvCoef(memory_.get(), fraction), "CVodeSetNonlinConvCoef");
}

void Cvode::set_least_growth(double factor) {
  check(CVodeSetEtaFixedStepBounds(memory_.get(), 0.0, factor), "CVodeSetEtaFixedStepBounds");
}

void Cvode::set_stop_time(double t) { check(CVodeSetStopTime(memory_.get(), t), "CVodeSetStopTime"); }

void Cvode::start(double t, std::span<const double> y, double first_step) {
  std::copy(y.begin(), y.end(), N_VGetArrayPointer(state_.get()));
  time_ = t;
  void* memory = memory_.get();
  if (initialised_) {
    check(CVodeReInit(memory, t, state_.get()), "CVodeReInit");
  } else {
    check(CVodeInit(memory, rhs_callback, t, state_.get()), "CVodeInit");
    if (weights_.empty())
      check(CVodeSVtolerances(memory, rtol_, atol_.get()), "CVodeSVtolerances");
    else
      check(CVodeWFtolerances(memory, weights_callback), "CVodeWFtolerances");
    check(CVodeSetUserData(memory, this), "CVodeSetUserData");
    check(CVodeSetNonlinearSolver(memory, nonlinear_solver_.get()), "CVodeSetNonlinearSolver");
    initialised_ = true;
  }
  check(CVodeSetInitStep(memory, first_step), "CVodeSetInitStep");
}

double Cvode::step() {
  constexpr double kFarAway = 1e30;  // only its direction counts in one-step mode
  const int flag = CVode(memory_.get(), kFarAway, state_.get(), &time_, CV_ONE_STEP);
  if (pending_) std::rethrow_exception(std::exchange(pending_, nullptr));
  check(flag, "CVode");
  return time_;
}

std::span<const double> Cvode::state() const {
  return {N_VGetArrayPointer(state_.get()), static_cast<std::size_t>(N_VGetLength(state_.get()))};
}

double Cvode::last_step() const {
  double h = 0.0;
  check(CVodeGetLastStep(memory_.get(), &h), "CVodeGetLastStep");
  return h;
}

int Cvode::last_order() const {
  int order = 0;
  check(CVodeGetLastOrder(memory_.get(), &order), "CVodeGetLastOrder");
  return order;
}

std::span<const double> Cvode::derivative(double t, int k) {
  check(CVodeGetDky(memory_.get(), t, k, derivative_.get()), "CVodeGetDky");
  return {N_VGetArrayPointer(derivative_.get()), state().size()};
}

int Cvode::rhs_callback(sunrealtype t, N_Vector y, N_Vector ydot, void* self) noexcept {
  auto& me = *static_cast<Cvode*>(self);
  ++me.rhs_evaluations_;
  try {
    me.rhs_(t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot));
    return 0;
  } catch (...) {
    me.pending_ = std::current_exception();
    return -1;
  }
}

int Cvode::weights_callback(N_Vector, N_Vector weights, void* self) noexcept {
  const auto& me = *static_cast<Cvode*>(self);
  std::copy(me.weights_.begin(), me.weights_.end(), N_VGetArrayPointer(weights));
  return 0;
}

void Cvode::check(int flag, const char* call) const {
  if (flag >= 0) return;
  if (flag == CV_MEM_NULL || flag == CV_MEM_FAIL) throw std::bad_alloc();
  char* name = CVodeGetReturnFlagName(flag);
  const std::string text = fmt::format("{} failed with {} at t = {} s", call, name, time_);
  std::free(name);
  throw SolverError(text);
}

}  // namespace crashsim
