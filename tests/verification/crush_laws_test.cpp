/// Laws `crush_damping` and `rate` against closed forms, quadratures and the reference integration of
/// support/crush_reference.hpp.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/simulate.hpp>

#include "support/crush_cases.hpp"
#include "support/crush_reference.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kModels = 50;  // a sanitizer looks at the paths, not at the statistics
#else
constexpr int kModels = 500;
#endif

constexpr double kRtol = 1e-10;
constexpr double kSolver = 2e-9;      // solver: relative, 20 kRtol
constexpr double kRecord = 1e-7;      // solver: CVODE at kRtol over random models
constexpr double kKernel = 1e-9;      // solver: Taylor kernel at kRtol over random models
constexpr double kLedger = 1e-8;      // solver: energy relative to the impact's
constexpr double kQuadrature = 1e-8;  // solver: with the quadrature's own error
constexpr double kRounding = 1e-14;   // rounding: relative, of a few operations

class CrushLaws : public testing::TestWithParam<Integrator> {
 protected:
  [[nodiscard]] static SimulateOptions options(std::vector<double> times = {}) {
    SimulateOptions options;
    options.integrator = GetParam();
    options.rtol = kRtol;
    options.times_s = std::move(times);
    return options;
  }
};

std::string name_of_parameter(const testing::TestParamInfo<Integrator>& info) {
  return std::string(name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Both, CrushLaws, testing::ValuesIn(test::kBothIntegrators), name_of_parameter);

CrushModel model_of(CrushLaw law, PiecewiseLinear spring, PiecewiseLinear damper = {}) {
  CrushModel model;
  model.mass_kg = 1500.0;
  model.impact_speed_mps = 15.0;
  model.law = law;
  model.spring = std::move(spring);
  model.damper = std::move(damper);
  return model;
}

CrushModel rate_model(PiecewiseLinear spring, double coefficient, double reference_speed_mps) {
  CrushModel model = model_of(CrushLaw::rate, std::move(spring));
  model.rate_coefficient = coefficient;
  model.reference_speed_mps = reference_speed_mps;
  return model;
}

double impact_energy(const CrushModel& model) {
  return 0.5 * model.mass_kg * model.impact_speed_mps * model.impact_speed_mps;
}

/// Rates, forces and energies of a response fit together.
void expect_consistent(const CrushResponse& r, const CrushModel& model) {
  const double energy = impact_energy(model);
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    const double force = r.spring_force_n[i] + r.damper_force_n[i];
    EXPECT_NEAR(model.mass_kg * r.accel_mps2[i], -force, kRounding * std::abs(force));
    EXPECT_NEAR(r.energy_residual_j[i], 0.0, kLedger * energy);
  }
  EXPECT_NEAR(r.kinetic_energy_j + r.spring_energy_j + r.dissipated_energy_j, energy, kLedger * energy);
}

// Crush damping -------------------------------------------------------------------------------------------------------

TEST_P(CrushLaws, ConstantForceAndCrushDampingIsALinearEquation) {
  constexpr double kForce = 2e5, kDamping = 9e3;
  const CrushModel model = model_of(CrushLaw::crush_damping, {{0.0}, {kForce}}, {{0.0}, {kDamping}});
  const double m = model.mass_kg, v0 = model.impact_speed_mps, limit = kForce / kDamping;
  const double t_m = m / kDamping * std::log1p(v0 / limit);
  const auto decay = [&](double t) { return std::exp(-kDamping * t / m); };
  const auto x = [&](double t) { return (v0 + limit) * m / kDamping * (1.0 - decay(t)) - limit * t; };
  const CrushResponse r = simulate(model, options());
  ASSERT_TRUE(r.usable()) << r.message;
  EXPECT_NEAR(r.t_m_s, t_m, kSolver * t_m);
  EXPECT_NEAR(r.max_crush_m, x(t_m), kSolver * x(t_m));
  for (std::size_t i = 0; r.time_s[i] < t_m; ++i) {
    const double v = (v0 + limit) * decay(r.time_s[i]) - limit;
    EXPECT_NEAR(r.displacement_m[i], x(r.time_s[i]), kSolver * x(t_m));
    EXPECT_NEAR(r.velocity_mps[i], v, kSolver * v0);
    EXPECT_NEAR(r.spring_force_n[i], kForce, kRounding * kForce);
    EXPECT_NEAR(r.damper_force_n[i], kDamping * v, kSolver * kDamping * v0);
  }
  expect_consistent(r, model);
}

