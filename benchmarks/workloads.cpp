#include "workloads.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "optimize/starts.hpp"

namespace crashsim::bench {
namespace {

constexpr double kMass = 1719.0;       // [kg]
constexpr double kSpeed = 15.86;       // [m/s]
constexpr double kCrush = 0.7;         // last spring knot of W1 [m]
constexpr double kMaxCrush = 0.58;     // of W2 [m]: stops in about 62 ms, 620 samples at 10 kHz
constexpr Range kStiffness{1e5, 9e5};  // ordinates that stop such a car in 40..110 ms [N/m]
constexpr Range kDamping{1e3, 12e3};   // [N s/m]
constexpr double kReferenceRtol = 1e-12, kPitchReferenceRtol = 1e-13;
constexpr double kNoise = 0.02;  // standard deviation over the channel's maximum
constexpr std::uint64_t kModels = 1, kTruth = 2, kNoiseSeed = 3, kPoints = 4, kForces = 5;

double random_between(Range range, std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return range.min + (range.max - range.min) * uniform_random(seed, stream, index);
}

/// Normally distributed, by Box and Muller.
double random_normal(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform_random(seed, stream, 2 * index)));
  return radius * std::cos(2.0 * std::numbers::pi * uniform_random(seed, stream, 2 * index + 1));
}

PiecewiseLinear random_curve(double last, int knots, Range range, std::uint64_t seed, std::uint64_t stream) {
  PiecewiseLinear curve{uniform_knots(last, knots), {}};
  for (std::size_t i = 0; i < curve.knots.size(); ++i)
    curve.ordinates.push_back(random_between(range, seed, stream, i));
  return curve;
}

CrushModel model_from(std::uint64_t seed, std::uint64_t index, double last_knot, int knots) {
  CrushModel model;
  model.mass_kg = kMass;
  model.impact_speed_mps = kSpeed;
  model.unloading.bilateral = true;
  model.spring = random_curve(last_knot, knots, kStiffness, seed, 2 * index);
  model.damper = random_curve(kSpeed, knots, kDamping, seed, 2 * index + 1);
  return model;
}

double max_crush(const CrushModel& model) {
  SimulateOptions options;
  options.to_max_crush = true;
  options.rtol = kReferenceRtol;
  return simulate(model, options).max_crush_m;
}

/// Scales both curves until maximum crush is at the last knot.
void reach_last_knot(CrushModel& model) {
  const CrushModel unscaled = model;
  double low = 0.1, high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double factor = std::sqrt(low * high);
    for (auto* curve : {&model.spring, &model.damper}) {
      const auto& ordinates = (curve == &model.spring ? unscaled.spring : unscaled.damper).ordinates;
      std::ranges::transform(ordinates, curve->ordinates.begin(), [&](double ordinate) { return factor * ordinate; });
    }
    (max_crush(model) > model.spring.knots.back() ? low : high) = factor;
  }
}

void add_noise(std::vector<double>& channel, std::uint64_t stream) {
  double largest = 0.0;
  for (const double value : channel) largest = std::max(largest, std::fabs(value));
  for (std::size_t i = 0; i < channel.size(); ++i)
    channel[i] += kNoise * largest * random_normal(kNoiseSeed, stream, i);
}

Pulse noisy_pulse(const CrushModel& model, int samples, std::uint64_t stream) {
  SimulateOptions options;
  options.to_max_crush = true;
  options.rtol = kReferenceRtol;
  const double t_m = simulate(model, options).t_m_s;
  options.to_max_crush = false;
  for (int i = 0; i < samples; ++i) options.times_s.push_back(t_m * i / samples);
  const CrushResponse run = simulate(model, options);
  Pulse pulse;
  pulse.time_s = run.time_s;
  pulse.accel_mps2 = run.accel_mps2;
  pulse.velocity_mps = run.velocity_mps;
  pulse.displacement_m = run.displacement_m;
  add_noise(pulse.accel_mps2, stream);
  add_noise(pulse.velocity_mps, stream + 1);
  add_noise(pulse.displacement_m, stream + 2);
  pulse.mass_kg = model.mass_kg;
  pulse.impact_speed_mps = model.impact_speed_mps;
  pulse.t_m_s = t_m;
  pulse.max_crush_m = kMaxCrush;
  return pulse;
}

/// Anywhere between the bounds.
std::vector<double> random_start(const IdentifyOptions& options, std::uint64_t index) {
  std::vector<double> ordinates;
  for (int i = 0; i < options.spring_knots + options.damper_knots; ++i)
    ordinates.push_back((i < options.spring_knots ? options.spring_upper : options.damper_upper) *
                        uniform_random(options.seed, index, static_cast<std::uint64_t>(i)));
  return ordinates;
}

/// Near enough to the truth to stay in contact: elsewhere crashsim's model separates, and others' do not.
std::vector<double> random_point(const CrushModel& truth, std::uint64_t index) {
  std::vector<double> ordinates = truth.spring.ordinates;
  ordinates.insert(ordinates.end(), truth.damper.ordinates.begin(), truth.damper.ordinates.end());
  for (std::size_t i = 0; i < ordinates.size(); ++i) ordinates[i] *= random_between({0.6, 1.4}, kPoints, index, i);
  return ordinates;
}

}  // namespace

