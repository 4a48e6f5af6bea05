#include "optimize/pitch_objective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "optimize/fit_target.hpp"

namespace crashsim {

PitchObjective::PitchObjective(const HeavePitchModel& model, const PitchForcing& forcing, const PitchFitTarget& target,
                               std::span<const PitchParameter> parameters, Loss loss)
    : model_(model),
      target_(target),
      parameters_(parameters),
      loss_(loss),
      steps_(make_steps(model, forcing, target.start_s, target.times)) {}

template <class Visit>
void PitchObjective::walk(std::span<const double> values, std::size_t first, std::size_t count, Visit visit) const {
  const PitchEquation equation(with_values<HeavePitchModel>(model_, parameters_, values),
                               parameters_.subspan(first, count), steps_.longest_s);
  PitchEquation::State state;
  for (std::size_t i = 0; i < 4; ++i) state.value[i] = target_.initial[static_cast<Eigen::Index>(i)];
  std::size_t step = 0;
  for (std::size_t i = 0; i < target_.samples.size(); ++i) {
    for (; step < steps_.samples[target_.samples[i].time]; ++step)
      equation.advance(steps_.forces[step], steps_.lengths_s[step], state);
    visit(i, state);
  }
}

double PitchObjective::evaluate(std::span<const double> values, double smoothing, std::span<double> gradient) const {
  double total = 0.0;
  for (std::size_t first = 0; first < std::max<std::size_t>(gradient.size(), 1); first += kLanes) {
    const std::size_t count = std::min(kLanes, gradient.size() - first);
    double sum = 0.0;
    Lanes slopes = {};
    walk(values, first, count, [&](std::size_t i, const PitchEquation::State& state) {
      const PitchSample& sample = target_.samples[i];
      const double scale = target_.scale[sample.channel], factor = target_.factor[sample.channel];
      const LossValue loss = loss_value(loss_, scale * (state.value[sample.channel] - sample.value), smoothing);
      sum += factor * loss.value;
      slopes += factor * loss.derivative * scale * state.slope[sample.channel];
    });
    total = sum;
    for (std::size_t lane = 0; lane < count; ++lane) gradient[first + lane] = slopes[lane];
  }
  return std::isfinite(total) ? total : std::numeric_limits<double>::infinity();
}

Eigen::MatrixXd PitchObjective::jacobian(std::span<const double> values) const {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(target_.samples.size()), static_cast<Eigen::Index>(values.size()));
  for (std::size_t first = 0; first < values.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, values.size() - first);
    walk(values, first, count, [&](std::size_t i, const PitchEquation::State& state) {
      const std::size_t channel = target_.samples[i].channel;
      const double weight = std::sqrt(target_.factor[channel]) * target_.scale[channel];
      for (std::size_t lane = 0; lane < count; ++lane)
        rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(first + lane)) =
            weight * state.slope[channel][lane];
    });
  }
  return rows;
}

}  // namespace crashsim
