#include "optimize/test_corrections.hpp"

#include <algorithm>
#include <cmath>

#include <crashsim/simulate.hpp>

#include "optimize/bounded_least_squares.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFarthest = 5.0;     // deviations that a correction may reach
constexpr double kDifference = 1e-4;  // of a deviation, for derivatives; the target is nearly linear in the corrections
constexpr double kRounding = 1e-3;    // of the corner of |u|
constexpr double kLeastResidual = 1e-12;
constexpr int kMostSteps = 60;
constexpr double kSettled = 1e-9;  // relative decrease that ends the steps
constexpr double kFirstDamping = 1e-3, kMostDamping = 1e6;
constexpr double kRtol = 1e-10;

std::span<const double> view(const VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// The pulse's acceleration at time t, linear between samples. Before the first sample it is that sample's, and after
/// the last the last one's: what was not recorded must not make a step.
double accel_at(const Pulse& pulse, double t) {
  if (t < pulse.time_s.front()) return pulse.accel_mps2.front();
  const auto after = std::upper_bound(pulse.time_s.begin(), pulse.time_s.end(), t);
  if (after == pulse.time_s.end()) return pulse.accel_mps2.back();
  const auto i = static_cast<std::size_t>(after - pulse.time_s.begin());
  const double part = (t - pulse.time_s[i - 1]) / (pulse.time_s[i] - pulse.time_s[i - 1]);
  return std::lerp(pulse.accel_mps2[i - 1], pulse.accel_mps2[i], part);
}

/// Rows of a target as those of the Jacobian: acceleration, velocity, displacement of each sample in turn, scaled.
template <class Get>
void fill_rows(const FitTarget& target, const Get& get, Index& row, VectorXd& out) {
  const double factor = std::sqrt(target.factor);
  for (std::size_t i = 0; i < target.time_s.size(); ++i) {
    const std::array<double, 3> values = get(i);
    out[row++] = factor * target.accel_scale * values[0];
    out[row++] = factor * target.velocity_scale * values[1];
    out[row++] = factor * target.displacement_scale * values[2];
  }
}

Index rows_of(std::span<const FitTarget> targets) {
  std::size_t rows = 0;
  for (const FitTarget& target : targets) rows += 3 * target.time_s.size();
  return static_cast<Index>(rows);
}

/// The model's motion at the samples of all targets; empty when a simulation fails.
VectorXd model_rows(const FitStudy& study, std::span<const double> parameters) {
  VectorXd rows(rows_of(study.targets));
  Index row = 0;
  for (const FitTarget& target : study.targets) {
    SimulateOptions options;
    options.times_s = target.time_s;
    options.rtol = kRtol;
    options.integrator = Integrator::taylor;
    const CrushResponse run =
        simulate(make_model(study.structure, parameters, target.mass_kg, target.impact_speed_mps), options);
    if (run.time_s.size() != target.time_s.size()) return {};
    fill_rows(
        target,
        [&run](std::size_t i) {
          return std::array{run.accel_mps2[i], run.velocity_mps[i], run.displacement_m[i]};
        },
        row, rows);
  }
  return rows;
}

std::vector<FitTarget> corrected_targets(const FitStudy& study, std::span<const Pulse> pulses,
                                         const SoughtCorrections& sought, std::span<const double> corrections) {
  std::vector<FitTarget> targets;
  for (std::size_t i = 0; i < study.targets.size(); ++i)
    targets.push_back(corrected(study.targets[i], pulses[i], sought.of_test(corrections, i)));
  return targets;
}

VectorXd target_rows(std::span<const FitTarget> targets) {
  VectorXd rows(rows_of(targets));
  Index row = 0;
  for (const FitTarget& target : targets)
    fill_rows(
        target,
        [&target](std::size_t i) {
          return std::array{target.accel_mps2[i], target.velocity_mps[i], target.displacement_m[i]};
        },
        row, rows);
  return rows;
}

/// Factor sqrt(target.factor) of every row.
VectorXd factor_rows(std::span<const FitTarget> targets) {
  VectorXd rows(rows_of(targets));
  Index row = 0;
  for (const FitTarget& target : targets) {
    const auto count = static_cast<Index>(3 * target.time_s.size());
    rows.segment(row, count).setConstant(std::sqrt(target.factor));
    row += count;
  }
  return rows;
}

/// Sum of the losses of all targets with their penalties, about a point of parameters and corrections.
class JointProblem {
 public:
  JointProblem(const FitStudy& study, std::span<const Pulse> pulses, const SoughtCorrections& sought)
      : study_(study),
        pulses_(pulses),
        sought_(sought),
        objective_(study.objective()),
        factors_(factor_rows(study.targets)),
        prior_rows_(correction_rows(study, sought)) {}

  struct State {
    VectorXd parameters, corrections;
    VectorXd residuals;
    double value = std::numeric_limits<double>::infinity();
  };

  void evaluate(State& state) const {
    const VectorXd model = model_rows(study_, view(state.parameters));
    if (model.size() == 0) return;
    state.residuals = model - target_rows(corrected_targets(study_, pulses_, sought_, view(state.corrections)));
    state.value = (prior_rows_ * state.corrections).squaredNorm() + penalty(state.parameters).squaredNorm();
    for (Index i = 0; i < model.size(); ++i)
      state.value += factors_[i] * factors_[i] *
                     loss_value(study_.options.loss, state.residuals[i] / factors_[i], kRounding).value;
  }

  /// Normal equations' rows at a state, each residual weighted as its loss says at its size.
  void linearise(const State& state, MatrixXd& rows, VectorXd& right) {
    const Index samples = state.residuals.size(), p = state.parameters.size(), c = state.corrections.size();
    const MatrixXd penalties = objective_.penalty_rows();
    rows = MatrixXd::Zero(samples + penalties.rows() + prior_rows_.rows(), p + c);
    right = VectorXd::Zero(rows.rows());
    rows.topLeftCorner(samples, p) = objective_.jacobian(view(state.parameters));
    rows.topRightCorner(samples, c) = correction_jacobian(study_, pulses_, sought_, view(state.corrections));
    for (Index i = 0; i < samples; ++i) {
      const double u = std::max(std::fabs(state.residuals[i] / factors_[i]), kLeastResidual);
      const double weight = loss_value(study_.options.loss, u, kRounding).derivative / (2.0 * u);
      rows.row(i) *= std::sqrt(weight);
      right[i] = -std::sqrt(weight) * state.residuals[i];
    }
    rows.block(samples, 0, penalties.rows(), p) = penalties;
    right.segment(samples, penalties.rows()) = -penalty(state.parameters);
    rows.bottomRightCorner(prior_rows_.rows(), c) = prior_rows_;
    right.tail(prior_rows_.rows()) = -prior_rows_ * state.corrections;
  }

 private:
  [[nodiscard]] VectorXd penalty(const VectorXd& parameters) const {
    const Penalties& penalties = objective_.penalties();
    const double root = std::sqrt(static_cast<double>(study_.targets.size()));
    return root * (penalties.rows * parameters - penalties.aims);
  }

  const FitStudy& study_;
  std::span<const Pulse> pulses_;
  const SoughtCorrections& sought_;
  FitObjective objective_;
  VectorXd factors_;
  MatrixXd prior_rows_;
};

/// Step of Levenberg and Marquardt within the bounds, in units of them.
VectorXd bounded_step(const MatrixXd& rows, const VectorXd& right, const VectorXd& low, const VectorXd& high,
                      double damping) {
  const VectorXd width = high - low;
  const MatrixXd scaled = rows * width.asDiagonal();
  const double most = scaled.colwise().squaredNorm().maxCoeff();
  MatrixXd a(scaled.rows() + scaled.cols(), scaled.cols());
  a << scaled, std::sqrt(damping * most) * MatrixXd::Identity(scaled.cols(), scaled.cols());
  VectorXd b = VectorXd::Zero(a.rows());
  b.head(right.size()) = right;
  const VectorXd from = (-low).cwiseQuotient(width);  // where the step is zero
  const VectorXd to = bounded_least_squares(a, b + a * from, VectorXd::Ones(width.size()));
  return (to - from).cwiseProduct(width);
}

}  // namespace

