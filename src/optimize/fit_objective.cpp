#include "optimize/fit_objective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "optimize/loss_moments.hpp"
#include "optimize/sensitivity.hpp"
#include "solver/crush_motion.hpp"
#include "solver/taylor.hpp"

namespace crashsim {
namespace {

constexpr int kDegree = 12;           // cheapest of 8..16 at the tolerance below
constexpr double kTolerance = 1e-11;  // of a step, relative to the impact speed

/// Sensitivities of x and v to every parameter, carried from piece to piece.
class SensitivityState {
 public:
  SensitivityState(std::vector<double>& x, std::vector<double>& v) : x_(x), v_(v) {
    std::fill(x_.begin(), x_.end(), 0.0);
    std::fill(v_.begin(), v_.end(), 0.0);
  }

  /// Adds to `gradient` what a linear functional of the piece, known on the six columns, says of every parameter.
  void accumulate(const SensitivitySeries& series, const Lanes& functional, std::span<double> gradient) const {
    for (std::size_t p = 0; p < x_.size(); ++p) gradient[p] += functional[0] * x_[p] + functional[1] * v_[p];
    for (std::size_t lane = kHomogeneous; lane < kColumns; ++lane)
      if (series.ordinate[lane] >= 0) gradient[static_cast<std::size_t>(series.ordinate[lane])] += functional[lane];
  }

  void advance(const SensitivitySeries& series, int degree, double tau) {
    SensitivityValues at;
    crashsim::evaluate(series, degree, tau, at);
    for (std::size_t p = 0; p < x_.size(); ++p) {
      const double x = x_[p], v = v_[p];
      x_[p] = at.x[0] * x + at.x[1] * v;
      v_[p] = at.v[0] * x + at.v[1] * v;
    }
    for (std::size_t lane = kHomogeneous; lane < kColumns; ++lane) {
      if (series.ordinate[lane] < 0) continue;
      const auto p = static_cast<std::size_t>(series.ordinate[lane]);
      x_[p] += at.x[lane];
      v_[p] += at.v[lane];
    }
  }

  /// A force that jumps where x reaches a knot makes the velocity's sensitivity jump.
  void jump(double accel_before, double accel_after, double v) {
    const double jump = (accel_before - accel_after) / v;
    for (std::size_t p = 0; p < x_.size(); ++p) v_[p] -= jump * x_[p];
  }

 private:
  std::vector<double>& x_;
  std::vector<double>& v_;
};

double acceleration(const CrushProblem& problem, const Region& region, double x, double v) {
  const RegionForce force = region_force(problem, region);
  return -(value(force.spring, x) + value(force.damper, v)) / problem.mass_kg;
}

/// Walks a target's samples along the motion, with the sensitivities of each piece. Derived: `samples(region, step,
/// tau_end, first, last)` for the samples [first, last) of a piece.
template <class Derived>
class SampleVisitor {
 public:
  SampleVisitor(const CrushProblem& problem, const FitTarget& target, int damper_offset, bool with_sensitivities,
                std::vector<double>& sx, std::vector<double>& sv)
      : problem_(problem),
        target_(target),
        damper_offset_(damper_offset),
        with_sensitivities_(with_sensitivities),
        state_(sx, sv) {}

  void on_piece(const Region& region, const StepPolynomial& step, double tau_end) {
    const std::size_t first = next_;
    const double t_end = step.base + tau_end;
    while (next_ < target_.time_s.size() && target_.time_s[next_] <= t_end) ++next_;
    if (with_sensitivities_) sensitivity_series(problem_, region, step, damper_offset_, series_);
    static_cast<Derived&>(*this).samples(region, step, tau_end, first, next_);
    if (with_sensitivities_) state_.advance(series_, step.degree, tau_end);
  }

  void on_event(const Region& before, const Region& after, double x, double v) {
    if (!with_sensitivities_ || (before.spring == after.spring)) return;
    const double accel_before = acceleration(problem_, before, x, v), accel_after = acceleration(problem_, after, x, v);
    constexpr double kJump = 1e-9;  // relative: a smaller one is rounding
    if (v != 0.0 && std::fabs(accel_before - accel_after) > kJump * std::fabs(accel_before))
      state_.jump(accel_before, accel_after, v);
  }

