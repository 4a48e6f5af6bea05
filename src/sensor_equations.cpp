#include "sensor_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of the largest acceleration: what the finest sensor resolves. Less would make the priors vanish in rounding.
constexpr double kLeastNoise = 1e-5;

/// Noise about `spent` unknowns that were fitted to the same samples.
NoiseLevel corrected_for(NoiseLevel noise, std::size_t samples, std::size_t series, double spent, double least) {
  const double independent = static_cast<double>(samples) / noise.samples;
  const double freedom = static_cast<double>(series) * std::max(independent - spent, 1.0);
  noise.variance = std::max(noise.variance * independent / freedom, least);
  return noise;
}

/// Series of equal length that stand one after the other.
std::vector<std::vector<double>> as_series(const VectorXd& all, std::size_t length) {
  std::vector<std::vector<double>> series;
  for (auto at = all.begin(); at != all.end(); at += static_cast<std::ptrdiff_t>(length))
    series.emplace_back(at, at + static_cast<std::ptrdiff_t>(length));
  return series;
}

}  // namespace

/// The common acceleration along the grid, and what it depends on.
struct SensorEquations::Motion {
  std::vector<double> accel_mps2;  ///< Common acceleration.
  MatrixXd values, slopes;         ///< A row a channel: readings without bias [m/s^2], and their slopes [m/s^3].
  MatrixXd derivatives;            ///< Of the common acceleration; a row a parameter.

  Motion(const SensorProblem& problem, const SensorState& state);
};

/// Rows of the same weight, and their derivatives: a column a parameter.
struct SensorEquations::Rows {
  VectorXd values;
  MatrixXd derivatives;

  Rows(std::size_t rows, std::size_t parameters)
      : values(static_cast<Index>(rows)), derivatives(static_cast<Index>(rows), static_cast<Index>(parameters)) {}

  /// What no change of the parameters takes away, as far as the rows are linear in them.
  [[nodiscard]] VectorXd remainder() const {
    constexpr double kRidge = 1e-9;  // of the largest: what the rows do not depend on stays
    MatrixXd normal = derivatives.transpose() * derivatives;
    normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff() + std::numeric_limits<double>::min();
    return values - derivatives * normal.ldlt().solve(derivatives.transpose() * values);
  }
};

/// Sum of the squares of the rows.
struct SensorEquations::Sums {
  double value = 0.0;
  VectorXd gradient;
  MatrixXd hessian;

  explicit Sums(std::span<const double> units) {
    const Eigen::Map<const VectorXd> priors(units.data(), std::ssize(units));
    value = priors.squaredNorm();
    gradient = 2.0 * priors;
    hessian = 2.0 * MatrixXd::Identity(priors.size(), priors.size());
  }

  void add(const Rows& rows, const NoiseLevel& noise) {
    const double weight = 1.0 / (noise.variance * noise.samples);
    value += weight * rows.values.squaredNorm();
    gradient += 2.0 * weight * rows.derivatives.transpose() * rows.values;
    hessian += 2.0 * weight * rows.derivatives.transpose() * rows.derivatives;
  }
};

SensorEquations::Motion::Motion(const SensorProblem& problem, const SensorState& state) {
  const SensorSignals& signals = problem.signals;
  const auto n = static_cast<Index>(state.channels.size()), p = static_cast<Index>(problem.parameters.size());
  const auto count = static_cast<Index>(signals.count);
  values.resize(n, count);
  slopes.resize(n, count);
  for (Index c = 0; c < n; ++c)
    for (Index i = 0; i < count; ++i) {
      const auto channel = static_cast<std::size_t>(c);
      const Reading reading = signals.read(channel, static_cast<std::size_t>(i), state.channels[channel].time_shift_s);
      values(c, i) = reading.value - state.channels[channel].bias_mps2;
      slopes(c, i) = reading.slope / signals.dt_s;
    }
  accel_mps2 = common_acceleration(signals, state.channels);
  const Eigen::Map<const Eigen::RowVectorXd> accel(accel_mps2.data(), count);
  const double norm = total_weight(signals, state.channels);
  derivatives = MatrixXd::Zero(p, count);
  for (Index j = 0; j < p; ++j) {
    const SensorParameter& parameter = problem.parameters[static_cast<std::size_t>(j)];
    if (parameter.kind == SensorUnknown::wall_gain) continue;
    const auto c = static_cast<Index>(parameter.channel);
    const double gain = state.channels[parameter.channel].gain;
    const double scale = parameter.prior_sd * signals.weights[parameter.channel] / norm;
    if (parameter.kind == SensorUnknown::bias) derivatives.row(j).setConstant(-scale * gain);
    if (parameter.kind == SensorUnknown::gain) derivatives.row(j) = scale * (values.row(c) - 2.0 * gain * accel);
    if (parameter.kind == SensorUnknown::time_shift) derivatives.row(j) = scale * gain * slopes.row(c);
  }
}