FitTarget corrected(const FitTarget& target, const Pulse& pulse, const TestCorrection& correction) {
  FitTarget out = target;
  double velocity = 0.0, displacement = 0.0, before = 0.0;
  for (std::size_t i = 0; i < target.time_s.size(); ++i) {
    const double measured = accel_at(pulse, target.time_s[i] + correction.time_shift_s);
    out.accel_mps2[i] = (measured - correction.bias_mps2) / correction.gain;
    const double change = out.accel_mps2[i] - target.accel_mps2[i];
    if (i > 0) {
      const double dt = target.time_s[i] - target.time_s[i - 1], gained = 0.5 * dt * (before + change);
      displacement += dt * (velocity + 0.5 * gained);
      velocity += gained;
    }
    before = change;
    out.velocity_mps[i] += velocity;
    out.displacement_m[i] += displacement;
  }
  return out;
}

SoughtCorrections::SoughtCorrections(const IdentifyOptions& options, std::size_t tests) : tests_(tests) {
  const auto seek = [this](double TestCorrection::*member, double deviation, Reported reported) {
    if (deviation > 0.0) kinds_.push_back({member, deviation, reported});
  };
  seek(&TestCorrection::time_shift_s, options.time_shift_deviation_s,
       {&TestReport::time_shift_s, &TestReport::time_shift_error_s});
  seek(&TestCorrection::gain, options.gain_deviation, {&TestReport::gain, &TestReport::gain_error});
  seek(&TestCorrection::bias_mps2, options.bias_deviation_mps2, {&TestReport::bias_mps2, &TestReport::bias_error_mps2});
}

