#pragma once
/// A coupled model as a function of its design parameters.

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "optimize/design_parameters.hpp"
#include "optimize/nlopt_minimize.hpp"

namespace crashsim {

/// What to minimise under which limits.
struct DesignGoal {
  DesignQuantity minimise;
  double scale;  ///< Of that quantity, > 0.
  std::vector<QuantityLimit> limits;
};

/// Derivatives of all responses, in the order of kDesignResponses, by one parameter.
struct ResponseSlopes {
  std::array<double, kDesignResponses.size()> value, error;
};

class DesignProblem {
 public:
  /// @param simulation its rtol is set here.
  DesignProblem(CoupledModel model, const CoupledOptions& simulation, std::vector<DesignParameter> parameters);

  /// Model at a point of the unit box, between the parameters' bounds.
  [[nodiscard]] CoupledModel model_at(std::span<const double> point) const;
  [[nodiscard]] CoupledResponse simulate(const CoupledModel& model) const;
  /// Where the given model is, or the point nearest to it.
  [[nodiscard]] std::vector<double> given_point() const;

  /// Quantity / scale, and limited quantities / limit - 1, with gradients by central differences; inside the box, so
  /// one-sided at its faces.
  [[nodiscard]] ConstrainedFunction function(const DesignGoal& goal) const;

  /// Derivatives at the given model: differences extrapolated to a step of 0. Their error is what the extrapolation
  /// tells, and at least the accuracy of the runs over the finest step.
  [[nodiscard]] ResponseSlopes slopes(const DesignParameter& parameter) const;

  [[nodiscard]] const std::vector<DesignParameter>& parameters() const { return parameters_; }
  [[nodiscard]] long simulations() const { return simulations_; }

 private:
  void evaluate(const DesignGoal& goal, std::span<const double> point, std::span<double> values) const;
  [[nodiscard]] DesignResponses responses_with(const DesignParameter& parameter, double value) const;

  CoupledModel model_;
  CoupledOptions simulation_;
  std::vector<DesignParameter> parameters_;
  mutable std::atomic<long> simulations_ = 0;
};

}  // namespace crashsim
