/// The gradient of the heave-pitch objective against complex steps through an integrator of the test's own.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <ostream>

#include <gtest/gtest.h>

#include "optimize/pitch_objective.hpp"
#include "support/pitch_fit_cases.hpp"

namespace crashsim {
namespace {

using Complex = std::complex<double>;
using M = HeavePitchModel;

constexpr double kGradient = 1e-8;      // solver: of the largest scaled derivative
constexpr double kComplexStep = 1e-30;  // no rounding, no truncation
constexpr double kLongestStep = 2e-4;   // s: of the reference's Runge-Kutta steps
constexpr double kSmoothing = 1e-2;     // of a rung of the ladder

constexpr std::array kNumbers = {&M::mass_kg,
                                 &M::pitch_inertia_kgm2,
                                 &M::front_axle_m,
                                 &M::rear_axle_m,
                                 &M::front_stiffness_n_per_m,
                                 &M::rear_stiffness_n_per_m,
                                 &M::front_damping_ns_per_m,
                                 &M::rear_damping_ns_per_m,
                                 &M::force_arm_m,
                                 &M::cg_height_m,
                                 &M::force_height_m};
const std::vector<std::string> kNames = {
    "mass",          "pitch-inertia", "front-axle", "rear-axle", "front-stiffness", "rear-stiffness",
    "front-damping", "rear-damping",  "force-arm",  "cg-height", "force-height"};

using ComplexState = std::array<Complex, 4>;  // z, theta, z', theta'

/// Value at `t` of a series of which [from, to] holds no sample inside.
double on_line(const TimeSeries& series, double from, double to, double t, bool hold) {
  if (series.empty()) return 0.0;
  const auto next =
      static_cast<std::size_t>(std::ranges::upper_bound(series.time_s, 0.5 * (from + to)) - series.time_s.begin());
  if (next == 0) return hold ? series.values.front() : 0.0;
  if (next == series.time_s.size()) return hold ? series.values.back() : 0.0;
  const double share = (t - series.time_s[next - 1]) / (series.time_s[next] - series.time_s[next - 1]);
  return series.values[next - 1] + share * (series.values[next] - series.values[next - 1]);
}

/// The equations of the model as they are written down, in complex numbers.
struct Reference {
  const M& model;
  const PitchForcing& forcing;
  std::array<Complex, kNumbers.size()> p = {};

  [[nodiscard]] ComplexState rate(const ComplexState& y, double from, double to, double t) const {
    const auto [m, inertia, lf, lr, k1_given, k2_given, c1_given, c2_given, arm, h_cg, h_f] = p;
    const double wheels = model.per_wheel ? 2.0 : 1.0;
    const Complex k1 = wheels * k1_given, k2 = wheels * k2_given, c1 = wheels * c1_given, c2 = wheels * c2_given;
    const bool derived = model.formulation == PitchFormulation::derived;
    const double vertical = on_line(forcing.vertical_force_n, from, to, t, false);
    const double along = derived ? on_line(forcing.longitudinal_force_n, from, to, t, false) : 0.0;
    const Complex height = forcing.force_height_m.empty() ? h_f : on_line(forcing.force_height_m, from, to, t, true);
    const Complex q_z = -vertical, q_theta = vertical * (derived ? arm : 1.0) + along * (h_cg - height);
    const Complex spring_front = k1 * (y[0] - lf * y[1]), spring_rear = k2 * (y[0] + lr * y[1]);
    const Complex damper_front = c1 * (y[2] - lf * y[3]), damper_rear = c2 * (y[2] + lr * y[3]);
    const Complex heave_damping = derived ? damper_front + damper_rear : (c1 * lf + c2 * lr) * y[2] + (c1 + c2) * y[3];
    return {y[2], y[3], (q_z - spring_front - spring_rear - heave_damping) / m,
            (q_theta + lf * (spring_front + damper_front) - lr * (spring_rear + damper_rear)) / inertia};
  }

