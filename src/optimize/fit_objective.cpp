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

const FitKernel& fit_kernel() {
  static const FitKernel& kernel =
      KernelChoice<FitKernel>{kFitKernelBaseline, kFitKernelAvx2, kFitKernelAvx512}(widest_instruction_set());
  return kernel;
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
    if (with_) fit_kernel().sensitivities(fit_.piece_, fit_.series_);
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
    for (std::size_t p = 0; p < fit_.size_; ++p) fit_.by_v_[p] -= jump * fit_.by_x_[p];
  }

 private:
  void set_piece(const Region& region, const StepPolynomial& step) {
    FitPiece& piece = fit_.piece_;
    const RegionForce force = region_force(problem_, region);
    std::copy_n(step.x.begin(), kFitDegree + 1, piece.x);
    std::copy_n(step.v.begin(), kFitDegree + 1, piece.v);
    std::copy(force.spring.begin(), force.spring.end(), piece.spring);
    std::copy(force.damper.begin(), force.damper.end(), piece.damper);
    piece.mass = problem_.mass_kg;
    if (!with_) return;
    const ForceAxis &spring = problem_.force.spring, &damper = problem_.force.damper;
    for (std::size_t j = 0; j < 2; ++j) {
      set_basis(region.separated, spring.segments[static_cast<std::size_t>(region.spring)][j], 0, j);
      set_basis(region.separated, damper.segments[static_cast<std::size_t>(region.damper)][j],
                static_cast<int>(fit_.spring_count_), 2 + j);
    }
  }

  void set_basis(bool separated, const OrdinateBasis& basis, int offset, std::size_t column) {
    const bool acts = basis.ordinate >= 0 && !separated;
    fit_.acting_[column] = acts ? offset + basis.ordinate : -1;
    for (std::size_t i = 0; i < 3; ++i) fit_.piece_.basis[column][i] = acts ? basis.c[i] : 0.0;
  }

  void advance(double tau) {
    Columns x, v;
    fit_kernel().columns_at(fit_.series_, tau, x, v);
    for (std::size_t p = 0; p < fit_.size_; ++p) {
      const double by_x = fit_.by_x_[p], by_v = fit_.by_v_[p];
      fit_.by_x_[p] = x[0] * by_x + x[1] * by_v;
      fit_.by_v_[p] = v[0] * by_x + v[1] * by_v;
    }
    for (std::size_t j = 0; j < fit_.acting_.size(); ++j) {
      if (fit_.acting_[j] < 0) continue;
      const auto p = static_cast<std::size_t>(fit_.acting_[j]);
      fit_.by_x_[p] += x[kHomogeneous + j];
      fit_.by_v_[p] += v[kHomogeneous + j];
    }
  }

  FitObjective& fit_;
  const CrushProblem& problem_;
  const PaddedSamples& samples_;
  bool with_;
  const OnSamples& on_samples_;
  std::size_t next_ = 0;
};

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
      by_x_(size_),
      by_v_(size_) {
  for (const FitTarget& target : targets)
    samples_.push_back({padded(target.time_s), padded(target.accel_mps2), padded(target.velocity_mps),
                        padded(target.displacement_m), target.time_s.size()});
  force_ = make_force({structure.law, Extrapolation::constant, structure.spring_knots, structure.damper_knots});
}

void FitObjective::set(std::span<const double> parameters) {
  force_.set_ordinates(parameters.first(spring_count_), parameters.subspan(spring_count_));
}

template <class OnSamples>
bool FitObjective::walk(std::size_t index, bool with_sensitivities, const OnSamples& on_samples) {
  const FitTarget& target = targets_[index];
  const CrushProblem problem{force_, target.mass_kg, target.impact_speed_mps, {}};
  TaylorStepper stepper(kTolerance, false);
  Walk visitor(*this, problem, samples_[index], with_sensitivities, on_samples);
  return integrate_motion(problem, {target.time_s.back(), false}, stepper, visitor).end == MotionEnd::end_time;
}

void FitObjective::add_gradient(const Columns& columns, double weight, std::span<double> gradient) const {
  for (std::size_t p = 0; p < size_; ++p) gradient[p] += weight * (columns[0] * by_x_[p] + columns[1] * by_v_[p]);
  for (std::size_t j = 0; j < acting_.size(); ++j)
    if (acting_[j] >= 0) gradient[static_cast<std::size_t>(acting_[j])] += weight * columns[kHomogeneous + j];
}