SensorEquations::SensorEquations(SensorProblem problem) : problem_(std::move(problem)) {
  double largest = 0.0;
  for (const std::vector<double>& channel : problem_.signals.channels)
    for (const double value : channel) largest = std::max(largest, std::abs(value));
  least_variance_ = std::pow(kLeastNoise * largest, 2);
  take_noise(std::vector<double>(problem_.parameters.size(), 0.0));
}

SensorState SensorEquations::state(std::span<const double> units) const {
  SensorState state{std::vector<SensorModel>(problem_.signals.channels.size()), 1.0};
  for (std::size_t j = 0; j < units.size(); ++j) {
    const SensorParameter& parameter = problem_.parameters[j];
    const double change = units[j] * parameter.prior_sd;
    if (parameter.kind == SensorUnknown::wall_gain) {
      state.wall_gain += change;
      continue;
    }
    SensorModel& model = state.channels[parameter.channel];
    if (parameter.kind == SensorUnknown::bias) model.bias_mps2 = change;
    if (parameter.kind == SensorUnknown::gain) model.gain += change;
    if (parameter.kind == SensorUnknown::time_shift) model.time_shift_s = change;
  }
  return state;
}

double SensorEquations::evaluate(std::span<const double> units, std::span<double> gradient, MatrixXd& hessian) const {
  const SensorState here = state(units);
  const Motion motion(problem_, here);
  Sums sums(units);
  if (here.channels.size() > 1) sums.add(channel_rows(here, motion), noise_);
  if (problem_.compares_wall) sums.add(wall_rows(here, motion), wall_noise_);
  add_conditions(here, motion, sums);
  std::copy(sums.gradient.begin(), sums.gradient.end(), gradient.begin());
  hessian = sums.hessian;
  return sums.value;
}

/// Differences of the channels to their common motion over the window, by the roots of their weights; channel by
/// channel.
SensorEquations::Rows SensorEquations::channel_rows(const SensorState& state, const Motion& motion) const {
  const auto first = static_cast<Index>(problem_.first), count = static_cast<Index>(problem_.last) - first + 1;
  const Eigen::Map<const VectorXd> accel(motion.accel_mps2.data() + first, count);
  Rows rows(state.channels.size() * static_cast<std::size_t>(count), problem_.parameters.size());
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    const auto channel = static_cast<Index>(c);
    const double gain = state.channels[c].gain, root = std::sqrt(problem_.signals.weights[c]);
    const auto read = motion.values.row(channel).segment(first, count).transpose();
    rows.values.segment(channel * count, count) = root * (read - gain * accel);
    auto derivatives = rows.derivatives.middleRows(channel * count, count);
    derivatives = -root * gain * motion.derivatives.middleCols(first, count).transpose();
    for (std::size_t j = 0; j < problem_.parameters.size(); ++j) {
      const SensorParameter& own = problem_.parameters[j];
      if (own.kind == SensorUnknown::wall_gain || own.channel != c) continue;
      auto column = derivatives.col(static_cast<Index>(j));
      if (own.kind == SensorUnknown::bias) column.array() -= root * own.prior_sd;
      if (own.kind == SensorUnknown::gain) column -= root * own.prior_sd * accel;
      if (own.kind == SensorUnknown::time_shift)
        column += root * own.prior_sd * motion.slopes.row(channel).segment(first, count).transpose();
    }
  }
  return rows;
}

/// The common motion plus F/m over the window.
SensorEquations::Rows SensorEquations::wall_rows(const SensorState& state, const Motion& motion) const {
  const auto first = static_cast<Index>(problem_.first), count = static_cast<Index>(problem_.last) - first + 1;
  const VectorXd force = Eigen::Map<const VectorXd>(problem_.signals.wall_mps2.data() + first, count) / state.wall_gain;
  Rows rows(static_cast<std::size_t>(count), problem_.parameters.size());
  rows.values = Eigen::Map<const VectorXd>(motion.accel_mps2.data() + first, count) + force;
  rows.derivatives = motion.derivatives.middleCols(first, count).transpose();
  for (std::size_t j = 0; j < problem_.parameters.size(); ++j)
    if (problem_.parameters[j].kind == SensorUnknown::wall_gain)
      rows.derivatives.col(static_cast<Index>(j)) -= problem_.parameters[j].prior_sd / state.wall_gain * force;
  return rows;
}

void SensorEquations::add_conditions(const SensorState& state, const Motion& motion, Sums& sums) const {
  const auto count = static_cast<Index>(problem_.conditions.size()), p = sums.gradient.size();
  if (count == 0) return;
  VectorXd misses(count);
  MatrixXd slopes = MatrixXd::Zero(count, p);
  for (Index k = 0; k < count; ++k) {
    const SensorCondition& condition = problem_.conditions[static_cast<std::size_t>(k)];
    misses[k] = velocity_of(condition, motion.accel_mps2) - known_velocity(condition, state.wall_gain);
    const std::vector<double> weights = quadrature(condition, motion.accel_mps2);
    const auto reach = static_cast<Index>(weights.size());
    slopes.row(k) =
        (motion.derivatives.leftCols(reach) * Eigen::Map<const VectorXd>(weights.data(), reach)).transpose();
    if (condition.kind != SensorCondition::Kind::impulse) continue;
    for (Index j = 0; j < p; ++j) {
      const SensorParameter& parameter = problem_.parameters[static_cast<std::size_t>(j)];
      if (parameter.kind == SensorUnknown::wall_gain)
        slopes(k, j) -= (problem_.impact_speed_mps - known_velocity(condition, state.wall_gain)) / state.wall_gain *
                        parameter.prior_sd;
    }
  }
  sums.value += misses.dot(condition_weights_ * misses);
  sums.gradient += 2.0 * slopes.transpose() * condition_weights_ * misses;
  sums.hessian += 2.0 * slopes.transpose() * condition_weights_ * slopes;
}