TEST_P(CrushLaws, KelvinHoldsWithCrushDampingOfConstantCurves) {
  // oracles: kelvin_closed_form
  constexpr double kMass = 2582.0, kStiffness = 1.2e6, kDamping = 20000.0, kSpeed = 56.0 / 3.6;
  constexpr double kTime = 0.06555072271329093, kCrush = 0.5597784535789062;
  for (const bool several_knots : {false, true}) {
    CrushModel model = model_of(CrushLaw::crush_damping, {{0.0, 0.5}, {0.0, 0.5 * kStiffness}}, {{0.0}, {kDamping}});
    if (several_knots) model.damper = {{0.0, 0.1, 0.2, 0.5}, std::vector<double>(4, kDamping)};
    model.mass_kg = kMass;
    model.impact_speed_mps = kSpeed;
    model.extrapolation = Extrapolation::linear;
    const CrushResponse r = simulate(model, options());
    ASSERT_TRUE(r.usable()) << r.message;
    EXPECT_NEAR(r.t_m_s, kTime, kSolver * kTime);
    EXPECT_NEAR(r.max_crush_m, kCrush, kSolver * kCrush);
    EXPECT_NEAR(r.separation_s, 2.0 * kTime, 2.0 * kSolver * kTime);
    const CrushResponse kelvin = simulate(test::kelvin_model(kMass, kStiffness, kDamping, kSpeed), options());
    EXPECT_NEAR(r.rebound_velocity_mps, kelvin.rebound_velocity_mps, kSolver * kSpeed);
    EXPECT_NEAR(r.static_crush_m, kelvin.static_crush_m, kSolver * kCrush);
    expect_consistent(r, model);
  }
}

TEST_P(CrushLaws, ADamperAloneOverCrushTakesItsAreaFromTheVelocity) {
  // m dv/dx = -c(x): v = v0 - integral of c / m, whatever the time it takes.
  const CrushModel model = model_of(CrushLaw::crush_damping, {}, {{0.0, 0.2, 0.5, 0.8}, {2e4, 5e4, 1e4, 3e4}});
  SimulateOptions until = options();
  until.end_time_s = 0.1;
  const CrushResponse r = simulate(model, until);
  EXPECT_EQ(r.outcome, CrushOutcome::no_max_crush) << "v only ever approaches zero";
  const auto& [knots, c] = model.damper;
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    const double x = r.displacement_m[i];
    double area = 0.0;
    for (std::size_t j = 0; j + 1 < knots.size() && knots[j] < x; ++j) {
      const double width = std::min(x, knots[j + 1]) - knots[j];
      const double slope = (c[j + 1] - c[j]) / (knots[j + 1] - knots[j]);
      area += width * (c[j] + 0.5 * slope * width);
    }
    EXPECT_NEAR(r.velocity_mps[i], model.impact_speed_mps - area / model.mass_kg, kSolver * model.impact_speed_mps);
    EXPECT_EQ(r.spring_force_n[i], 0.0);
  }
  expect_consistent(r, model);
}

TEST_P(CrushLaws, WithoutADamperCrushDampingIsTheLawForce) {
  const PiecewiseLinear spring = {{0.0, 0.2, 0.4, 0.7}, {1e5, 3e5, 2e5, 4e5}};
  const CrushResponse force = simulate(model_of(CrushLaw::force, spring), options());
  EXPECT_EQ(simulate(model_of(CrushLaw::crush_damping, spring), options()).displacement_m, force.displacement_m);
  EXPECT_EQ(simulate(rate_model(spring, 0.0, 1.0), options()).displacement_m, force.displacement_m);
}

TEST_P(CrushLaws, CrushDampingPullsBackUntilTheSpringIsNoLongerStronger) {
  const CrushModel model =
      model_of(CrushLaw::crush_damping, {{0.0, 0.5}, {0.0, 4e5}}, {{0.0, 0.1, 0.3, 0.6}, {2e4, 1e4, 3e4, 8e4}});
  const CrushResponse r = simulate(model, options());
  ASSERT_TRUE(r.usable()) << r.message;
  ASSERT_FALSE(std::isnan(r.separation_s));
  EXPECT_GT(r.static_crush_m, 0.0);
  const double spring = spring_force(model, r.static_crush_m);
  EXPECT_NEAR(damper_force(model, r.static_crush_m, r.rebound_velocity_mps), -spring, kLedger * spring);
}