void FitObjective::add_hessian(const PieceLoss& loss, double weight, Eigen::MatrixXd& hessian) const {
  const auto& g = loss.hessian;
  for (std::size_t q = 0; q < size_; ++q) {
    const double by_x = weight * (g[0][0] * by_x_[q] + g[0][1] * by_v_[q]);
    const double by_v = weight * (g[0][1] * by_x_[q] + g[1][1] * by_v_[q]);
    double* const column = &hessian(0, static_cast<Eigen::Index>(q));
    for (std::size_t p = 0; p < size_; ++p) column[p] += by_x * by_x_[p] + by_v * by_v_[p];
  }
  for (std::size_t j = 0; j < acting_.size(); ++j) {
    if (acting_[j] < 0) continue;
    const std::size_t column = kHomogeneous + j;
    for (std::size_t q = 0; q < size_; ++q) {
      const double both = weight * (g[0][column] * by_x_[q] + g[1][column] * by_v_[q]);
      hessian(acting_[j], static_cast<Eigen::Index>(q)) += both;
      hessian(static_cast<Eigen::Index>(q), acting_[j]) += both;
    }
    for (std::size_t k = 0; k < acting_.size(); ++k)
      if (acting_[k] >= 0) hessian(acting_[j], acting_[k]) += weight * g[column][kHomogeneous + k];
  }
}

double FitObjective::evaluate(std::span<const double> parameters, double smoothing, std::span<double> gradient) {
  set(parameters);
  std::fill(gradient.begin(), gradient.end(), 0.0);
  double total = 0.0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const FitTarget& target = targets_[i];
    const Penalty penalty = penalty_of(target, loss_, smoothing);
    const double weight = target.factor / static_cast<double>(targets_.size());
    const bool has_ended = walk(i, !gradient.empty(), [&](const FitSamples& samples) {
      PieceLoss loss;
      if (gradient.empty()) {
        fit_kernel().loss(piece_, samples, penalty, loss);
      } else {
        fit_kernel().loss_and_gradient(piece_, series_, samples, penalty, loss);
        add_gradient(loss.gradient, weight, gradient);
      }
      total += weight * loss.sum;
    });
    if (!has_ended) return std::numeric_limits<double>::infinity();
  }
  return total + roughness(parameters, gradient);
}

double FitObjective::normal_equations(std::span<const double> parameters, double smoothing, std::span<double> gradient,
                                      Eigen::MatrixXd& hessian) {
  set(parameters);
  std::fill(gradient.begin(), gradient.end(), 0.0);
  hessian.setZero();
  double total = 0.0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const FitTarget& target = targets_[i];
    const Penalty penalty = penalty_of(target, loss_, smoothing);
    const double weight = target.factor / static_cast<double>(targets_.size());
    const bool has_ended = walk(i, true, [&](const FitSamples& samples) {
      PieceLoss loss;
      fit_kernel().normal_equations(piece_, series_, samples, penalty, loss);
      add_gradient(loss.gradient, weight, gradient);
      add_hessian(loss, weight, hessian);
      total += weight * loss.sum;
    });
    if (!has_ended) return std::numeric_limits<double>::infinity();
  }
  const Eigen::MatrixXd rough = roughness_rows();  // of the targets' sum
  if (rough.rows() > 0) hessian.noalias() += 2.0 / static_cast<double>(targets_.size()) * rough.transpose() * rough;
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
  std::size_t rows = 0;
  for (const FitTarget& target : targets_) rows += 3 * target.time_s.size();
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(size_));
  jacobian.setZero();
  std::vector<double> line(size_);
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
  return jacobian;
}

void FitObjective::columns_at_sample(double tau, Columns& accel, Columns& velocity, Columns& displacement) const {
  fit_kernel().columns_at(series_, tau, displacement, velocity);
  for (std::size_t c = 0; c < kColumns; ++c) {
    accel[c] = 0.0;
    for (int n = kFitDegree; n >= 1; --n) accel[c] = accel[c] * tau + n * series_.v[n][c];
  }
}

}  // namespace crashsim
