#include "solver/cvode_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/batch_vector.hpp"
#include "solver/closed_motion.hpp"

namespace crashsim {
namespace {

// Error allowed of a step, all models' in quadratic mean, to that of the result. Measured at rtol 1e-8: 90 % of models
// of 7 + 7 ordinates are then within 6e-7 of each channel's maximum, and 90 % of random ones of 1..9 knots within 1e-6.
constexpr double kLocalPerResult = 0.5;
// Nearly every step has a knot of some model inside, whose error a better converged step does not lessen, and a step
// that has grown soon fails at the next knot: together 15 % faster than by CVODE's 0.1 and 1.5, with the same error.
constexpr double kIterationError = 2.0, kLeastGrowth = 3.0;
constexpr double kRunaway = 1e3;  // of the impact speed: such a motion would hold up all the others
constexpr int kMostEvents = 100;  // of one model in a step
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Whether the spring's force jumps at x = 0.
bool jumps(const LaneModel& model) {
  const int first = model.force.spring.locate(0.0, +1);
  return model.force.spring_polynomials[static_cast<std::size_t>(first)][0] != 0.0;
}

/// Whether a motion may go on in contact after such a jump.
bool jumps_in_contact(const LaneModel& model) {
  return model.unloading.bilateral && model.unloading.kind == UnloadingKind::elastic && jumps(model);
}

int move_to(const ForceAxis& axis, int segment, double s) {
  while (s < axis.lower(segment)) --segment;
  while (s > axis.upper(segment)) ++segment;
  return segment;
}

/// Segment of a variable that has not yet left its knots where it must not.
int segment_at(const ForceAxis& axis, double s, int direction) {
  const int segment = axis.locate(s, direction);
  return std::clamp(segment, axis.first_allowed, axis.last_allowed);
}

/// Region of a motion in contact at the start of a step. What rounding has put beyond a bound there, with no event
/// before, is still inside, so that the event is found in this step.
Region region_at_start(const CrushProblem& problem, bool is_loading, const StepPolynomial& step) {
  if (step.base + step.from <= 0.0) return initial_region(problem);
  const double x = step.x_at(step.from), v = step.v_at(step.from);
  Region region;
  region.spring = segment_at(problem.force.spring, x, v < 0.0 ? -1 : +1);
  region.damper = is_loading && v <= 0.0 ? problem.force.damper.locate(0.0, +1)
                                         : segment_at(problem.force.damper, v, step.v_at(step.to) < v ? -1 : +1);
  return region;
}

}  // namespace

CvodeBatch::CvodeBatch(std::span<const double> times_s, double rtol, InstructionSet set)
    : times_(times_s.begin(), times_s.end()),
      tolerance_(rtol * kLocalPerResult),
      kernel_(KernelChoice<BatchKernel>{kBatchKernelBaseline, kBatchKernelAvx2, kBatchKernelAvx512}(set)),
      cvode_(
          kBatchLength, [this](double, const double* y, double* ydot) { rates(y, ydot); }, new_batch_vector(set)) {
  cvode_.set_iteration_error(kIterationError);
  cvode_.set_least_growth(kLeastGrowth);
}

long CvodeBatch::run(const LaneWork& work, std::vector<std::size_t>& alone) {
  alone.clear();
  start(work, alone);
  const double end = times_.back();
  long steps = 0;
  try {
    for (; !live_.empty() && cvode_.time() < end && steps < kStepLimit; ++steps) step(work, alone);
  } catch (const SolverError&) {
    steps = kStepLimit;
    std::erase_if(live_, [&](std::size_t index) { return !models_[index].live; });
  }
  if (has_rows_) write_tile();
  for (const std::size_t index : live_) {
    if (cvode_.time() < end) {
      alone.push_back(index);
      continue;
    }
    MotionState& state = models_[index].state;
    state.summary.end_time_s = end;
    work.finish(index, state.summary);
  }
  std::sort(alone.begin(), alone.end());
  return steps;
}

void CvodeBatch::start(const LaneWork& work, std::vector<std::size_t>& alone) {
  Unknowns y{};
  live_.clear();
  force_.has_xv = false;
  for (std::size_t i = 0; i < kBatch; ++i) remove(i);
  // Of a quadratic mean over all kBatch models: as if over those there are.
  const double share =
      std::sqrt(static_cast<double>(kBatch) / static_cast<double>(std::max<std::size_t>(work.count, 1)));
  for (std::size_t i = 0; i < work.count; ++i) {
    Model& model = models_[i];
    work.load(i, model.data);
    model.row = work.row(i);
    model.state = start_motion(model.data.problem());
    if (model.state.ended) {
      finish_row(i);
      work.finish(i, model.state.summary);
    } else if (jumps_in_contact(model.data)) {
      alone.push_back(i);
    } else {
      enter(i, share / (tolerance_ * model.data.speed_mps));
      y[kBatch + i] = model.data.speed_mps;
    }
  }
  has_rows_ = !live_.empty() && models_[live_.front()].row.accel != nullptr;
  next_sample_ = first_in_tile_ = 0;
  cvode_.set_weights(weights_);
  cvode_.start(0.0, y);
  cvode_.set_stop_time(times_.back());
  if (has_rows_ && times_.front() <= 0.0) {
    take_sample(y);
    ++next_sample_;
  }
}

/// Makes a model part of the problem. @param weight of the error of its velocity.
void CvodeBatch::enter(std::size_t index, double weight) {
  Model& model = models_[index];
  model.live = true;
  model.spring = model.state.region.spring;
  model.damper = model.state.region.damper;
  live_.push_back(index);
  force_.moves[index] = 1.0;
  force_.has_xv |= !model.data.force.damping.empty();
  set_polynomials(index);
  set_limits(index);
  weights_[index] = weight / kCrashTime;
  weights_[kBatch + index] = weight;
}

void CvodeBatch::step(const LaneWork& work, std::vector<std::size_t>& alone) {
  const double t = cvode_.step();
  if (has_rows_) sample_until(t);
  const double* const y = cvode_.state().data();
  rates(y, rates_.data());
  if (!kernel_.beyond(limits_, y, rates_.data(), flags_)) return;
  if (has_rows_) write_tile();
  series_.clear();
  const std::size_t before = live_.size();
  for (std::size_t group = 0; group < kBatchGroups; ++group) {
    if (flags_[group] == 0) continue;
    for (std::size_t i = group * kBatchGroup; i < (group + 1) * kBatchGroup; ++i)
      if (models_[i].live && is_beyond(i)) examine(i, work, alone);
  }
  std::erase_if(live_, [this](std::size_t i) { return !models_[i].live; });
  if (live_.size() < before) cvode_.set_weights(weights_);
}

/// The right-hand side.
void CvodeBatch::rates(const double* y, double* ydot) {
  BatchFlags outside;
  if (!kernel_.rates(force_, y, ydot, outside)) return;
  for (std::size_t group = 0; group < kBatchGroups; ++group) {
    if (outside[group] == 0) continue;
    for (std::size_t i = group * kBatchGroup; i < (group + 1) * kBatchGroup; ++i) {
      const double x = y[i], v = y[kBatch + i];
      if (x >= force_.x_low[i] && x <= force_.x_high[i] && v >= force_.v_low[i] && v <= force_.v_high[i]) continue;
      follow(i, x, v);
      ydot[kBatch + i] =
          (force_.constant[i] + x * (force_.x1[i] + x * force_.x2[i])) + v * (force_.v1[i] + v * force_.v2[i]);
      if (force_.has_xv) ydot[kBatch + i] += force_.xv[i] * (x * v);
    }
  }
}

/// Takes the polynomials that hold at (x, v).
void CvodeBatch::follow(std::size_t index, double x, double v) {
  Model& model = models_[index];
  if (x < force_.x_low[index] || x > force_.x_high[index])
    model.spring = move_to(model.data.force.spring, model.spring, x);
  model.damper = move_to(model.data.force.damper, model.damper, v);
  set_polynomials(index);
}

void CvodeBatch::set_polynomials(std::size_t index) {
  const Model& model = models_[index];
  const CrushForce& force = model.data.force;
  const RegionForce here = region_force(force, model.spring, model.damper);
  const Quadratic &spring = here.spring, &damper = here.damper;
  const double per_mass = -1.0 / model.data.mass_kg;
  force_.constant[index] = per_mass * (spring[0] + damper[0]);
  force_.x1[index] = per_mass * spring[1];
  force_.x2[index] = per_mass * spring[2];
  force_.v1[index] = per_mass * damper[1];
  force_.v2[index] = per_mass * damper[2];
  force_.xv[index] = per_mass * here.cross;
  force_.x_low[index] = force.spring.lower(model.spring);
  force_.x_high[index] = force.spring.upper(model.spring);
  force_.v_low[index] = force.damper.lower(model.damper);
  force_.v_high[index] = force.damper.upper(model.damper);
  // Where the force jumps, contact is lost: the step in which it is goes on smoothly.
  if (force_.x_low[index] == 0.0 && spring[0] != 0.0) force_.x_low[index] = -kInfinity;
}

void CvodeBatch::set_limits(std::size_t index) {
  const Model& model = models_[index];
  const CrushForce& force = model.data.force;
  const bool is_loading = std::isnan(model.state.summary.t_m_s);
  const double runaway = kRunaway * model.data.speed_mps;
  const bool bilateral = model.data.unloading.bilateral;
  limits_.x_low[index] = force.spring.lower(force.spring.first_allowed);
  if (!bilateral && jumps(model.data)) limits_.x_low[index] = 0.0;
  limits_.x_high[index] = force.spring.upper(force.spring.last_allowed);
  limits_.v_low[index] = std::max(force.damper.lower(force.damper.first_allowed), -runaway);
  if (is_loading) limits_.v_low[index] = 0.0;
  limits_.v_high[index] = std::min(force.damper.upper(force.damper.last_allowed), runaway);
  limits_.accel_high[index] = bilateral ? kInfinity : 0.0;
}

void CvodeBatch::sample_until(double t) {
  for (; next_sample_ < times_.size() && times_[next_sample_] <= t; ++next_sample_) {
    if (next_sample_ - first_in_tile_ == kTile) write_tile();
    take_sample(cvode_.derivative(times_[next_sample_], 0));
  }
}

void CvodeBatch::take_sample(std::span<const double> y) {
  Sample& sample = tile_[next_sample_ - first_in_tile_];
  std::copy(y.begin(), y.end(), sample.state.begin());
  rates(sample.state.data(), sample.rates.data());
}

/// Writes the samples taken since the last time into the rows of the models in the problem.
void CvodeBatch::write_tile() {
  const std::size_t count = next_sample_ - first_in_tile_;
  for (const std::size_t i : live_) {
    const LaneRow& row = models_[i].row;
    for (std::size_t k = 0; k < count; ++k) row.accel[first_in_tile_ + k] = tile_[k].rates[kBatch + i];
    for (std::size_t k = 0; k < count; ++k) row.velocity[first_in_tile_ + k] = tile_[k].state[kBatch + i];
    for (std::size_t k = 0; k < count; ++k) row.displacement[first_in_tile_ + k] = tile_[k].state[i];
  }
  first_in_tile_ = next_sample_;
}

bool CvodeBatch::is_beyond(std::size_t index) const {
  const double* const y = cvode_.state().data();
  const double x = y[index], v = y[kBatch + index];
  return x < limits_.x_low[index] || x > limits_.x_high[index] || v < limits_.v_low[index] ||
         v > limits_.v_high[index] || rates_[kBatch + index] > limits_.accel_high[index];
}

StepPolynomial CvodeBatch::polynomial(std::size_t index) {
  StepPolynomial step;
  step.base = cvode_.time();
  step.from = -cvode_.last_step();
  step.degree = cvode_.last_order();
  if (series_.empty()) {
    double factor = 1.0;
    for (int k = 0; k <= step.degree; ++k) {
      if (k > 1) factor /= k;
      const auto derivative = cvode_.derivative(step.base, k);
      auto& coefficients = series_.emplace_back();
      std::transform(derivative.begin(), derivative.end(), coefficients.begin(),
                     [factor](double d) { return factor * d; });
    }
  }
  for (std::size_t k = 0; k < series_.size(); ++k) {
    step.x[k] = series_[k][index];
    step.v[k] = series_[k][kBatch + index];
  }
  return step;
}

/// Finds what a model beyond its limits has come to in the last step.
void CvodeBatch::examine(std::size_t index, const LaneWork& work, std::vector<std::size_t>& alone) {
  Model& model = models_[index];
  MotionState& state = model.state;
  const CrushProblem problem = model.data.problem();
  StepPolynomial step = polynomial(index);
  state.region = region_at_start(problem, std::isnan(state.summary.t_m_s), step);
  bool is_over = false;
  for (int events = 0; !is_over && events < kMostEvents; ++events) {
    step.set_ends();
    const Event event = first_event(problem, state.region, step);
    if (event.kind == EventKind::none) break;
    step.from = event.tau;
    end_step(problem, {times_.back(), false}, event, step.base + event.tau, step.x_at(event.tau), step.v_at(event.tau),
             state);
    is_over = state.ended || state.region.separated || state.region.unloading;
  }
  if (is_over) {
    finish_row(index);
    work.finish(index, state.summary);
    remove(index);
  } else if (std::fabs(step.v[0]) > kRunaway * problem.speed_mps) {
    alone.push_back(index);
    remove(index);
  } else {
    set_limits(index);
  }
}

/// Writes the samples after the event at which a model leaves the problem: how it goes on, or that it does not.
void CvodeBatch::finish_row(std::size_t index) {
  Model& model = models_[index];
  const double t = model.state.t;
  const bool goes_on = !model.state.ended;
  const ClosedMotion rest = goes_on ? closed_motion(model.data.problem(), times_.back(), model.state) : ClosedMotion{};
  if (model.row.accel == nullptr) return;
  const auto until = [&] { return std::upper_bound(times_.begin(), times_.end(), t) - times_.begin(); };
  for (auto i = static_cast<std::size_t>(t > 0.0 ? until() : 0); i < times_.size(); ++i) {
    const PointOfMotion point = goes_on ? at(rest, times_[i]) : PointOfMotion{kUnset, kUnset, kUnset};
    model.row.accel[i] = point.accel;
    model.row.velocity[i] = point.velocity;
    model.row.displacement[i] = point.displacement;
  }
}

void CvodeBatch::remove(std::size_t index) {
  models_[index].live = false;
  for (BatchNumbers* numbers :
       {&force_.constant, &force_.x1, &force_.x2, &force_.v1, &force_.v2, &force_.xv, &force_.moves})
    (*numbers)[index] = 0.0;
  for (BatchNumbers* numbers : {&force_.x_low, &force_.v_low, &limits_.x_low, &limits_.v_low})
    (*numbers)[index] = -kInfinity;
  for (BatchNumbers* numbers : {&force_.x_high, &force_.v_high, &limits_.x_high, &limits_.v_high, &limits_.accel_high})
    (*numbers)[index] = kInfinity;
  weights_[index] = weights_[kBatch + index] = 0.0;
}

}  // namespace crashsim
