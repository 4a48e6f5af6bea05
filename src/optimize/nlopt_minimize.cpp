#include "optimize/nlopt_minimize.hpp"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include <fmt/format.h>

namespace crashsim {
namespace {

nlopt_algorithm nlopt_name(Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::slsqp:
      return NLOPT_LD_SLSQP;
    case Algorithm::tnewton:
      return NLOPT_LD_TNEWTON_PRECOND_RESTART;
    case Algorithm::var2:
      return NLOPT_LD_VAR2;
    case Algorithm::lbfgs:
      break;
  }
  return NLOPT_LD_LBFGS;
}

struct OptimiserDeleter {
  void operator()(nlopt_opt p) const noexcept { nlopt_destroy(p); }
};
using Optimiser = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, OptimiserDeleter>;

/// What the C callback works on: the function, the best point so far, and an exception on its way out.
struct Call {
  const GradientFunction& function;
  nlopt_opt optimiser;
  Minimum best;
  std::vector<double> unused_gradient;
  std::exception_ptr pending;
};

double evaluate(unsigned n, const double* x, double* gradient, void* data) noexcept {
  Call& call = *static_cast<Call*>(data);
  if (call.pending) return std::numeric_limits<double>::infinity();  // some algorithms look once more before they stop
  try {
    double* out = gradient != nullptr ? gradient : call.unused_gradient.data();
    const double value = call.function({x, n}, {out, n});
    ++call.best.evaluations;
    if (call.best.evaluations == 1 && !std::isfinite(value)) nlopt_force_stop(call.optimiser);  // no way down from here
    if (std::isnan(call.best.value) || value < call.best.value) {
      call.best.value = value;
      call.best.point.assign(x, x + n);
    }
    return value;
  } catch (...) {
    call.pending = std::current_exception();
    nlopt_force_stop(call.optimiser);
    return std::numeric_limits<double>::infinity();
  }
}

void check(nlopt_result result, const char* what) {
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result == NLOPT_INVALID_ARGS) throw NumericalFailure(fmt::format("NLopt refused {}", what));
}

constexpr double kMargin = 1e-7;  // kept from constraints

/// What the callbacks of a constrained search work on. Objective and constraints are asked for one after the other at
/// the same point: both come from one evaluation.
class ConstrainedCall {
 public:
  ConstrainedCall(const ConstrainedFunction& function, nlopt_opt optimiser, std::size_t unknowns,
                  std::size_t constraints)
      : function_(function), optimiser_(optimiser), values_(1 + constraints), gradients_(values_.size() * unknowns) {}

  static double objective(unsigned n, const double* x, double* gradient, void* data) noexcept {
    ConstrainedCall& call = *static_cast<ConstrainedCall*>(data);
    if (!call.move_to({x, n}, gradient != nullptr)) return std::numeric_limits<double>::infinity();
    if (gradient != nullptr) std::copy_n(call.gradients_.begin(), n, gradient);
    return call.values_.front();
  }

  static void constraints(unsigned m, double* result, unsigned n, const double* x, double* gradient,
                          void* data) noexcept {
    ConstrainedCall& call = *static_cast<ConstrainedCall*>(data);
    if (!call.move_to({x, n}, gradient != nullptr)) {
      std::fill_n(result, m, 1.0);
      return;
    }
    for (unsigned i = 0; i < m; ++i) result[i] = call.values_[i + 1] + kMargin;
    if (gradient != nullptr) std::copy(call.gradients_.begin() + n, call.gradients_.end(), gradient);
  }

  /// The best point. @throws what the function threw.
  ConstrainedMinimum finish() {
    if (pending_) std::rethrow_exception(std::exchange(pending_, nullptr));
    return std::move(best_);
  }

 private:
  /// Values, and if asked for gradients, of a point. False when there are none.
  bool move_to(std::span<const double> x, bool with_gradients) noexcept {
    if (pending_) return false;
    const bool is_here = std::ranges::equal(point_, x);
    if (is_here && (has_gradients_ || !with_gradients)) return true;
    try {
      point_.assign(x.begin(), x.end());
      has_gradients_ = with_gradients;
      function_(x, values_, with_gradients ? std::span<double>(gradients_) : std::span<double>());
      ++evaluations_;
      note_best();
      return true;
    } catch (...) {
      pending_ = std::current_exception();
      nlopt_force_stop(optimiser_);
      return false;
    }
  }

