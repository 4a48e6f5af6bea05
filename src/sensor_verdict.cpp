#include "sensor_verdict.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <crashsim/option_values.hpp>

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = SensorUnknown;

constexpr double kImplausible = 3.0;  // standard deviations
constexpr double kMostlyPrior = 0.5;  // of the prior's standard deviation that is left

std::string_view word_for(Kind kind) {
  if (kind == Kind::bias) return "bias";
  return kind == Kind::time_shift ? "time shift" : "gain";
}

std::string owner_of(const SensorParameter& parameter, const SensorCorrection& out) {
  return parameter.kind == Kind::wall_gain ? "the wall" : "channel " + out.channels[parameter.channel].channel;
}

/// "bias 7.1 m/s^2", "gain 1.08", "time shift 0.4 ms".
std::string shown(const SensorParameter& parameter, double units) {
  const double change = units * parameter.prior_sd;
  if (parameter.kind == Kind::bias) return fmt::format("bias {:.3g} m/s^2", change);
  if (parameter.kind == Kind::time_shift) return fmt::format("time shift {:.3g} ms", 1e3 * change);
  return fmt::format("gain {:.4g}", 1.0 + change);
}

/// Of the unknowns in their prior standard deviations.
MatrixXd covariance_at(const SensorEquations& equations, std::span<const double> units) {
  const auto n = static_cast<Index>(units.size());
  std::vector<double> gradient(units.size());
  MatrixXd hessian;
  equations.evaluate(units, gradient, hessian);
  return (0.5 * hessian).llt().solve(MatrixXd::Identity(n, n));
}

void take_numbers(const SensorProblem& problem, std::span<const double> units, const MatrixXd& covariance,
                  SensorCorrection& out) {
  for (std::size_t j = 0; j < units.size(); ++j) {
    const SensorParameter& parameter = problem.parameters[j];
    const auto at = static_cast<Index>(j);
    const double change = units[j] * parameter.prior_sd;
    const double error = std::sqrt(covariance(at, at)) * parameter.prior_sd;
    ChannelCorrection& channel = out.channels[parameter.channel];
    switch (parameter.kind) {
      case Kind::bias:
        channel.bias_mps2 = change;
        channel.bias_error_mps2 = error;
        break;
      case Kind::gain:
        channel.gain = 1.0 + change;
        channel.gain_error = error;
        break;
      case Kind::time_shift:
        channel.time_shift_s = change;
        channel.time_shift_error_s = error;
        break;
      case Kind::wall_gain:
        out.wall_gain = 1.0 + change;
        out.wall_gain_error = error;
        break;
    }
    if (std::abs(units[j]) > kImplausible)
      out.warnings.push_back(
          fmt::format("{}: {} is {:.1f} of its prior standard deviations: look at the channel, and at what it is "
                      "compared with",
                      owner_of(parameter, out), shown(parameter, units[j]), std::abs(units[j])));
  }
}

std::string name_of(const SensorCondition& condition) {
  if (condition.kind == SensorCondition::Kind::velocity) return fmt::format("velocity at {:g} s", condition.time_s);
  if (condition.kind == SensorCondition::Kind::rebound) return "rebound velocity";
  return fmt::format("velocity at {:g} s by the wall's impulse", condition.time_s);
}

