#include "optimize/fit_objective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "instruction_set.hpp"
#include "solver/crush_motion.hpp"
#include "solver/taylor.hpp"

namespace crashsim {
namespace {

constexpr double kTolerance = 1e-10;  // of a step, relative to the impact speed

static_assert(kFitDegree == kTaylorDegree);

const FitKernel& fit_kernel(CrushLaw law) {
  static const FitKernel& kernel =
      KernelChoice<FitKernel>{kFitKernelBaseline, kFitKernelAvx2, kFitKernelAvx512}(widest_instruction_set());
  return law == CrushLaw::rate ? kRateFitKernel : kernel;
}

Penalty penalty_of(const FitTarget& target, Loss loss, double smoothing) {
  Penalty penalty{
      Penalty::absolute, target.accel_scale, target.velocity_scale, target.displacement_scale, 0.0, 0.0, 0.0};
  const auto round = [&](double accel, double velocity, double displacement) {
    penalty.accel_rounding = accel;
    penalty.velocity_rounding = velocity;
    penalty.displacement_rounding = displacement;
  };
  if (loss == Loss::l2) {
    penalty.kind = Penalty::squared;
  } else if (loss == Loss::huber) {
    penalty.kind = Penalty::huber;
    round(kHuberThreshold, kHuberThreshold, kHuberThreshold);
  } else if (smoothing > 0.0) {
    penalty.kind = Penalty::rounded;
    round(smoothing * target.accel_size, smoothing * target.velocity_size, smoothing * target.displacement_size);
  }
  return penalty;
}

/// With what the kernel may read beyond the last sample.
std::vector<double> padded(std::vector<double> numbers) {
  numbers.resize(numbers.size() + kColumnLanes - 1, numbers.back());
  return numbers;
}

double acceleration(const CrushProblem& problem, const Region& region, double x, double v) {
  return -region_force(problem, region).at(x, v) / problem.mass_kg;
}

}  // namespace

/// Walks a target's samples along the motion, piece by piece. `on_samples(samples)` looks at those of each piece,
/// before the sensitivities of x and v to every parameter are carried to its end.
template <class OnSamples>
class FitObjective::Walk {
 public:
  Walk(FitObjective& fit, const CrushProblem& problem, const PaddedSamples& samples, bool with_sensitivities,
       const OnSamples& on_samples)
      : fit_(fit), problem_(problem), samples_(samples), with_(with_sensitivities), on_samples_(on_samples) {
    std::fill(fit_.by_x_.begin(), fit_.by_x_.end(), 0.0);
    std::fill(fit_.by_v_.begin(), fit_.by_v_.end(), 0.0);
  }

  void on_piece(const Region& region, const StepPolynomial& step, double tau_end) {
    const std::size_t first = next_;
    const double t_end = step.base + tau_end;
    while (next_ < samples_.count && samples_.time[next_] <= t_end) ++next_;
    set_piece(region, step);
    if (with_) fit_.kernel_->sensitivities(fit_.piece_, fit_.series_);
    if (next_ > first)
      on_samples_(FitSamples{&samples_.time[first], &samples_.accel[first], &samples_.velocity[first],
                             &samples_.displacement[first], next_ - first, step.base});
    if (with_) advance(tau_end);
  }

  /// A force that jumps where x reaches a knot makes the velocity's sensitivity jump.
  void on_event(const Region& before, const Region& after, double x, double v) {
    if (!with_ || before.spring == after.spring || v == 0.0) return;
    constexpr double kJump = 1e-9;  // relative: a smaller one is rounding
    const double accel_before = acceleration(problem_, before, x, v), accel_after = acceleration(problem_, after, x, v);
    if (std::fabs(accel_before - accel_after) <= kJump * std::fabs(accel_before)) return;
    const double jump = (accel_before - accel_after) / v;
    for (std::size_t p = 0; p < fit_.by_v_.size(); ++p) fit_.by_v_[p] -= jump * fit_.by_x_[p];
  }

 private:
  void set_piece(const Region& region, const StepPolynomial& step) {
    FitPiece& piece = fit_.piece_;
    const RegionForce force = region_force(problem_, region);
    std::copy_n(step.x.begin(), kFitDegree + 1, piece.x);
    std::copy_n(step.v.begin(), kFitDegree + 1, piece.v);
    std::copy(force.spring.begin(), force.spring.end(), piece.force);
    piece.force[3] = force.damper[1];
    piece.force[4] = force.damper[2];
    piece.force[5] = force.cross;
    piece.rate = force.rate;
    piece.per_reference = force.per_reference;
    piece.mass = problem_.mass_kg;
    if (!with_) return;
    fit_.force_.set_action(region.spring, region.damper, fit_.action_);
    if (region.separated) {
      fit_.action_.count = 0;
      std::fill_n(&fit_.action_.basis[0][0], kActingColumns * 3, 0.0);
    }
    std::copy_n(&fit_.action_.basis[0][0], kActingColumns * 3, &piece.basis[0][0]);
  }

