#pragma once
/// E of a law of the vertical force and its exact gradient.

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <crashsim/identify_vertical.hpp>

#include "optimize/sought_numbers.hpp"

namespace crashsim {

/// What is known at one time of the vertical force.
struct VerticalSample {
  double vertical_n = kUnset, longitudinal_n = kUnset, crush_m = kUnset;
};

/// E = factor * sum over samples of loss(scale * residual).
struct VerticalFitTarget {
  std::vector<VerticalSample> samples;
  double scale = kUnset, factor = kUnset;  ///< 1 / max|F_v| and 1 / count.
  double largest_crush_m = kUnset;
};

/// @throws InvalidInput when a series is bad, they have no common samples in the window, or nothing can be said.
VerticalFitTarget make_vertical_target(const VerticalForceTarget& target, const IdentifyVerticalOptions& options);

using VerticalParameter = SoughtNumber<VerticalForceLaw>;

/// Reads options.free with its bounds. Notes in `warnings` where the given law lies outside.
/// @throws InvalidInput naming the name or bound that is not allowed.
std::vector<VerticalParameter> vertical_parameters(const VerticalForceLaw& guess, double largest_crush_m,
                                                   const IdentifyVerticalOptions& options,
                                                   std::vector<std::string>& warnings);

/// E over the values of the parameters. Holds nothing that changes: one object serves all threads.
class VerticalObjective {
 public:
  VerticalObjective(const VerticalForceLaw& law, const VerticalFitTarget& target,
                    std::span<const VerticalParameter> parameters, Loss loss)
      : law_(law), target_(target), parameters_(parameters), loss_(loss) {}

  /// E, and its gradient when `gradient` is not empty; infinite when an angle is beyond kSteepestAngle without
  /// friction.
  /// @param smoothing rounding of the corner of |u|, relative to the largest force; 0 for the true loss.
  double evaluate(std::span<const double> values, double smoothing, std::span<double> gradient) const;

  /// Derivatives of the scaled residuals by the parameters, a row for each sample; weighted as in E with the squared
  /// loss.
  [[nodiscard]] Eigen::MatrixXd jacobian(std::span<const double> values) const;

 private:
  VerticalForceLaw law_;
  const VerticalFitTarget& target_;
  std::span<const VerticalParameter> parameters_;
  Loss loss_;
};

}  // namespace crashsim