/// @param wall_sd prior standard deviation of the wall's gain.
void take_conditions(const SensorEquations& equations, const SensorState& state, double wall_sd,
                     SensorCorrection& out) {
  const SensorProblem& problem = equations.problem();
  const std::vector<SensorModel> untouched(state.channels.size());
  const std::vector<double> before = common_acceleration(problem.signals, untouched);
  const std::vector<double> after = common_acceleration(problem.signals, state.channels);
  for (const SensorCondition& condition : problem.conditions) {
    CorrectionCondition told;
    told.name = name_of(condition);
    told.known_mps = equations.known_velocity(condition, 1.0);
    told.standard_deviation_mps = problem.velocity_sd_mps;
    if (condition.kind == SensorCondition::Kind::impulse)
      told.standard_deviation_mps =
          std::hypot(problem.velocity_sd_mps, wall_sd * (problem.impact_speed_mps - told.known_mps));
    told.before_mps = equations.velocity_of(condition, before);
    told.after_mps = equations.velocity_of(condition, after);
    const double missed = std::abs(told.after_mps - told.known_mps) / told.standard_deviation_mps;
    if (missed > kImplausible)
      out.warnings.push_back(
          fmt::format("{}: known as {:.4g} m/s, but the corrected channels say {:.4g} m/s, {:.1f} of its standard "
                      "deviations away: look at the channels, at speed and at time zero",
                      told.name, told.known_mps, told.after_mps, missed));
    out.conditions.push_back(std::move(told));
  }
}

/// Share of the prior's standard deviation that is left along a direction.
double left_along(const MatrixXd& covariance, const VectorXd& direction) {
  return std::sqrt(direction.dot(covariance * direction) / direction.squaredNorm());
}

void tell_when_by_prior(const std::string& what, double left, SensorCorrection& out) {
  if (left > kMostlyPrior)
    out.by_prior.push_back(fmt::format("{}: {:.0f} % of its prior standard deviation is left", what, 100.0 * left));
}

/// What all channels have in common, then what they differ by.
void take_priors(const SensorProblem& problem, const MatrixXd& covariance, SensorCorrection& out) {
  const std::size_t channels = out.channels.size();
  for (const Kind kind : {Kind::bias, Kind::gain, Kind::time_shift}) {
    VectorXd common = VectorXd::Zero(covariance.rows());
    for (std::size_t j = 0; j < problem.parameters.size(); ++j)
      if (problem.parameters[j].kind == kind) common[static_cast<Index>(j)] = 1.0;
    if (common.isZero()) continue;
    if (channels == 1) {
      tell_when_by_prior(fmt::format("{} of the channel", word_for(kind)), left_along(covariance, common), out);
      continue;
    }
    double most = 0.0;
    for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
      if (problem.parameters[j].kind != kind) continue;
      VectorXd own = -common / static_cast<double>(channels);
      own[static_cast<Index>(j)] += 1.0;
      most = std::max(most, left_along(covariance, own));
    }
    tell_when_by_prior(fmt::format("{} common to all channels", word_for(kind)), left_along(covariance, common), out);
    tell_when_by_prior(fmt::format("{} of each channel against the others", word_for(kind)), most, out);
  }
  for (std::size_t j = 0; j < problem.parameters.size(); ++j)
    if (problem.parameters[j].kind == Kind::wall_gain)
      tell_when_by_prior("gain of the wall",
                         left_along(covariance, VectorXd::Unit(covariance.rows(), static_cast<Index>(j))), out);
}

}  // namespace

void take_corrections(const SensorEquations& equations, std::span<const double> units, SensorCorrection& out) {
  const SensorProblem& problem = equations.problem();
  const SensorState state = equations.state(units);
  const MatrixXd covariance = covariance_at(equations, units);
  double wall_sd = 0.0;
  for (const SensorParameter& parameter : problem.parameters)
    if (parameter.kind == Kind::wall_gain) wall_sd = parameter.prior_sd;
  take_numbers(problem, units, covariance, out);
  take_conditions(equations, state, wall_sd, out);
  take_priors(problem, covariance, out);
  if (!std::isnan(equations.noise().variance)) {
    out.noise_mps2 = std::sqrt(equations.noise().variance);
    out.correlation_time_s = equations.noise().samples * problem.signals.dt_s;
  }
  if (problem.conditions.empty() && !problem.compares_wall)
    out.warnings.push_back(
        "channels are compared with each other only: what they have in common is not corrected; give a velocity that "
        "is known or a wall");
}

}  // namespace crashsim
