#pragma once
/// E of a heave-pitch model and its exact gradient.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/pitch_parameters.hpp"
#include "optimize/pitch_sensitivity.hpp"
#include "optimize/pitch_target.hpp"

namespace crashsim {

/// E over the values of the parameters. Holds nothing that changes: one object serves all threads.
class PitchObjective {
 public:
  PitchObjective(const HeavePitchModel& model, const PitchForcing& forcing, const PitchFitTarget& target,
                 std::span<const PitchParameter> parameters, Loss loss);

  /// E, and its gradient when `gradient` is not empty; infinite when the motion grows beyond all bounds.
  /// @param smoothing rounding of the corner of |u|, relative to each channel's largest; 0 for the true loss.
  double evaluate(std::span<const double> values, double smoothing, std::span<double> gradient) const;

  /// Derivatives of the scaled residuals by the parameters, a row for each sample; weighted as in E with the squared
  /// loss.
  [[nodiscard]] Eigen::MatrixXd jacobian(std::span<const double> values) const;

 private:
  /// Calls visit(index of the sample, state) at each, with the derivatives by parameters [first, first + count).
  template <class Visit>
  void walk(std::span<const double> values, std::size_t first, std::size_t count, Visit visit) const;

  HeavePitchModel model_;
  const PitchFitTarget& target_;
  std::span<const PitchParameter> parameters_;
  Loss loss_;
  PitchSteps steps_;
};

}  // namespace crashsim