 protected:
  const CrushProblem& problem_;
  const FitTarget& target_;
  int damper_offset_;
  bool with_sensitivities_;
  SensitivityState state_;
  SensitivitySeries series_;
  std::size_t next_ = 0;
};

/// Sum of the losses, and its gradient through their moments.
class LossVisitor : public SampleVisitor<LossVisitor> {
 public:
  LossVisitor(const CrushProblem& problem, const FitTarget& target, int damper_offset, const Penalty& penalty,
              double weight, std::span<double> gradient, std::vector<double>& sx, std::vector<double>& sv)
      : SampleVisitor(problem, target, damper_offset, penalty.with_moments, sx, sv),
        penalty_(penalty),
        weight_(weight),
        gradient_(gradient) {}

  void samples(const Region& region, const StepPolynomial& step, double tau_end, std::size_t first, std::size_t last) {
    if (first == last) return;
    LossMoments moments;
    loss_moments(target_, first, last, step, tau_end, region_force(problem_, region), penalty_, moments);
    sum_ += moments.sum;
    if (!with_sensitivities_) return;
    Lanes functional{};
    for (std::size_t n = 0; n <= static_cast<std::size_t>(step.degree); ++n) {
      const double accel = n > 0 ? static_cast<double>(n) * moments.a[n - 1] : 0.0;
      functional += series_.x[n] * moments.x[n] + series_.v[n] * (moments.v[n] + accel);
    }
    functional *= weight_;
    state_.accumulate(series_, functional, gradient_);
  }

  [[nodiscard]] double sum() const { return sum_; }

 private:
  Penalty penalty_;
  double weight_;
  std::span<double> gradient_;
  double sum_ = 0.0;
};

/// Rows of scaled sensitivities at every sample.
class JacobianVisitor : public SampleVisitor<JacobianVisitor> {
 public:
  JacobianVisitor(const CrushProblem& problem, const FitTarget& target, int damper_offset,
                  Eigen::Ref<Eigen::MatrixXd> rows, std::vector<double>& sx, std::vector<double>& sv)
      : SampleVisitor(problem, target, damper_offset, true, sx, sv),
        rows_(rows),
        row_(static_cast<std::size_t>(rows.cols())) {}

  void samples(const Region&, const StepPolynomial& step, double tau_end, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const double tau = std::min(target_.time_s[i] - step.base, tau_end);
      SensitivityValues at;
      crashsim::evaluate(series_, step.degree, tau, at);
      Lanes accel{};
      for (int n = step.degree; n >= 1; --n)
        accel = accel * tau + static_cast<double>(n) * series_.v[static_cast<std::size_t>(n)];
      const auto row = static_cast<Eigen::Index>(3 * i);
      fill(row, accel, target_.accel_scale);
      fill(row + 1, at.v, target_.velocity_scale);
      fill(row + 2, at.x, target_.displacement_scale);
    }
  }

 private:
  void fill(Eigen::Index row, const Lanes& functional, double scale) {
    std::fill(row_.begin(), row_.end(), 0.0);
    state_.accumulate(series_, functional, row_);
    for (std::size_t p = 0; p < row_.size(); ++p) rows_(row, static_cast<Eigen::Index>(p)) = scale * row_[p];
  }

  Eigen::Ref<Eigen::MatrixXd> rows_;
  std::vector<double> row_;
};

}  // namespace

ForceScale force_scale(CrushLaw law, std::span<const FitTarget> targets) {
  double force = 0.0, crush = 0.0, speed = 0.0;
  for (const FitTarget& target : targets) {
    for (const double a : target.accel_mps2) force = std::max(force, target.mass_kg * std::fabs(a));
    crush = std::max(crush, target.max_crush_m);
    speed = std::max(speed, target.impact_speed_mps);
  }
  return {law == CrushLaw::stiffness ? force / crush : force, force / speed};
}

CrushModel make_model(const FitStructure& structure, std::span<const double> parameters, double mass_kg,
                      double impact_speed_mps) {
  const auto split = parameters.begin() + static_cast<std::ptrdiff_t>(structure.spring_knots.size());
  CrushModel model;
  model.mass_kg = mass_kg;
  model.impact_speed_mps = impact_speed_mps;
  model.law = structure.law;
  model.spring = {structure.spring_knots, {parameters.begin(), split}};
  model.damper = {structure.damper_knots, {split, parameters.end()}};
  return model;
}