/// Ends where x leaves the knots of either curve.
TEST_P(CrushLaws, ExtrapolationErrorMindsTheKnotsOfBothCurves) {
  for (const double damper_end : {0.25, 0.9})
    for (const double spring_end : {0.3, 0.8}) {
      CrushModel model =
          model_of(CrushLaw::crush_damping, {{0.0, 0.1, spring_end}, {5e4, 1e5, 1e5}}, {{0.0, damper_end}, {1e3, 2e3}});
      model.extrapolation = Extrapolation::error;
      const CrushResponse r = simulate(model, options());
      EXPECT_EQ(r.outcome, CrushOutcome::left_knot_range);
      const double end = std::min(damper_end, spring_end);
      EXPECT_NEAR(r.displacement_m.back(), end, kSolver);
      EXPECT_THAT(r.message, HasSubstr("the motion left the knots"));
    }
  CrushModel model = rate_model({{0.0, 0.3}, {5e4, 1e5}}, 0.1, 1.0);
  model.extrapolation = Extrapolation::error;
  EXPECT_EQ(simulate(model, options()).outcome, CrushOutcome::left_knot_range);
}

// Rate ----------------------------------------------------------------------------------------------------------------

/// Integral of e^(p u) / (1 + r u) over 0..end by Gauss' formula of three points on many intervals.
double rate_integral(double p, double r, double end) {
  constexpr int kIntervals = 2000;
  const double width = end / kIntervals, node = std::sqrt(0.6);
  const auto f = [&](double u) { return std::exp(p * u) / (1.0 + r * u); };
  double sum = 0.0;
  for (int i = 0; i < kIntervals; ++i) {
    const double middle = (i + 0.5) * width;
    sum += (5.0 * (f(middle - 0.5 * node * width) + f(middle + 0.5 * node * width)) + 8.0 * f(middle)) / 18.0 * width;
  }
  return sum;
}

TEST_P(CrushLaws, AConstantForceWithRateIsAQuadratureOverVelocity) {
  // v' = -(f/m) (1 + r ln(1 + v/v_ref)): with u = ln(1 + v/v_ref), t_m = (m v_ref/f) integral of e^u / (1 + r u) du.
  constexpr double kForce = 2.5e5;
  for (const double v_ref : {1e-6, 1e-3, 0.1, 5.0, 100.0})
    for (const double r : {0.02, 0.2, 1.0}) {
      SCOPED_TRACE("v_ref = " + std::to_string(v_ref) + ", r = " + std::to_string(r));
      const CrushModel model = rate_model({{0.0}, {kForce}}, r, v_ref);
      const double end = std::log1p(model.impact_speed_mps / v_ref), scale = model.mass_kg * v_ref / kForce;
      const double t_m = scale * rate_integral(1.0, r, end);
      const double crush = scale * v_ref * (rate_integral(2.0, r, end) - rate_integral(1.0, r, end));
      const CrushResponse response = simulate(model, options());
      ASSERT_TRUE(response.usable()) << response.message;
      EXPECT_NEAR(response.t_m_s, t_m, kQuadrature * t_m);
      EXPECT_NEAR(response.max_crush_m, crush, kQuadrature * crush);
      expect_consistent(response, model);
    }
}

TEST_P(CrushLaws, TheRateGivesBackInReboundWhatItTook) {
  // The printed law has |v|: the way back is the way in, mirrored in time.
  CrushModel model = rate_model({{0.0, 0.2, 0.4}, {0.0, 3e5, 2e5}}, 0.15, 0.5);
  const CrushResponse r = simulate(model, options());
  ASSERT_TRUE(r.usable()) << r.message;
  EXPECT_NEAR(r.rebound_velocity_mps, -model.impact_speed_mps, kSolver * model.impact_speed_mps);
  EXPECT_NEAR(r.separation_s, 2.0 * r.t_m_s, 2.0 * kSolver * r.t_m_s);
  EXPECT_NEAR(r.dissipated_energy_j, 0.0, kLedger * impact_energy(model));
  SimulateOptions to_max_crush = options();
  to_max_crush.to_max_crush = true;
  const CrushResponse in = simulate(model, to_max_crush);
  EXPECT_NEAR(in.dissipated_energy_j, impact_energy(model) - spring_energy(model, in.max_crush_m),
              kLedger * impact_energy(model));
  EXPECT_GT(in.dissipated_energy_j, 0.2 * impact_energy(model));
}