  void step(ComplexState& y, double from, double to) const {
    const auto parts = std::ceil((to - from) / kLongestStep);
    const double h = (to - from) / parts;
    const auto moved = [](const ComplexState& a, double by, const ComplexState& b) {
      ComplexState c;
      for (std::size_t i = 0; i < 4; ++i) c[i] = a[i] + by * b[i];
      return c;
    };
    for (double i = 0.0; i < parts; ++i) {
      const double t = from + i * h;
      const ComplexState a = rate(y, from, to, t);
      const ComplexState b = rate(moved(y, h / 2.0, a), from, to, t + h / 2.0);
      const ComplexState c = rate(moved(y, h / 2.0, b), from, to, t + h / 2.0);
      const ComplexState d = rate(moved(y, h, c), from, to, t + h);
      for (std::size_t j = 0; j < 4; ++j) y[j] += h / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
    }
  }
};

Complex penalty(Loss loss, Complex u, double smoothing) {
  constexpr double kThreshold = 0.05;
  const double size = std::fabs(u.real());
  if (loss == Loss::l2) return u * u;
  if (loss == Loss::huber && size <= kThreshold) return u * u / (2.0 * kThreshold);
  if (loss == Loss::l1 && smoothing > 0.0) return std::sqrt(u * u + smoothing * smoothing) - smoothing;
  return (u.real() < 0.0 ? -u : u) - (loss == Loss::huber ? kThreshold / 2.0 : 0.0);
}

/// E whose imaginary part over the step is the derivative by number `moved`.
Complex reference_error(const M& model, const PitchForcing& forcing, const PitchTarget& target, std::size_t moved,
                        Loss loss, double smoothing) {
  Reference reference{model, forcing};
  for (std::size_t i = 0; i < kNumbers.size(); ++i) reference.p[i] = model.*kNumbers[i];
  reference.p[moved] += Complex(0.0, kComplexStep);
  const std::array<const TimeSeries*, 4> channels = {&target.heave_m, &target.pitch_rad, &target.heave_velocity_mps,
                                                     &target.pitch_rate_radps};
  std::vector<double> stops{0.0};
  for (const TimeSeries* series : channels) stops.insert(stops.end(), series->time_s.begin(), series->time_s.end());
  const double end = *std::ranges::max_element(stops);
  for (const auto* series : {&forcing.vertical_force_n, &forcing.longitudinal_force_n, &forcing.force_height_m})
    for (const double t : series->time_s)
      if (t > 0.0 && t < end) stops.push_back(t);
  std::ranges::sort(stops);
  ComplexState y = {};
  Complex sum = 0.0;
  std::array<std::size_t, 4> next = {};
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (i > 0 && stops[i] > stops[i - 1]) reference.step(y, stops[i - 1], stops[i]);
    for (std::size_t c = 0; c < 4; ++c) {
      const TimeSeries& series = *channels[c];
      if (next[c] == series.time_s.size() || series.time_s[next[c]] != stops[i]) continue;
      double largest = 0.0;
      for (const double value : series.values) largest = std::max(largest, std::fabs(value));
      sum += penalty(loss, (y[c] - series.values[next[c]]) / largest, smoothing) /
             static_cast<double>(series.values.size());
      ++next[c];
    }
  }
  return sum;
}

struct Case {
  const char* name;
  Loss loss;
  double smoothing;
  PitchFormulation formulation;
  bool per_wheel, height_series;
  int samples;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class PitchGradient : public testing::TestWithParam<Case> {};

/// All eleven numbers at once, on forces and channels of uneven times of their own.
TEST_P(PitchGradient, OfRandomModelsIsThatOfComplexSteps) {
  const Case& how = GetParam();
  constexpr int kModels = 4;
  test::Random random(71);
  for (int i = 0; i < kModels; ++i) {
    M model = test::random_vehicle(random);
    model.formulation = how.formulation;
    model.per_wheel = how.per_wheel;
    const int knots = how.samples < 10 ? 3 : 9;
    PitchForcing forcing{test::random_series(random, -0.01, 0.1, knots, -1e4, 6e4),
                         test::random_series(random, 0.0, 0.12, knots, 0.0, 4e5),
                         {},
                         kUnset};
    if (how.height_series) forcing.force_height_m = test::random_series(random, 0.01, 0.09, knots, 0.3, 0.8);
    const PitchTarget target = {test::random_series(random, 0.0, 0.3, how.samples, -0.1, 0.1),
                                test::random_series(random, 0.0, 0.2, how.samples, -0.1, 0.1),
                                test::random_series(random, 0.0, 0.3, how.samples, -2.0, 2.0),
                                test::random_series(random, 0.05, 0.3, how.samples, -1.0, 1.0)};
    IdentifyPitchOptions options;
    options.free = kNames;
    std::vector<std::string> warnings;
    const auto parameters = pitch_parameters(model, options, warnings);
    const PitchFitTarget fit = make_pitch_target(model, forcing, target, test::to(0.4), options);
    const PitchObjective objective(model, forcing, fit, parameters, how.loss);
    std::vector<double> values, gradient(kNumbers.size());
    for (const auto member : kNumbers) values.push_back(model.*member);
    const double error = objective.evaluate(values, how.smoothing, gradient);
    std::array<double, kNumbers.size()> expected = {};
    double largest = 0.0;
    for (std::size_t p = 0; p < kNumbers.size(); ++p) {
      const Complex reference = reference_error(model, forcing, target, p, how.loss, how.smoothing);
      EXPECT_NEAR(error, reference.real(), kGradient * error);
      expected[p] = reference.imag() / kComplexStep;
      largest = std::max(largest, std::fabs(values[p] * expected[p]));
    }
    EXPECT_GT(largest, 0.0);
    for (std::size_t p = 0; p < kNumbers.size(); ++p)
      EXPECT_NEAR(values[p] * gradient[p], values[p] * expected[p], kGradient * largest)
          << "model " << i << ", " << kNames[p];
  }
}

constexpr auto kDerived = PitchFormulation::derived;
INSTANTIATE_TEST_SUITE_P(
    Cases, PitchGradient,
    testing::Values(Case{"l1_smoothed", Loss::l1, kSmoothing, kDerived, false, false, 40},
                    Case{"l1", Loss::l1, 0.0, kDerived, false, true, 40},
                    Case{"l2_per_wheel", Loss::l2, 0.0, kDerived, true, false, 40},
                    Case{"huber_height_over_time", Loss::huber, 0.0, kDerived, false, true, 40},
                    Case{"as_printed", Loss::l2, 0.0, PitchFormulation::as_printed, true, true, 40},
                    Case{"steps_longer_than_the_series_converges", Loss::l2, 0.0, kDerived, false, true, 3}),
    [](const auto& c) { return std::string(c.param.name); });

/// Steps from a small part of a period to several, under forces that are parabolas.
TEST(PitchEquation, StepsAreThoseOfTheExponential) {
  constexpr double kExact = 1e-12;  // rounding: relative, of both series and up to a hundred parts of a step
  test::Random random(72);
  const auto series = [&random](double size) {
    return ForceSeries{random.between(-size, size), random.between(-30.0 * size, 30.0 * size),
                       random.between(-900.0 * size, 900.0 * size)};
  };
  for (int i = 0; i < 200; ++i) {
    const M model = test::random_vehicle(random);
    const double step_s = std::pow(10.0, random.between(-4.0, -0.5));
    const ForceTerms terms{series(5e4), series(5e4), series(5e4), series(5e4), series(5e4)};
    PitchEquation::State state;
    PitchState start;
    for (std::size_t j = 0; j < 4; ++j)
      state.value[j] = start[static_cast<Eigen::Index>(j)] = random.between(-1.0, 1.0) * (j < 2 ? 0.1 : 1.0);
    PitchEquation(model, {}, step_s).advance(terms, step_s, state);
    ForcePiece piece;
    for (std::size_t n = 0; n < 3; ++n) {
      const double moment = terms.moment[n] + model.force_arm_m * terms.by_arm[n] +
                            model.cg_height_m * terms.by_cg_height[n] + model.force_height_m * terms.by_force_height[n];
      piece.col(static_cast<Eigen::Index>(n)) << terms.heave[n] / model.mass_kg, moment / model.pitch_inertia_kgm2;
    }
    piece.col(2) *= 2.0;
    const PitchState exact = Propagator(linear_system(model), 0.0).step(start, piece, step_s);
    for (std::size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(state.value[j], exact[static_cast<Eigen::Index>(j)], kExact * exact.cwiseAbs().maxCoeff())
          << "model " << i << ", " << step_s << " s";
  }
}

/// At the model that made the target all residuals vanish, and the squared loss's Hessian is 2 J'J.
TEST(PitchJacobian, IsTheHessianOfTheSquaredLossWithoutResiduals) {
  constexpr double kStep = 1e-4;         // of a number
  constexpr double kDifferences = 1e-6;  // central differences of the exact gradient: truncation of the order kStep^2
  const M model = test::vehicle_with_heights();
  const PitchForcing forcing = test::both_forces();
  IdentifyPitchOptions options;
  options.free = kNames;
  std::vector<std::string> warnings;
  const auto parameters = pitch_parameters(model, options, warnings);
  const PitchTarget target = test::target_of(simulate_pitch(model, forcing, test::to(0.5)));
  const PitchFitTarget fit = make_pitch_target(model, forcing, target, test::to(0.5), options);
  const PitchObjective objective(model, forcing, fit, parameters, Loss::l2);
  std::vector<double> values, before(kNumbers.size()), after(kNumbers.size());
  for (const auto member : kNumbers) values.push_back(model.*member);
  const Eigen::MatrixXd jacobian = objective.jacobian(values);
  EXPECT_EQ(jacobian.rows(), 4 * 501);
  const Eigen::MatrixXd hessian = 2.0 * jacobian.transpose() * jacobian;
  for (std::size_t p = 0; p < values.size(); ++p) {
    std::vector<double> moved = values;
    moved[p] = values[p] * (1.0 + kStep);
    objective.evaluate(moved, 0.0, after);
    moved[p] = values[p] * (1.0 - kStep);
    objective.evaluate(moved, 0.0, before);
    for (std::size_t q = 0; q < values.size(); ++q) {
      const auto i = static_cast<Eigen::Index>(p), j = static_cast<Eigen::Index>(q);
      const double size = std::sqrt(hessian(i, i) * hessian(j, j));
      EXPECT_GT(size, 0.0);
      EXPECT_NEAR((after[q] - before[q]) / (2.0 * kStep * values[p]), hessian(i, j), kDifferences * size)
          << kNames[p] << ", " << kNames[q];
    }
  }
}

}  // namespace
}  // namespace crashsim
