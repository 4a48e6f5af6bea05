#include <crashsim/plausibility.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {
namespace {

constexpr std::size_t kFewestSamples = 3;

struct Samples {
  std::span<const double> time_s, accel_mps2, velocity_mps, displacement_m;
};

Samples from_impact(const Samples& all) {
  const auto before = std::lower_bound(all.time_s.begin(), all.time_s.end(), 0.0) - all.time_s.begin();
  const auto cut = [before](std::span<const double> values) {
    return values.subspan(std::min(static_cast<std::size_t>(before), values.size()));
  };
  return {cut(all.time_s), cut(all.accel_mps2), cut(all.velocity_mps), cut(all.displacement_m)};
}

struct Deviation {
  double size = 0.0, time_s = kUnset;
};

/// The largest |computed - given| and its time.
Deviation largest_deviation(const Samples& s, std::span<const double> given, std::span<const double> computed) {
  Deviation largest{0.0, s.time_s.front()};
  for (std::size_t i = 0; i < given.size(); ++i)
    if (const double size = std::abs(given[i] - computed[i]); size > largest.size) largest = {size, s.time_s[i]};
  return largest;
}

/// Integral of a dx from the first sample on.
std::vector<double> work_along(const Samples& s) {
  std::vector<double> work(s.time_s.size());
  for (std::size_t i = 1; i < work.size(); ++i)
    work[i] =
        work[i - 1] + 0.5 * (s.accel_mps2[i] + s.accel_mps2[i - 1]) * (s.displacement_m[i] - s.displacement_m[i - 1]);
  return work;
}

/// Work and centroid up to the time of maximum crush.
void set_ratios(const Samples& s, std::span<const double> work, MotionBalance& out) {
  const MaxCrush end = find_max_crush(s.time_s, s.accel_mps2, s.velocity_mps, s.displacement_m);
  if (std::isnan(end.t_m_s)) return;
  const double v0 = s.velocity_mps.front(), crush = end.max_crush_m - s.displacement_m.front();
  const std::vector<double> at{end.t_m_s};
  out.work_ratio = -resample(s.time_s, work, at).front() / (0.5 * v0 * v0);
  std::vector<double> moments(s.time_s.size());
  for (std::size_t i = 0; i < moments.size(); ++i) moments[i] = s.accel_mps2[i] * (s.time_s[i] - s.time_s.front());
  const auto integral = [&](std::span<const double> values) {
    return resample(s.time_s, integrate(s.time_s, values, 0.0), at).front();
  };
  out.centroid_ratio = integral(moments) / integral(s.accel_mps2) / (crush / v0);
}

}  // namespace

std::vector<std::string> check_fleet(double max_crush_m, double peak_decel_g) {
  std::vector<std::string> findings;
  const std::array values = {max_crush_m, peak_decel_g};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const FleetRange& range = kFleetRanges[i];
    if (!(values[i] < range.percentile_5 || values[i] > range.percentile_95)) continue;
    findings.push_back(
        fmt::format("{} {:.3g} {} is outside {} to {} {}, where 9 of 10 frontal rigid-wall tests lie: check channel, "
                    "units and speed",
                    range.doc, values[i], range.unit, range.percentile_5, range.percentile_95, range.unit));
  }
  return findings;
}

MotionBalance motion_balance(std::span<const double> time_s, std::span<const double> accel_mps2,
                             std::span<const double> velocity_mps, std::span<const double> displacement_m) {
  const Samples s = from_impact({time_s, accel_mps2, velocity_mps, displacement_m});
  check_series(s.time_s, s.accel_mps2, "accel_mps2", kFewestSamples);
  check_series(s.time_s, s.velocity_mps, "velocity_mps", kFewestSamples);
  check_series(s.time_s, s.displacement_m, "displacement_m", kFewestSamples);
  const double v0 = s.velocity_mps.front(), x0 = s.displacement_m.front();
  if (!(v0 > 0.0)) throw InvalidInput(fmt::format("velocity_mps[0] = {} m/s: must be > 0, towards the barrier", v0));
  const std::vector<double> work = work_along(s);
  std::vector<double> energy(work.size()), by_work(work.size());
  double travel = 0.0;
  for (std::size_t i = 0; i < work.size(); ++i) {
    energy[i] = 0.5 * s.velocity_mps[i] * s.velocity_mps[i];
    by_work[i] = 0.5 * v0 * v0 + work[i];
    travel = std::max(travel, std::abs(s.displacement_m[i] - x0));
  }
  const Deviation of_velocity = largest_deviation(s, s.velocity_mps, integrate(s.time_s, s.accel_mps2, v0));
  const Deviation of_displacement = largest_deviation(s, s.displacement_m, integrate(s.time_s, s.velocity_mps, x0));
  const Deviation of_energy = largest_deviation(s, energy, by_work);
  MotionBalance out;
  out.velocity_deviation = of_velocity.size / v0;
  out.velocity_deviation_s = of_velocity.time_s;
  out.displacement_deviation = of_displacement.size / travel;
  out.displacement_deviation_s = of_displacement.time_s;
  out.energy_deviation = of_energy.size / (0.5 * v0 * v0);
  out.energy_deviation_s = of_energy.time_s;
  set_ratios(s, work, out);
  return out;
}

std::vector<std::string> check_balance(const MotionBalance& balance) {
  std::vector<std::string> findings;
  const auto tell = [&](double deviation, double time_s, std::string_view what, std::string_view whole) {
    if (deviation > kBalanced)
      findings.push_back(fmt::format("{} by {:.3g} % of {}, most at {:.4g} s", what, 100.0 * deviation, whole, time_s));
  };
  tell(balance.velocity_deviation, balance.velocity_deviation_s,
       "velocity is not the integral of acceleration: they differ", "the impact speed");
  tell(balance.displacement_deviation, balance.displacement_deviation_s,
       "displacement is not the integral of velocity: they differ", "the largest displacement");
  tell(balance.energy_deviation, balance.energy_deviation_s,
       "kinetic energy and the work of the deceleration over displacement do not add up: they differ",
       "the energy at impact");
  const auto tell_ratio = [&](double ratio, std::string_view what) {
    if (std::abs(ratio - 1.0) > kBalanced)
      findings.push_back(fmt::format("{}: they differ by {:.3g} %", what, 100.0 * (ratio - 1.0)));
  };
  tell_ratio(balance.work_ratio, "the work of the deceleration over the crush is not v0^2/2 per mass");
  tell_ratio(balance.centroid_ratio, "the time centroid of the deceleration is not C/v0");
  return findings;
}

}  // namespace crashsim
