#include "optimize/fit_errors.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include "optimize/test_corrections.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

using NuisanceRows = std::function<Eigen::MatrixXd(const std::vector<FitTarget>& targets)>;

/// Corrects the targets by the errors of the tests that were found. @returns their rows; none when none were sought.
NuisanceRows nuisance_of(FitStudy& study, std::span<const Pulse> pulses, const Identification& fit) {
  const SoughtCorrections sought(study.options, pulses.size());
  if (sought.empty()) return {};
  std::vector<double> found;
  for (std::size_t i = 0; i < sought.size(); ++i) {
    const auto value = sought.reported(i).value;
    found.push_back(fit.tests[sought.test_of(i)].*value - (value == &TestReport::gain ? 1.0 : 0.0));
  }
  const FitStudy measured = study;
  for (std::size_t t = 0; t < pulses.size(); ++t)
    study.targets[t] = corrected(measured.targets[t], pulses[t], sought.of_test(found, t));
  return [measured, sought, found, pulses](const std::vector<FitTarget>& scaled) {
    FitStudy with_scales = measured;
    for (std::size_t t = 0; t < scaled.size(); ++t) {
      with_scales.targets[t].accel_scale = scaled[t].accel_scale;
      with_scales.targets[t].velocity_scale = scaled[t].velocity_scale;
      with_scales.targets[t].displacement_scale = scaled[t].displacement_scale;
    }
    const Eigen::MatrixXd samples = correction_jacobian(with_scales, pulses, sought, found);
    const Eigen::MatrixXd expected = correction_rows(with_scales, sought);
    Eigen::MatrixXd rows(samples.rows() + expected.rows(), samples.cols());
    rows << samples, expected;
    return rows;
  };
}

}  // namespace

OrdinateState state_of(const OrdinateReport& ordinate, double smooth) {
  if (ordinate.untouched && smooth == 0.0) return OrdinateState::untouched;  // else the smoothing says what it is
  return ordinate.at_bound ? OrdinateState::at_bound : OrdinateState::free;
}

LinearFit linear_fit_of(std::span<const Pulse> pulses, const Identification& fit, FitStudy& study) {
  Eigen::VectorXd theta(static_cast<Index>(fit.ordinates.size()));
  std::vector<bool> is_free;
  for (std::size_t i = 0; i < fit.ordinates.size(); ++i) {
    const OrdinateReport& ordinate = fit.ordinates[i];
    const auto at = static_cast<Index>(i);
    theta[at] = ordinate.value - (ordinate.upper_bound - study.upper[at]);  // of a free knot: from its lowest place
    is_free.push_back(state_of(ordinate, fit.smooth) == OrdinateState::free);
  }
  if (!std::isnan(fit.smooth)) study.smooth = fit.smooth;
  const NuisanceRows nuisance = nuisance_of(study, pulses, fit);
  return linearise(study, theta, is_free, nuisance);
}

void tell_standard_errors(std::span<const Pulse> pulses, FitStudy study, Identification& fit) {
  const Eigen::MatrixXd covariance = covariance_of(linear_fit_of(pulses, fit, study));
  const Eigen::MatrixXd correlation = correlation_of(covariance);
  fit.correlation.clear();
  for (Index i = 0; i < covariance.rows(); ++i) {
    OrdinateReport& ordinate = fit.ordinates[static_cast<std::size_t>(i)];
    const bool is_free = state_of(ordinate, fit.smooth) == OrdinateState::free;
    ordinate.standard_error = is_free ? std::sqrt(covariance(i, i)) : kUnset;
    fit.correlation.emplace_back(correlation.row(i).begin(), correlation.row(i).end());
  }
}

}  // namespace crashsim
