#include "solver/lane_motions.hpp"

#include <algorithm>
#include <limits>

namespace crashsim {

LaneMotions::LaneMotions(std::span<const double> times_s, double tolerance, InstructionSet set)
    : times_(times_s.begin(), times_s.end()),
      samples_(times_s.size()),
      tolerance_(tolerance),
      kernel_(KernelChoice<LaneKernel>{kLaneKernelBaseline, kLaneKernelAvx2, kLaneKernelAvx512}(set)) {
  times_.resize(samples_ + kMotions, times_s.back());
  if (samples_ < 2) return;
  const double spacing = (times_s.back() - times_s.front()) / static_cast<double>(samples_ - 1);
  for (std::size_t i = 1; i < samples_; ++i)
    if (std::fabs(times_[i] - times_[0] - spacing * static_cast<double>(i)) > spacing) return;
  spacing_s_ = spacing;
}

long LaneMotions::run(const LaneWork& work) {
  next_model_ = 0;
  long steps = 0;
  for (std::size_t lane = 0; lane < kMotions; ++lane) start(lane, work);
  const auto any_live = [&] { return std::any_of(lanes_.begin(), lanes_.end(), [](const Lane& l) { return l.live; }); };
  while (any_live()) {
    kernel_.advance(block_);
    for (std::size_t lane = 0; lane < kMotions; ++lane) {
      if (!lanes_[lane].live) continue;
      end_step(lane);
      ++steps;
      if (!lanes_[lane].state.ended) continue;
      finish(lane, work);
      start(lane, work);
    }
  }
  return steps;
}

/// Puts the next model into a lane, if there is one.
void LaneMotions::start(std::size_t lane, const LaneWork& work) {
  Lane& self = lanes_[lane];
  for (self.live = false; !self.live && next_model_ < work.count; ++next_model_) {
    self.index = next_model_;
    work.load(self.index, self.model);
    self.row = work.row(self.index);
    self.state = start_motion(self.model.problem());
    self.next_sample = 0;
    self.live = !self.state.ended;
    if (!self.live) finish(lane, work);
  }
  if (!self.live) return;
  block_.tolerance[lane] = tolerance_ * self.model.speed_mps;
  block_.margin[lane] = state_rounding(self.model.speed_mps);
  block_.bilateral[lane] = self.model.unloading.bilateral ? 1.0 : 0.0;
  enter_region(lane);
  set_start(lane);
}

void LaneMotions::finish(std::size_t lane, const LaneWork& work) {
  const Lane& self = lanes_[lane];
  if (self.row.accel != nullptr)
    for (double* const row : {self.row.accel, self.row.velocity, self.row.displacement})
      std::fill(row + self.next_sample, row + samples_, kUnset);
  work.finish(self.index, self.state.summary);
}

/// Sets force and bounds of the segments the lane's motion is in.
void LaneMotions::enter_region(std::size_t lane) {
  const Lane& self = lanes_[lane];
  const Region& region = self.state.region;
  const CrushProblem problem = self.model.problem();
  const RegionForce force = region_force(problem, region);
  const Quadratic &spring = force.spring, &damper = force.damper;
  const double per_mass = -1.0 / self.model.mass_kg;
  block_.force.constant[lane] = per_mass * (spring[0] + damper[0]);
  block_.force.x1[lane] = per_mass * spring[1];
  block_.force.x2[lane] = per_mass * spring[2];
  block_.force.v1[lane] = per_mass * damper[1];
  block_.force.v2[lane] = per_mass * damper[2];
  block_.force.xv[lane] = per_mass * force.cross;
  block_.has_xv |= force.cross != 0.0;
  block_.x_low[lane] = problem.force.spring.lower(region.spring);
  block_.x_high[lane] = problem.force.spring.upper(region.spring);
  block_.v_low[lane] = problem.force.damper.lower(region.damper);
  block_.v_high[lane] = problem.force.damper.upper(region.damper);
}

void LaneMotions::set_start(std::size_t lane) {
  const MotionState& state = lanes_[lane].state;
  block_.x_from[lane] = state.x;
  block_.v_from[lane] = state.v;
  block_.remaining[lane] = times_[samples_ - 1] - state.t;
}

StepPolynomial LaneMotions::polynomial(std::size_t lane) const {
  StepPolynomial step;
  step.base = lanes_[lane].state.t;
  step.to = block_.length[lane];
  step.degree = kLaneDegree;
  for (std::size_t n = 0; n <= static_cast<std::size_t>(kLaneDegree); ++n) {
    step.x[n] = block_.x[n][lane];
    step.v[n] = block_.v[n][lane];
  }
  step.set_ends();
  return step;
}

/// What ended the lane's step.
Event LaneMotions::event_of(std::size_t lane) const {
  const Lane& self = lanes_[lane];
  const Region& region = self.state.region;
  const double tau = block_.tau[lane];
  const CrushForce& force = self.model.force;
  if (region.separated) return {EventKind::none, block_.length[lane], 0, 0.0};
  if (region.unloading) return first_event(self.model.problem(), region, polynomial(lane));
  switch (static_cast<LaneEnd>(block_.end[lane])) {
    case LaneEnd::step:
      return {EventKind::none, tau, 0, 0.0};
    case LaneEnd::damper_below:
      return {EventKind::damper_knot, tau, -1, force.damper.lower(region.damper)};
    case LaneEnd::damper_above:
      return {EventKind::damper_knot, tau, +1, force.damper.upper(region.damper)};
    case LaneEnd::spring_below:
      return {EventKind::spring_knot, tau, -1, force.spring.lower(region.spring)};
    case LaneEnd::spring_above:
      return {EventKind::spring_knot, tau, +1, force.spring.upper(region.spring)};
    case LaneEnd::unclear:
      break;
  }
  return first_event(self.model.problem(), region, polynomial(lane));
}

void LaneMotions::end_step(std::size_t lane) {
  Lane& self = lanes_[lane];
  MotionState& state = self.state;
  if (!std::isfinite(block_.v[kLaneDegree][lane])) {
    state.summary.end = MotionEnd::diverged;
    state.ended = true;
    return;
  }
  const Event event = event_of(lane);
  double x = block_.x_to[lane], v = block_.v_to[lane];
  if (event.tau != block_.tau[lane]) {  // not where the kernel has ended it
    const CrushState there = polynomial(lane).state_at(event.tau);
    x = there.x;
    v = there.v;
  }
  const double end = times_[samples_ - 1];
  const bool at_end = event.kind == EventKind::none && block_.length[lane] >= block_.remaining[lane];
  const double t = at_end ? end : state.t + event.tau;
  if (event.kind == EventKind::none || event.tau > 0.0) sample(lane, t, event.tau);
  crashsim::end_step(self.model.problem(), {end, false}, event, t, x, v, state);
  if (state.ended) return;
  if (event.kind != EventKind::none) enter_region(lane);
  set_start(lane);
}

/// Number of samples until `t`; there are `least` for certain.
std::size_t LaneMotions::samples_until(double t, std::size_t least) const {
  const auto begin = times_.begin(), end = begin + static_cast<std::ptrdiff_t>(samples_);
  if (std::isnan(spacing_s_))
    return static_cast<std::size_t>(std::upper_bound(begin + static_cast<std::ptrdiff_t>(least), end, t) - begin);
  const double guess = (t - times_[0]) / spacing_s_;
  auto until = std::clamp(static_cast<std::size_t>(std::max(guess, 0.0)), least, samples_);
  while (until > least && times_[until - 1] > t) --until;
  while (until < samples_ && times_[until] <= t) ++until;
  return until;
}

/// Writes the samples of the lane's step until its end at `t`, `tau_end` after its start.
void LaneMotions::sample(std::size_t lane, double t, double tau_end) {
  Lane& self = lanes_[lane];
  if (self.row.accel == nullptr) return;
  const double base = self.state.t;
  const double* const first = times_.data() + self.next_sample;
  const std::size_t count = samples_until(t, self.next_sample) - self.next_sample;
  // Whole blocks into the row, which the next step overwrites; near the row's end into the tail.
  const std::size_t room = samples_ - self.next_sample;
  const std::size_t direct = std::min(count, room / kMotions * kMotions);
  const LaneSamples whole{first,
                          direct,
                          base,
                          tau_end,
                          self.row.accel + self.next_sample,
                          self.row.velocity + self.next_sample,
                          self.row.displacement + self.next_sample};
  kernel_.sample(block_, lane, whole);
  if (direct < count) {
    const std::size_t rest = count - direct, at = self.next_sample + direct;
    kernel_.sample(block_, lane, {first + direct, rest, base, tau_end, tail_[0], tail_[1], tail_[2]});
    std::copy_n(tail_[0], rest, self.row.accel + at);
    std::copy_n(tail_[1], rest, self.row.velocity + at);
    std::copy_n(tail_[2], rest, self.row.displacement + at);
  }
  self.next_sample += count;
}

}  // namespace crashsim
