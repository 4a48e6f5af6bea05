#include "optimize/nlopt_minimize.hpp"

#include <nlopt.h>

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

}  // namespace crashsim