  void advance(double tau) {
    Columns x, v;
    fit_.kernel_->columns_at(fit_.series_, tau, x, v);
    for (std::size_t p = 0; p < fit_.by_x_.size(); ++p) {
      const double by_x = fit_.by_x_[p], by_v = fit_.by_v_[p];
      fit_.by_x_[p] = x[0] * by_x + x[1] * by_v;
      fit_.by_v_[p] = v[0] * by_x + v[1] * by_v;
    }
    for (const auto& [parameter, column, factor] : fit_.action_.entries()) {
      fit_.by_x_[parameter] += factor * x[kHomogeneous + column];
      fit_.by_v_[parameter] += factor * v[kHomogeneous + column];
    }
  }

  FitObjective& fit_;
  const CrushProblem& problem_;
  const PaddedSamples& samples_;
  bool with_;
  const OnSamples& on_samples_;
  std::size_t next_ = 0;
};

FitObjective::FitObjective(const FitStructure& structure, std::span<const FitTarget> targets, Loss loss, double smooth,
                           const Prior& prior)
    : targets_(targets),
      loss_(loss),
      size_(structure.size()),
      kernel_(&fit_kernel(structure.law)),
      force_(structure),
      penalties_(make_penalties(structure, force_scale(structure.law, targets), smooth, prior)),
      by_x_(force_.inner_size()),
      by_v_(force_.inner_size()) {
  for (const FitTarget& target : targets)
    samples_.push_back({padded(target.time_s), padded(target.accel_mps2), padded(target.velocity_mps),
                        padded(target.displacement_m), target.time_s.size()});
  if (!is_table()) return;
  inner_gradient_.resize(force_.inner_size());
  inner_hessian_.resize(force_.by_parameters().rows(), force_.by_parameters().rows());
}

std::span<double> FitObjective::inner(std::span<double> gradient) {
  if (gradient.empty() || !is_table()) return gradient;
  std::fill(inner_gradient_.begin(), inner_gradient_.end(), 0.0);
  return inner_gradient_;
}

void FitObjective::to_parameters(std::span<double> gradient) const {
  if (gradient.empty() || !is_table()) return;
  const Eigen::Map<const Eigen::VectorXd> by_inner(inner_gradient_.data(), force_.by_parameters().rows());
  Eigen::Map<Eigen::VectorXd>(gradient.data(), force_.by_parameters().cols()).noalias() =
      force_.by_parameters().transpose() * by_inner;
}

template <class OnSamples>
bool FitObjective::walk(std::size_t index, bool with_sensitivities, const OnSamples& on_samples) {
  const FitTarget& target = targets_[index];
  const CrushProblem problem{force_.force(), target.mass_kg, target.impact_speed_mps, {}};
  TaylorStepper stepper(kTolerance, false);
  Walk visitor(*this, problem, samples_[index], with_sensitivities, on_samples);
  return integrate_motion(problem, {target.time_s.back(), false}, stepper, visitor).end == MotionEnd::end_time;
}

void FitObjective::add_gradient(const Columns& columns, double weight, std::span<double> gradient) const {
  for (std::size_t p = 0; p < by_x_.size(); ++p)
    gradient[p] += weight * (columns[0] * by_x_[p] + columns[1] * by_v_[p]);
  for (const auto& [parameter, column, factor] : action_.entries())
    gradient[parameter] += weight * factor * columns[kHomogeneous + column];
}

void FitObjective::add_hessian(const PieceLoss& loss, double weight, Eigen::MatrixXd& hessian) const {
  const auto& g = loss.hessian;
  const std::size_t size = by_x_.size();
  for (std::size_t q = 0; q < size; ++q) {
    const double by_x = weight * (g[0][0] * by_x_[q] + g[0][1] * by_v_[q]);
    const double by_v = weight * (g[0][1] * by_x_[q] + g[1][1] * by_v_[q]);
    double* const column = &hessian(0, static_cast<Eigen::Index>(q));
    for (std::size_t p = 0; p < size; ++p) column[p] += by_x * by_x_[p] + by_v * by_v_[p];
  }
  for (const auto& [parameter, acting, factor] : action_.entries()) {
    const std::size_t column = kHomogeneous + acting;
    const auto row = static_cast<Eigen::Index>(parameter);
    for (std::size_t q = 0; q < size; ++q) {
      const double both = weight * factor * (g[0][column] * by_x_[q] + g[1][column] * by_v_[q]);
      hessian(row, static_cast<Eigen::Index>(q)) += both;
      hessian(static_cast<Eigen::Index>(q), row) += both;
    }
    for (const auto& other : action_.entries())
      hessian(row, static_cast<Eigen::Index>(other.parameter)) +=
          weight * factor * other.factor * g[column][kHomogeneous + other.column];
  }
}

double FitObjective::evaluate(std::span<const double> parameters, double smoothing, std::span<double> gradient) {
  force_.set(parameters);
  std::fill(gradient.begin(), gradient.end(), 0.0);
  const std::span<double> by_inner = inner(gradient);
  double total = 0.0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const FitTarget& target = targets_[i];
    const Penalty penalty = penalty_of(target, loss_, smoothing);
    const double weight = target.factor / static_cast<double>(targets_.size());
    const bool has_ended = walk(i, !gradient.empty(), [&](const FitSamples& samples) {
      PieceLoss loss;
      if (gradient.empty()) {
        kernel_->loss(piece_, samples, penalty, loss);
      } else {
        kernel_->loss_and_gradient(piece_, series_, samples, penalty, loss);
        add_gradient(loss.gradient, weight, by_inner);
      }
      total += weight * loss.sum;
    });
    if (!has_ended) return std::numeric_limits<double>::infinity();
  }
  to_parameters(gradient);
  return total + penalty(parameters, gradient);
}