double largest_error(const Channels& result, const Channels& reference) {
  if (result.size() != reference.size()) throw std::invalid_argument("a result with other channels than the reference");
  double worst = 0.0;
  for (std::size_t c = 0; c < reference.size(); ++c) {
    if (result[c].size() != reference[c].size()) throw std::invalid_argument("a result with other samples");
    double error = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < reference[c].size(); ++i) {
      const double difference = std::fabs(result[c][i] - reference[c][i]);
      if (!(difference <= error)) error = difference;  // so that what is not a number stays
      largest = std::max(largest, std::fabs(reference[c][i]));
    }
    if (!(error / largest <= worst)) worst = error / largest;
  }
  return worst;
}

double ninetieth_percentile(std::vector<double> errors) {
  std::ranges::sort(errors);
  return errors.at((errors.size() * 9 + 9) / 10 - 1);
}

CrushModel random_model(int index, int knots) {
  return model_from(kModels, static_cast<std::uint64_t>(index), kCrush, knots);
}

CrushModels random_models(int count) {
  CrushModels models;
  models.common = random_model(0);
  models.spring_ordinates.resize(count, static_cast<Eigen::Index>(models.common.spring.knots.size()));
  models.damper_ordinates.resize(count, static_cast<Eigen::Index>(models.common.damper.knots.size()));
  for (int i = 0; i < count; ++i) {
    const CrushModel model = random_model(i);
    std::ranges::copy(model.spring.ordinates, models.spring_ordinates.row(i).begin());
    std::ranges::copy(model.damper.ordinates, models.damper_ordinates.row(i).begin());
  }
  return models;
}

ForwardWorkload forward_workload(int models) {
  ForwardWorkload workload;
  for (int i = 0; i <= 1200; ++i) workload.options.times_s.push_back(1e-4 * i);
  SimulateOptions tight = workload.options;
  tight.rtol = kReferenceRtol;
  for (int i = 0; i < models; ++i) {
    workload.models.push_back(random_model(i));
    workload.reference.push_back(channels_of(simulate(workload.models.back(), tight)));
  }
  return workload;
}

Channels channels_of(const CrushResponse& response) {
  return {response.displacement_m, response.velocity_mps, response.accel_mps2};
}

FitWorkload fit_workload(int samples, int knots, int target) {
  const auto index = static_cast<std::uint64_t>(target);
  FitWorkload workload;
  workload.truth = model_from(kTruth, index, kMaxCrush, knots);
  reach_last_knot(workload.truth);
  workload.pulse = noisy_pulse(workload.truth, samples, 3 * index);
  workload.options.jobs = 1;
  workload.options.spring_knots = workload.options.damper_knots = knots;
  workload.options.spring_upper = 3.0 * std::ranges::max(workload.truth.spring.ordinates);
  workload.options.damper_upper = 3.0 * std::ranges::max(workload.truth.damper.ordinates);
  for (std::uint64_t i = 1; i <= 100; ++i) workload.starts.push_back(random_start(workload.options, i));
  for (std::uint64_t i = 0; i < 10; ++i) workload.points.push_back(random_point(workload.truth, i));
  return workload;
}

PitchWorkload pitch_workload(int samples) {
  PitchWorkload workload;
  workload.model = {kMass, 2600.0, 1.15, 1.55, 42e3, 38e3, 3.2e3, 3.6e3};
  workload.model.force_arm_m = 1.6;
  workload.model.cg_height_m = 0.56;
  workload.model.force_height_m = 0.47;
  workload.options.start.rule = PitchStart::impact;
  workload.options.end_time_s = 0.3;
  workload.options.dt_s = 0.3 / (samples - 1);
  PitchForcing& forcing = workload.forcing;
  for (int i = 0; i < samples; ++i) {
    const double t = 0.3 * i / (samples - 1);
    const double pulse = t < 0.1 ? std::sin(std::numbers::pi * t / 0.1) : 0.0;
    const auto index = static_cast<std::uint64_t>(i);
    forcing.longitudinal_force_n.time_s.push_back(t);
    forcing.vertical_force_n.time_s.push_back(t);
    forcing.longitudinal_force_n.values.push_back(450e3 * pulse * (1.0 + 0.1 * random_normal(kForces, 0, index)));
    forcing.vertical_force_n.values.push_back(45e3 * pulse * (1.0 + 0.3 * random_normal(kForces, 1, index)));
  }
  PitchOptions tight = workload.options;
  tight.integrator = PitchIntegrator::cvode;
  tight.rtol = kPitchReferenceRtol;
  workload.reference = channels_of(simulate_pitch(workload.model, forcing, tight));
  return workload;
}

Channels channels_of(const PitchResponse& response) {
  return {response.heave_m, response.pitch_rad, response.heave_velocity_mps, response.pitch_rate_radps};
}

}  // namespace crashsim::bench