TestCorrection SoughtCorrections::of_test(std::span<const double> numbers, std::size_t test) const {
  TestCorrection correction;
  for (std::size_t k = 0; k < kinds_.size(); ++k) correction.*kinds_[k].member += numbers[test * kinds_.size() + k];
  return correction;
}

MatrixXd correction_rows(const FitStudy& study, const SoughtCorrections& sought) {
  const auto size = static_cast<Index>(sought.size());
  MatrixXd rows = MatrixXd::Zero(size, size);
  const double root = std::sqrt(study.observation_error * static_cast<double>(study.targets.size()));
  for (Index i = 0; i < size; ++i) rows(i, i) = root / sought.deviation(static_cast<std::size_t>(i));
  return rows;
}

MatrixXd correction_jacobian(const FitStudy& study, std::span<const Pulse> pulses, const SoughtCorrections& sought,
                             std::span<const double> corrections) {
  MatrixXd jacobian = MatrixXd::Zero(rows_of(study.targets), static_cast<Index>(sought.size()));
  std::vector<double> moved(corrections.begin(), corrections.end());
  Index first = 0;
  for (std::size_t test = 0; test < study.targets.size(); ++test) {
    const FitTarget& target = study.targets[test];
    const auto count = static_cast<Index>(3 * target.time_s.size());
    const auto rows_at = [&](std::size_t index, double difference) {
      moved[index] = corrections[index] + difference;
      const FitTarget there = corrected(target, pulses[test], sought.of_test(moved, test));
      moved[index] = corrections[index];
      return target_rows({&there, 1});
    };
    for (std::size_t i = 0; i < sought.size(); ++i) {
      if (sought.test_of(i) != test) continue;
      const double difference = kDifference * sought.deviation(i);
      jacobian.col(static_cast<Index>(i)).segment(first, count) =
          (rows_at(i, -difference) - rows_at(i, difference)) / (2.0 * difference);
    }
    first += count;
  }
  return jacobian;
}

CorrectedFit fit_corrections(const FitStudy& study, std::span<const Pulse> pulses, const SoughtCorrections& sought,
                             std::vector<double> parameters) {
  JointProblem problem(study, pulses, sought);
  const auto p = static_cast<Index>(parameters.size()), c = static_cast<Index>(sought.size());
  JointProblem::State here{Eigen::Map<const VectorXd>(parameters.data(), p), VectorXd::Zero(c), {}};
  problem.evaluate(here);
  VectorXd farthest(c);
  for (Index i = 0; i < c; ++i) farthest[i] = kFarthest * sought.deviation(static_cast<std::size_t>(i));
  MatrixXd rows;
  VectorXd right;
  double damping = kFirstDamping;
  for (int step = 0; step < kMostSteps && std::isfinite(here.value) && damping < kMostDamping; ++step) {
    problem.linearise(here, rows, right);
    VectorXd low(p + c), high(p + c);
    low << -here.parameters, -farthest - here.corrections;
    high << study.upper - here.parameters, farthest - here.corrections;
    const VectorXd change = bounded_step(rows, right, low, high, damping);
    JointProblem::State there{
        (here.parameters + change.head(p)).cwiseMax(0.0).cwiseMin(study.upper), here.corrections + change.tail(c), {}};
    problem.evaluate(there);
    if (!(there.value < here.value)) {
      damping *= 8.0;
      continue;
    }
    const double decrease = here.value - there.value;
    damping *= 0.2;
    here = std::move(there);
    if (decrease <= kSettled * here.value) break;
  }
  return {{here.parameters.begin(), here.parameters.end()},
          {here.corrections.begin(), here.corrections.end()},
          corrected_targets(study, pulses, sought, view(here.corrections))};
}

}  // namespace crashsim