// Both, and the integrators, over random models -----------------------------------------------------------------------

/// Largest difference relative to the largest value of `b`.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    largest = std::max(largest, std::abs(b[i]));
    worst = std::max(worst, std::abs(a.at(i) - b[i]));
  }
  return largest > 0.0 ? worst / largest : worst;
}

/// Relative difference of two times, 0 when neither exists.
double difference(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return 0.0;
  return a == b ? 0.0 : std::isnan(a) || std::isnan(b) ? HUGE_VAL : std::abs(a - b) / std::abs(b);
}

double worst_difference(const CrushResponse& a, const test::CrushReference& b) {
  return std::max({difference(a.displacement_m, b.displacement_m), difference(a.velocity_mps, b.velocity_mps),
                   difference(a.accel_mps2, b.accel_mps2), difference(a.spring_force_n, b.spring_force_n),
                   difference(a.damper_force_n, b.damper_force_n), difference(a.t_m_s, b.t_m_s),
                   difference(a.max_crush_m, b.max_crush_m), difference(a.separation_s, b.separation_s)});
}

std::vector<double> sample_times(const CrushModel& model) {
  const double end = model.unloading.bilateral ? 0.1 : 0.25;
  std::vector<double> times;
  for (int i = 0; i <= 100; ++i) times.push_back(end * i / 100.0);
  return times;
}

class RandomLaws : public testing::TestWithParam<CrushLaw> {};
INSTANTIATE_TEST_SUITE_P(Each, RandomLaws, testing::Values(CrushLaw::crush_damping, CrushLaw::rate),
                         [](const auto& law) { return std::string(name_of(law.param)); });

TEST_P(RandomLaws, AgreeWithTheReference) {
  test::Random random(51);
  int completed = 0, separated = 0;
  for (int i = 0; i < kModels; ++i) {
    const CrushModel model = test::random_model_of(GetParam(), random);
    const std::vector<double> times = sample_times(model);
    const test::CrushReference reference = test::reference_motion(model, model.impact_speed_mps, times);
    for (const Integrator integrator : test::kBothIntegrators) {
      SimulateOptions options;
      options.integrator = integrator;
      options.rtol = kRtol;
      options.times_s = times;
      const CrushResponse r = simulate(model, options);
      EXPECT_LT(worst_difference(r, reference), integrator == Integrator::cvode ? kRecord : kKernel)
          << name_of(integrator) << ", model " << i;
      for (const double residual : r.energy_residual_j) ASSERT_NEAR(residual, 0.0, kLedger * impact_energy(model));
      completed += r.usable() ? 1 : 0;
      separated += std::isnan(r.separation_s) ? 0 : 1;
    }
  }
  EXPECT_GT(completed, kModels);      // of twice as many runs, most stop,
  EXPECT_GT(separated, kModels / 2);  // and many rebound freely
}

TEST_P(RandomLaws, UnloadPlasticallyAsTheReference) {
  constexpr double kNearLimit = 1e-3;  // relative: what is nearer to the limit may fall on either side of it
  test::Random random(52);
  int compared = 0;
  for (int i = 0; i < kModels / 2; ++i) {
    CrushModel model = test::random_model_of(GetParam(), random);
    test::make_plastic(model, random);
    const std::vector<double> times = sample_times(model);
    const test::CrushReference reference = test::reference_motion(model, model.impact_speed_mps, times);
    if (std::isnan(reference.return_end_m)) continue;
    SimulateOptions options;
    options.integrator = Integrator::taylor;
    options.rtol = kRtol;
    options.times_s = times;
    const CrushResponse r = simulate(model, options);
    const double margin = std::min(reference.return_end_m / reference.max_crush_m,
                                   1.0 - reference.return_speed_mps / model.impact_speed_mps);
    if (margin < kNearLimit) continue;
    EXPECT_LT(worst_difference(r, reference), kKernel) << "model " << i;
    for (const double residual : r.energy_residual_j) ASSERT_NEAR(residual, 0.0, kLedger * impact_energy(model));
    ++compared;
  }
  EXPECT_GT(compared, kModels / 8);
}

}  // namespace
}  // namespace crashsim