double FitObjective::normal_equations(std::span<const double> parameters, double smoothing, std::span<double> gradient,
                                      Eigen::MatrixXd& hessian) {
  force_.set(parameters);
  std::fill(gradient.begin(), gradient.end(), 0.0);
  const std::span<double> by_inner = inner(gradient);
  Eigen::MatrixXd& by_inner_twice = is_table() ? inner_hessian_ : hessian;
  by_inner_twice.setZero();
  double total = 0.0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const FitTarget& target = targets_[i];
    const Penalty penalty = penalty_of(target, loss_, smoothing);
    const double weight = target.factor / static_cast<double>(targets_.size());
    const bool has_ended = walk(i, true, [&](const FitSamples& samples) {
      PieceLoss loss;
      kernel_->normal_equations(piece_, series_, samples, penalty, loss);
      add_gradient(loss.gradient, weight, by_inner);
      add_hessian(loss, weight, by_inner_twice);
      total += weight * loss.sum;
    });
    if (!has_ended) return std::numeric_limits<double>::infinity();
  }
  if (is_table()) hessian.noalias() = force_.by_parameters().transpose() * inner_hessian_ * force_.by_parameters();
  to_parameters(gradient);
  if (penalties_.rows.rows() > 0) hessian.noalias() += 2.0 * penalties_.rows.transpose() * penalties_.rows;
  return total + penalty(parameters, gradient);
}

double FitObjective::penalty(std::span<const double> parameters, std::span<double> gradient) const {
  if (penalties_.rows.rows() == 0) return 0.0;
  const Eigen::Map<const Eigen::VectorXd> p(parameters.data(), penalties_.rows.cols());
  const Eigen::VectorXd deviation = penalties_.rows * p - penalties_.aims;
  if (!gradient.empty())
    Eigen::Map<Eigen::VectorXd>(gradient.data(), p.size()).noalias() += 2.0 * penalties_.rows.transpose() * deviation;
  return deviation.squaredNorm();
}

Eigen::MatrixXd FitObjective::penalty_rows() const {
  return std::sqrt(static_cast<double>(targets_.size())) * penalties_.rows;  // jacobian() is of the targets' sum
}

Eigen::MatrixXd FitObjective::jacobian(std::span<const double> parameters) {
  force_.set(parameters);
  std::size_t rows = 0;
  for (const FitTarget& target : targets_) rows += 3 * target.time_s.size();
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(by_x_.size()));
  jacobian.setZero();
  std::vector<double> line(by_x_.size());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const FitTarget& target = targets_[i];
    const double factor = std::sqrt(target.factor);
    const auto fill = [&](const Columns& columns, double scale) {
      std::fill(line.begin(), line.end(), 0.0);
      add_gradient(columns, factor * scale, line);
      jacobian.row(row++) = Eigen::Map<const Eigen::RowVectorXd>(line.data(), jacobian.cols());
    };
    walk(i, true, [&](const FitSamples& samples) {
      for (std::size_t j = 0; j < samples.count; ++j) {
        Columns a, v, x;
        columns_at_sample(samples.time[j] - samples.base, a, v, x);
        fill(a, target.accel_scale);
        fill(v, target.velocity_scale);
        fill(x, target.displacement_scale);
      }
    });
  }
  if (is_table()) return jacobian * force_.by_parameters();
  return jacobian;
}

void FitObjective::columns_at_sample(double tau, Columns& accel, Columns& velocity, Columns& displacement) const {
  kernel_->columns_at(series_, tau, displacement, velocity);
  for (std::size_t c = 0; c < kColumns; ++c) {
    accel[c] = 0.0;
    for (int n = kFitDegree; n >= 1; --n) accel[c] = accel[c] * tau + n * series_.v[n][c];
  }
}

}  // namespace crashsim