std::vector<double> SensorEquations::quadrature(const SensorCondition& condition,
                                                std::span<const double> accel_mps2) const {
  const double dt_s = problem_.signals.dt_s;
  if (condition.kind != SensorCondition::Kind::rebound) return quadrature_weights(dt_s, condition.time_s);
  double change = 0.0, least = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 1; i <= problem_.last; ++i) {
    change += 0.5 * dt_s * (accel_mps2[i - 1] + accel_mps2[i]);
    if (change >= least) continue;
    least = change;
    at = i;
  }
  return quadrature_weights(dt_s, problem_.signals.time(at));
}

double SensorEquations::velocity_of(const SensorCondition& condition, std::span<const double> accel_mps2) const {
  double velocity = problem_.impact_speed_mps;
  const std::vector<double> weights = quadrature(condition, accel_mps2);
  for (std::size_t i = 0; i < weights.size(); ++i) velocity += weights[i] * accel_mps2[i];
  return velocity;
}

double SensorEquations::known_velocity(const SensorCondition& condition, double wall_gain) const {
  if (condition.kind != SensorCondition::Kind::impulse) return condition.velocity_mps;
  double change = 0.0;
  const std::vector<double> weights = quadrature_weights(problem_.signals.dt_s, condition.time_s);
  for (std::size_t i = 0; i < weights.size(); ++i) change += weights[i] * problem_.signals.wall_mps2[i];
  return problem_.impact_speed_mps - change / wall_gain;
}

/// Of the conditions' misses: what they are known to, and what the noise of the mean adds up to.
MatrixXd SensorEquations::condition_covariance(const SensorState& state, std::span<const double> accel_mps2) const {
  const std::size_t count = problem_.conditions.size();
  const double weight = total_weight(problem_.signals, state.channels);
  const double noise = std::isnan(noise_.variance) ? 0.0 : noise_.variance * noise_.samples / weight;
  std::vector<std::vector<double>> weights;
  for (const SensorCondition& condition : problem_.conditions) weights.push_back(quadrature(condition, accel_mps2));
  MatrixXd covariance(count, count);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b) {
      double common = 0.0;
      for (std::size_t i = 0; i < std::min(weights[a].size(), weights[b].size()); ++i)
        common += weights[a][i] * weights[b][i];
      covariance(static_cast<Index>(a), static_cast<Index>(b)) =
          noise * common + (a == b ? problem_.velocity_sd_mps * problem_.velocity_sd_mps : 0.0);
    }
  return covariance;
}

double SensorEquations::take_noise(std::span<const double> units) {
  const SensorState here = state(units);
  const Motion motion(problem_, here);
  const std::size_t samples = problem_.last - problem_.first + 1, channels = here.channels.size();
  const double before = total_variance();
  const auto spent = static_cast<double>(
      std::count_if(problem_.parameters.begin(), problem_.parameters.end(), [](const SensorParameter& parameter) {
        return parameter.kind != SensorUnknown::wall_gain && parameter.channel == 0;
      }));
  if (channels > 1)
    noise_ = corrected_for(noise_of(as_series(channel_rows(here, motion).remainder(), samples)), samples, channels - 1,
                           spent, least_variance_);
  if (problem_.compares_wall) {
    Rows rows = wall_rows(here, motion);
    for (std::size_t j = 0; j < problem_.parameters.size(); ++j)  // with all gains free, nothing would be left
      if (problem_.parameters[j].kind == SensorUnknown::wall_gain)
        rows.derivatives.col(static_cast<Index>(j)).setZero();
    wall_noise_ = corrected_for(noise_of(as_series(rows.remainder(), samples)), samples, 1, spent, least_variance_);
  }
  if (!problem_.conditions.empty()) {
    const MatrixXd covariance = condition_covariance(here, motion.accel_mps2);
    condition_weights_ = covariance.llt().solve(MatrixXd::Identity(covariance.rows(), covariance.cols()));
  }
  const double now = total_variance();
  return now > 0.0 ? std::abs(now - before) / now : 0.0;
}

double SensorEquations::total_variance() const {
  double total = 0.0;
  for (const NoiseLevel* noise : {&noise_, &wall_noise_})
    if (!std::isnan(noise->variance)) total += noise->variance;
  return total;
}

}  // namespace crashsim