  void note_best() {
    ConstrainedMinimum here{point_, values_.front(), 0.0, evaluations_};
    if (values_.size() > 1) here.violation = *std::max_element(values_.begin() + 1, values_.end());
    if (best_.point.empty() || is_better(here, best_)) best_ = std::move(here);
    best_.evaluations = evaluations_;
  }

  const ConstrainedFunction& function_;
  nlopt_opt optimiser_;
  std::vector<double> point_, values_, gradients_;
  bool has_gradients_ = false;
  int evaluations_ = 0;
  ConstrainedMinimum best_;
  std::exception_ptr pending_;
};

}  // namespace

Minimum minimize_in_unit_box(Algorithm algorithm, const GradientFunction& function, std::span<const double> start,
                             double ftol_rel, int max_evaluations) {
  const auto n = static_cast<unsigned>(start.size());
  Optimiser optimiser(nlopt_create(nlopt_name(algorithm), n));
  if (!optimiser) throw std::bad_alloc();
  Call call{function, optimiser.get(), {}, std::vector<double>(n), nullptr};
  check(nlopt_set_lower_bounds1(optimiser.get(), 0.0), "lower bounds");
  check(nlopt_set_upper_bounds1(optimiser.get(), 1.0), "upper bounds");
  check(nlopt_set_min_objective(optimiser.get(), evaluate, &call), "objective");
  check(nlopt_set_ftol_rel(optimiser.get(), ftol_rel), "ftol_rel");
  check(nlopt_set_maxeval(optimiser.get(), max_evaluations), "maxeval");
  std::vector<double> point(start.begin(), start.end());
  double value = kUnset;
  // Rounding limits and failed line searches near the optimum are no errors: the best point seen counts.
  const nlopt_result result = nlopt_optimize(optimiser.get(), point.data(), &value);
  if (call.pending) std::rethrow_exception(std::exchange(call.pending, nullptr));
  check(result, "the problem");
  return call.best;
}

bool is_better(const ConstrainedMinimum& a, const ConstrainedMinimum& b) {
  if (std::isfinite(a.value) != std::isfinite(b.value)) return std::isfinite(a.value);
  const bool a_keeps = a.violation <= 0.0, b_keeps = b.violation <= 0.0;
  if (a_keeps != b_keeps) return a_keeps;
  return a_keeps ? a.value < b.value : a.violation < b.violation;
}

ConstrainedMinimum minimize_constrained(ConstrainedAlgorithm algorithm, const ConstrainedFunction& function,
                                        std::size_t constraints, std::span<const double> start, double ftol_rel,
                                        int max_evaluations, double initial_step) {
  const auto n = static_cast<unsigned>(start.size());
  Optimiser optimiser(nlopt_create(algorithm == ConstrainedAlgorithm::slsqp ? NLOPT_LD_SLSQP : NLOPT_LN_COBYLA, n));
  if (!optimiser) throw std::bad_alloc();
  nlopt_opt opt = optimiser.get();
  ConstrainedCall call(function, opt, n, constraints);
  check(nlopt_set_lower_bounds1(opt, 0.0), "lower bounds");
  check(nlopt_set_upper_bounds1(opt, 1.0), "upper bounds");
  check(nlopt_set_min_objective(opt, ConstrainedCall::objective, &call), "objective");
  if (constraints > 0)
    check(nlopt_add_inequality_mconstraint(opt, static_cast<unsigned>(constraints), ConstrainedCall::constraints, &call,
                                           nullptr),
          "constraints");
  check(nlopt_set_ftol_rel(opt, ftol_rel), "ftol_rel");
  check(nlopt_set_xtol_abs1(opt, ftol_rel), "xtol_abs");
  check(nlopt_set_maxeval(opt, max_evaluations), "maxeval");
  check(nlopt_set_initial_step1(opt, initial_step), "initial step");
  std::vector<double> point(start.begin(), start.end());
  double value = kUnset;
  const nlopt_result result = nlopt_optimize(opt, point.data(), &value);
  ConstrainedMinimum best = call.finish();
  check(result, "the problem");
  return best;
}

}  // namespace crashsim