FitObjective::FitObjective(const FitStructure& structure, std::span<const FitTarget> targets, Loss loss, double smooth)
    : targets_(targets),
      loss_(loss),
      smooth_(smooth),
      spring_count_(structure.spring_knots.size()),
      size_(structure.size()),
      scale_(force_scale(structure.law, targets)),
      sensitivity_x_(size_),
      sensitivity_v_(size_) {
  force_.spring = make_axis(structure.spring_knots, structure.law == CrushLaw::stiffness, Extrapolation::constant);
  force_.damper = make_axis(structure.damper_knots, true, Extrapolation::constant);
}

void FitObjective::set(std::span<const double> parameters) {
  force_.set_ordinates(parameters.first(spring_count_), parameters.subspan(spring_count_));
}

double FitObjective::evaluate(std::span<const double> parameters, double smoothing, std::span<double> gradient) {
  set(parameters);
  std::fill(gradient.begin(), gradient.end(), 0.0);
  double total = 0.0;
  TaylorStepper stepper(kTolerance, kDegree, false);
  for (const FitTarget& target : targets_) {
    const CrushProblem problem{force_, target.mass_kg, target.impact_speed_mps, {}};
    const double weight = target.factor / static_cast<double>(targets_.size());
    LossVisitor visitor(problem, target, static_cast<int>(spring_count_), {loss_, smoothing, !gradient.empty()}, weight,
                        gradient, sensitivity_x_, sensitivity_v_);
    const MotionSummary summary = integrate_motion(problem, {target.time_s.back(), false}, stepper, visitor);
    if (summary.end != MotionEnd::end_time) return std::numeric_limits<double>::infinity();
    total += weight * visitor.sum();
  }
  return total + roughness(parameters, gradient);
}

double FitObjective::roughness(std::span<const double> parameters, std::span<double> gradient) const {
  if (smooth_ == 0.0) return 0.0;
  double sum = 0.0;
  const auto add_curve = [&](std::size_t first, std::size_t count, double scale) {
    for (std::size_t i = first; i + 2 < first + count; ++i) {
      const double d = (parameters[i] - 2.0 * parameters[i + 1] + parameters[i + 2]) / scale;
      sum += smooth_ * d * d;
      if (gradient.empty()) continue;
      const double g = 2.0 * smooth_ * d / scale;
      gradient[i] += g;
      gradient[i + 1] -= 2.0 * g;
      gradient[i + 2] += g;
    }
  };
  add_curve(0, spring_count_, scale_.spring);
  add_curve(spring_count_, size_ - spring_count_, scale_.damper);
  return sum;
}

Eigen::MatrixXd FitObjective::roughness_rows() const {
  const auto rows_of = [](std::size_t knots) { return static_cast<Eigen::Index>(knots < 3 ? 0 : knots - 2); };
  const Eigen::Index springs = rows_of(spring_count_), dampers = rows_of(size_ - spring_count_);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(smooth_ > 0.0 ? springs + dampers : 0, static_cast<Eigen::Index>(size_));
  const double root = std::sqrt(smooth_ * static_cast<double>(targets_.size()));  // jacobian() is of the targets' sum
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const bool is_spring = row < springs;
    const Eigen::Index first = is_spring ? row : static_cast<Eigen::Index>(spring_count_) + row - springs;
    rows.block(row, first, 1, 3) << 1.0, -2.0, 1.0;
    rows.row(row) *= root / (is_spring ? scale_.spring : scale_.damper);
  }
  return rows;
}

Eigen::MatrixXd FitObjective::jacobian(std::span<const double> parameters) {
  set(parameters);
  Eigen::Index rows = 0;
  for (const FitTarget& target : targets_) rows += 3 * static_cast<Eigen::Index>(target.time_s.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(size_));
  Eigen::Index first = 0;
  TaylorStepper stepper(kTolerance, kDegree, false);
  for (const FitTarget& target : targets_) {
    const auto count = 3 * static_cast<Eigen::Index>(target.time_s.size());
    const CrushProblem problem{force_, target.mass_kg, target.impact_speed_mps, {}};
    JacobianVisitor visitor(problem, target, static_cast<int>(spring_count_), jacobian.middleRows(first, count),
                            sensitivity_x_, sensitivity_v_);
    integrate_motion(problem, {target.time_s.back(), false}, stepper, visitor);
    jacobian.middleRows(first, count) *= std::sqrt(target.factor);
    first += count;
  }
  return jacobian;
}

}  // namespace crashsim
