#include "solver/pitch_grid.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/LU>

namespace crashsim {
namespace {

struct Line {
  double value = 0.0, slope = 0.0;
};

/// Reads a series line by line, forwards in time.
class LineReader {
 public:
  /// @param hold whether the first and last values are held outside the samples; otherwise the series is zero there.
  LineReader(const TimeSeries& series, bool hold) : series_(series), hold_(hold) {}

  /// Line from `from` to `to`, which have no sample between them.
  Line line(double from, double to) {
    const auto& t = series_.time_s;
    const auto& y = series_.values;
    if (t.empty()) return {};
    while (next_ < t.size() && t[next_] <= 0.5 * (from + to)) ++next_;
    if (next_ == 0) return {hold_ ? y.front() : 0.0, 0.0};
    if (next_ == t.size()) return {hold_ ? y.back() : 0.0, 0.0};
    const double slope = (y[next_] - y[next_ - 1]) / (t[next_] - t[next_ - 1]);
    return {y[next_ - 1] + slope * (from - t[next_ - 1]), slope};
  }

 private:
  const TimeSeries& series_;
  bool hold_;
  std::size_t next_ = 0;
};

/// The force per unit mass, piece by piece, forwards in time.
class PieceReader {
 public:
  PieceReader(const HeavePitchModel& model, const PitchForcing& forcing)
      : vertical_(forcing.vertical_force_n, false),
        longitudinal_(forcing.longitudinal_force_n, false),
        height_(forcing.force_height_m, true),
        per_mass_(1.0 / model.mass_kg),
        per_inertia_(1.0 / model.pitch_inertia_kgm2),
        has_longitudinal_(!forcing.longitudinal_force_n.empty() && model.formulation == PitchFormulation::derived),
        arm_(model.formulation == PitchFormulation::derived ? model.force_arm_m : 1.0),
        cg_height_(model.cg_height_m),
        constant_height_(forcing.force_height_m.empty() ? model.force_height_m : 0.0) {
    if (forcing.vertical_force_n.empty()) arm_ = 0.0;
  }

  ForcePiece piece(double from, double to) {
    const Line vertical = vertical_.line(from, to);
    const double turning = arm_ * per_inertia_;
    ForcePiece force;
    force << -vertical.value * per_mass_, -vertical.slope * per_mass_, 0.0,  //
        vertical.value * turning, vertical.slope * turning, 0.0;
    if (!has_longitudinal_) return force;
    const Line along = longitudinal_.line(from, to);
    const Line height = height_.line(from, to);
    const Line offset{cg_height_ - constant_height_ - height.value, -height.slope};
    force(1, 0) += along.value * offset.value * per_inertia_;
    force(1, 1) += (along.value * offset.slope + along.slope * offset.value) * per_inertia_;
    force(1, 2) += 2.0 * along.slope * offset.slope * per_inertia_;
    return force;
  }

 private:
  LineReader vertical_, longitudinal_, height_;
  double per_mass_, per_inertia_;
  bool has_longitudinal_;
  double arm_, cg_height_, constant_height_;
};

/// The start and every sample time of the forcing strictly between start and end, in order.
std::vector<double> force_knots(const PitchForcing& forcing, double start_s, double end_s) {
  const double rounding = time_rounding(start_s, end_s);
  std::vector<double> knots{start_s};
  for (const auto* series : {&forcing.vertical_force_n, &forcing.longitudinal_force_n, &forcing.force_height_m}) {
    const auto from = std::ranges::upper_bound(series->time_s, start_s + rounding);
    const auto to = std::ranges::lower_bound(series->time_s, end_s - rounding);
    if (from >= to) continue;
    std::vector<double> merged;
    merged.reserve(knots.size() + series->time_s.size());
    std::set_union(knots.begin(), knots.end(), from, to, std::back_inserter(merged));
    knots = std::move(merged);
  }
  const auto same = [rounding](double a, double b) { return b - a <= rounding; };
  knots.erase(std::unique(knots.begin(), knots.end(), same), knots.end());
  return knots;
}

/// Adds times between the last one and `to`, so that no step is longer than `longest_step_s`.
void divide_last_step(PitchGrid& grid, double to, double longest_step_s) {
  const double from = grid.times.back();
  if (to - from <= longest_step_s) return;
  const ForcePiece force = grid.forces.back();
  const double parts = std::ceil((to - from) / longest_step_s);
  for (double i = 1.0; i < parts; ++i) {
    const double s = (to - from) * i / parts;
    grid.times.push_back(from + s);
    grid.forces.push_back(shifted(force, s));
  }
}

}  // namespace

double time_rounding(double start_s, double end_s) {
  return 4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(start_s), std::abs(end_s));
}

PitchGrid make_grid(const HeavePitchModel& model, const PitchForcing& forcing, double start_s,
                    std::span<const double> samples, double longest_step_s) {
  const double end_s = samples.back();
  const double rounding = time_rounding(start_s, end_s);
  const std::vector<double> knots = force_knots(forcing, start_s, end_s);
  PieceReader reader(model, forcing);
  PitchGrid grid;
  grid.times.reserve(knots.size() + samples.size());
  grid.forces.reserve(knots.size() + samples.size());
  const auto add = [&](double t, const ForcePiece& force) {
    if (!grid.times.empty()) divide_last_step(grid, t, longest_step_s);
    grid.times.push_back(t);
    grid.forces.push_back(force);
    return grid.times.size() - 1;
  };
  auto sample = samples.begin();
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const double from = knots[k];
    const bool is_last = k + 1 == knots.size();
    const double to = is_last ? end_s : knots[k + 1];
    const ForcePiece piece = reader.piece(from, to);
    grid.knots.push_back(add(from, piece));
    if (*sample <= from + rounding) {
      grid.samples.push_back(grid.knots.back());
      ++sample;
    }
    for (; sample != samples.end() && (is_last || *sample < to - rounding); ++sample)
      grid.samples.push_back(add(*sample, shifted(piece, *sample - from)));
  }
  grid.knots.push_back(grid.times.size() - 1);
  return grid;
}

LinearSystem linear_system(const HeavePitchModel& model) {
  const Eigen::Matrix2d per_mass = mass_matrix(model).inverse();
  return {.stiffness = per_mass * stiffness_matrix(model), .damping = per_mass * damping_matrix(model)};
}

PitchWork integrate_by_propagator(const LinearSystem& system, const PitchGrid& grid, std::vector<PitchState>& states) {
  states.resize(grid.times.size());
  Propagator(system, time_rounding(grid.times.front(), grid.times.back())).run(grid.times, grid.forces, states);
  PitchWork work{.outcome = PitchOutcome::completed};
  work.statistics.steps = static_cast<long>(states.size()) - 1;
  if (!states.back().allFinite()) {
    work.outcome = PitchOutcome::failed;
    work.message = "the motion grows beyond all bounds";
  }
  return work;
}

}  // namespace crashsim
