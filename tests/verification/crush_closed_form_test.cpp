/// Phase I against closed forms: Kelvin, bilinear force, a damper alone, a spring alone.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crashsim/simulate.hpp>

#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

constexpr double kRtol = 1e-10;
constexpr double kSolver = 2e-9;       // solver: relative, 20 kRtol
constexpr double kRounding = 1e-13;    // rounding: relative, of the closed forms themselves
constexpr double kPublished = 0.5e-3;  // published crush is given in whole millimetres [m]

/// Half a unit of the last decimal a number is given with.
double half_digit(int decimals) { return 0.5 * std::pow(10.0, -decimals); }

class CrushClosedForm : public testing::TestWithParam<Integrator> {
 protected:
  [[nodiscard]] static SimulateOptions options() {
    SimulateOptions options;
    options.integrator = GetParam();
    options.rtol = kRtol;
    return options;
  }
  static void expect_max_crush(const CrushResponse& r, double t_m, double crush) {
    ASSERT_TRUE(r.usable()) << r.message;
    EXPECT_NEAR(r.t_m_s, t_m, kSolver * t_m);
    EXPECT_NEAR(r.max_crush_m, crush, kSolver * crush);
  }
};

std::string name_of_parameter(const testing::TestParamInfo<Integrator>& info) {
  return std::string(name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Both, CrushClosedForm, testing::ValuesIn(test::kBothIntegrators), name_of_parameter);

/// Motion of the Kelvin model, zeta <= 1.
struct Kelvin {
  double m, k, c, v0;

  [[nodiscard]] double frequency() const { return std::sqrt(k / m); }
  [[nodiscard]] double zeta() const { return c / (2.0 * std::sqrt(k * m)); }
  [[nodiscard]] double root() const { return std::sqrt(std::max(0.0, 1.0 - zeta() * zeta())); }
  [[nodiscard]] double t_m() const {
    return root() > 0.0 ? std::atan2(root(), zeta()) / (frequency() * root()) : 1.0 / frequency();
  }
  [[nodiscard]] double crush() const { return v0 / frequency() * std::exp(-zeta() * frequency() * t_m()); }
  /// a = 0 at twice the phase angle of v = 0.
  [[nodiscard]] double separation() const { return 2.0 * t_m(); }
  [[nodiscard]] double x(double t) const {
    const double wd = frequency() * root();
    return v0 * std::exp(-zeta() * frequency() * t) * (wd > 0.0 ? std::sin(wd * t) / wd : t);
  }
  [[nodiscard]] double v(double t) const {
    const double w = frequency(), wd = w * root();
    const double decay = v0 * std::exp(-zeta() * w * t);
    return wd > 0.0 ? decay * (std::cos(wd * t) - zeta() * w / wd * std::sin(wd * t)) : decay * (1.0 - w * t);
  }
};

struct KelvinOracle {
  Kelvin model;
  double t_m, crush;
};
/// oracles: kelvin_closed_form
constexpr KelvinOracle kKelvinOracles[] = {
    {{873.0, 98400.0, 3300.0, 35.0 / 3.6}, 0.13322490313146795, 0.7119015193424795},
    {{2582.0, 1.2e6, 20000.0, 56.0 / 3.6}, 0.06555072271329093, 0.5597784535789062},
    {{1000.0, 4.0e5, 40000.0, 15.0}, 0.05, 0.2759095808785818},  // zeta = 1
};

TEST(Kelvin, ClosedFormIsTheOracles) {
  for (const KelvinOracle& oracle : kKelvinOracles) {
    EXPECT_NEAR(oracle.model.t_m(), oracle.t_m, kRounding * oracle.t_m);
    EXPECT_NEAR(oracle.model.crush(), oracle.crush, kRounding * oracle.crush);
  }
  EXPECT_EQ(kKelvinOracles[2].model.zeta(), 1.0);
}

TEST_P(CrushClosedForm, KelvinToMaximumCrushAndBack) {
  for (const auto& [kelvin, t_m, crush] : kKelvinOracles) {
    CrushModel model = test::kelvin_model(kelvin.m, kelvin.k, kelvin.c, kelvin.v0);
    model.unloading.bilateral = true;
    SimulateOptions options = CrushClosedForm::options();
    options.end_time_s = 0.5;  // more than a period of each
    const CrushResponse r = simulate(model, options);
    expect_max_crush(r, t_m, crush);
    EXPECT_TRUE(std::isnan(r.separation_s));
    for (std::size_t i = 0; i < r.time_s.size(); i += 50) {
      const double x = kelvin.x(r.time_s[i]), v = kelvin.v(r.time_s[i]);
      EXPECT_NEAR(r.displacement_m[i], x, kSolver * crush);
      EXPECT_NEAR(r.velocity_mps[i], v, kSolver * kelvin.v0);
      const double scale = kelvin.c * kelvin.v0 + kelvin.k * crush;
      EXPECT_NEAR(r.spring_force_n[i], kelvin.k * x, kSolver * scale);
      EXPECT_NEAR(r.damper_force_n[i], kelvin.c * v, kSolver * scale);
      EXPECT_NEAR(kelvin.m * r.accel_mps2[i], -kelvin.k * x - kelvin.c * v, kSolver * scale);
    }
  }
}

TEST_P(CrushClosedForm, KelvinLosesContactWhenTheForceVanishes) {
  for (const auto& [kelvin, t_m, crush] : kKelvinOracles) {
    if (kelvin.zeta() >= 1.0) continue;
    SimulateOptions options = CrushClosedForm::options();
    options.end_time_s = 0.5;
    const CrushResponse r = simulate(test::kelvin_model(kelvin.m, kelvin.k, kelvin.c, kelvin.v0), options);
    expect_max_crush(r, t_m, crush);
    const double t_s = kelvin.separation();
    EXPECT_NEAR(r.separation_s, t_s, kSolver * t_s);
    EXPECT_NEAR(r.static_crush_m, kelvin.x(t_s), kSolver * crush);
    EXPECT_NEAR(r.rebound_velocity_mps, kelvin.v(t_s), kSolver * kelvin.v0);
    EXPECT_EQ(r.velocity_mps.back(), r.rebound_velocity_mps);
    EXPECT_EQ(r.accel_mps2.back(), 0.0);
    EXPECT_NEAR(r.displacement_m.back(), kelvin.x(t_s) + kelvin.v(t_s) * (options.end_time_s - t_s), kSolver * crush);
  }
}

/// Oracle case of a bilinear force: KW400 stiffness, A/B of the CRASH3 class, 35 mph.
struct Bilinear {
  const char* name;
  double mass_kg, kw400_n_per_m, a_over_b_m;
  double stiffness, yield;  // N/m, N
  double crush, t_m, peak;  // m, s, N, to 6, 6 and 1 decimals
  double published_crush_m;
};
constexpr double k35mph = 15.6464;  // m/s
/// oracles: bilinear_KW400
constexpr Bilinear kBilinear[] = {
    {"1996 Dodge Neon", 1354.0, 1251000.0, 0.0683378, 946587.1, 64687.7, 0.527352, 0.055060, 563872.4, 0.527},
    {"2007 Silverado", 2622.0, 2550000.0, 0.073686, 1893436.4, 139519.8, 0.513203, 0.053769, 1111236.4, 0.513},
};

TEST(Bilinear, StiffnessHasTheWorkOfKW400) {
  constexpr double kFrom = 0.025, kTo = 0.4;  // m
  constexpr double kGivenRatio = 0.5e-6;      // relative: A/B is given to 1e-7 m
  for (const Bilinear& b : kBilinear) {
    // F = k (A/B + x), and KW400 (kTo^2 - kFrom^2)/2 its work over 25..400 mm.
    const double k = b.kw400_n_per_m / (1.0 + 2.0 * b.a_over_b_m / (kTo + kFrom));
    EXPECT_NEAR(k, b.stiffness, kGivenRatio * k) << b.name;
    EXPECT_NEAR(k * b.a_over_b_m, b.yield, kGivenRatio * b.yield) << b.name;
  }
}

CrushModel bilinear_model(const Bilinear& b) {
  constexpr double kLastKnot = 0.4;  // m; the line goes on beyond it
  CrushModel model;
  model.mass_kg = b.mass_kg;
  model.impact_speed_mps = k35mph;
  model.law = CrushLaw::force;
  model.extrapolation = Extrapolation::linear;
  model.spring = {{0.0, kLastKnot}, {b.yield, b.yield + kLastKnot * b.stiffness}};
  return model;
}

TEST_P(CrushClosedForm, BilinearForceGivesThePublishedCrush) {
  for (const Bilinear& b : kBilinear) {
    SCOPED_TRACE(b.name);
    const double k = b.stiffness, w = std::sqrt(k / b.mass_kg);
    const double crush = (-b.yield + std::sqrt(b.yield * b.yield + k * b.mass_kg * k35mph * k35mph)) / k;
    const double peak = b.yield + k * crush;
    SimulateOptions options = CrushClosedForm::options();
    options.to_max_crush = true;
    const CrushResponse r = simulate(bilinear_model(b), options);
    expect_max_crush(r, std::atan(k35mph * k / (w * b.yield)) / w, crush);
    EXPECT_NEAR(r.spring_force_n.back(), peak, kSolver * peak);
    EXPECT_NEAR(r.max_crush_m, b.crush, half_digit(6));
    EXPECT_NEAR(r.t_m_s, b.t_m, half_digit(6));
    EXPECT_NEAR(r.spring_force_n.back(), b.peak, half_digit(1));
    EXPECT_NEAR(r.max_crush_m, b.published_crush_m, kPublished);
  }
}

TEST_P(CrushClosedForm, BilinearForceGivesItsEnergyBack) {
  for (const Bilinear& b : kBilinear) {
    const CrushResponse r = simulate(bilinear_model(b), options());
    EXPECT_NEAR(r.rebound_velocity_mps, -k35mph, kSolver * k35mph) << b.name;
    EXPECT_NEAR(r.separation_s, 2.0 * r.t_m_s, kSolver * r.separation_s);
    EXPECT_NEAR(r.static_crush_m, 0.0, kSolver * r.max_crush_m);
  }
}

/// Time and crush at which a damper alone has slowed the vehicle to each of its knots, from the last knot on:
///     t = m int dv / (c(v) v),   x = m int dv / c(v),   c = a + b v in a segment
struct Slowing {
  std::vector<double> time_s, velocity_mps, displacement_m;
};
Slowing slowed_by_damper(double mass, const PiecewiseLinear& damper) {
  Slowing s;
  double t = 0.0, x = 0.0;
  for (std::size_t i = damper.knots.size() - 1; i > 1; --i) {
    const double v1 = damper.knots[i], v2 = damper.knots[i - 1];
    const double c1 = damper.ordinates[i], c2 = damper.ordinates[i - 1];
    const double b = (c1 - c2) / (v1 - v2), a = c1 - b * v1;
    t += mass / a * std::log(v1 * c2 / (v2 * c1));
    x += b != 0.0 ? mass / b * std::log(c1 / c2) : mass * (v1 - v2) / a;
    s.time_s.push_back(t);
    s.velocity_mps.push_back(v2);
    s.displacement_m.push_back(x);
  }
  return s;
}

TEST_P(CrushClosedForm, DamperAloneSlowsByLogarithms) {
  test::Random random(1);
  for (int i = 0; i < 50; ++i) {
    CrushModel model;
    model.mass_kg = random.between(700.0, 4000.0);
    model.impact_speed_mps = random.between(3.0, 25.0);
    model.damper = test::random_curve(random, model.impact_speed_mps, 20.0 * model.mass_kg);
    for (double& c : model.damper.ordinates) c += 0.5 * model.mass_kg;  // none is zero
    const Slowing closed = slowed_by_damper(model.mass_kg, model.damper);
    if (closed.time_s.empty()) continue;  // two knots: 0 is never reached
    SimulateOptions options = CrushClosedForm::options();
    options.times_s = closed.time_s;
    const CrushResponse r = simulate(model, options);
    EXPECT_EQ(r.outcome, CrushOutcome::no_max_crush);
    ASSERT_EQ(r.velocity_mps.size(), closed.velocity_mps.size());
    for (std::size_t j = 0; j < closed.time_s.size(); ++j) {
      EXPECT_NEAR(r.velocity_mps[j], closed.velocity_mps[j], kSolver * model.impact_speed_mps) << "model " << i;
      EXPECT_NEAR(r.displacement_m[j], closed.displacement_m[j], kSolver * closed.displacement_m.back());
    }
  }
}

/// Crush that takes the energy: int_0^C k(x) x dx = energy, a cubic per segment; k held beyond the last knot.
double crush_of_energy(const PiecewiseLinear& spring, double energy) {
  for (std::size_t i = 0;; ++i) {
    const bool last = i + 1 == spring.knots.size();
    const double from = spring.knots[i], k = spring.ordinates[i];
    const double slope = last ? 0.0 : (spring.ordinates[i + 1] - k) / (spring.knots[i + 1] - from);
    const auto work = [&](double x) {  // from the segment's start
      return (k - slope * from) * (x * x - from * from) / 2.0 + slope * (x * x * x - from * from * from) / 3.0;
    };
    double low = from, high = last ? from + std::sqrt(2.0 * energy / k) : spring.knots[i + 1];
    if (!last && work(high) < energy) {
      energy -= work(high);
      continue;
    }
    for (int n = 0; n < 200; ++n) (work(0.5 * (low + high)) < energy ? low : high) = 0.5 * (low + high);
    return low;
  }
}

TEST_P(CrushClosedForm, SpringAloneTakesTheEnergy) {
  constexpr double kEnergyRoot = 0.7887160146336692;  // oracles: paper_form_SYN_B, C_energy_root
  std::vector<CrushModel> models = {test::syn_b()};
  EXPECT_NEAR(crush_of_energy(models[0].spring, 0.5 * models[0].mass_kg * std::pow(models[0].impact_speed_mps, 2)),
              kEnergyRoot, kRounding);
  test::Random random(2);
  while (models.size() < 100) {
    CrushModel model;
    model.mass_kg = random.between(700.0, 4000.0);
    model.impact_speed_mps = random.between(3.0, 25.0);
    model.spring = test::random_curve(random, 0.03 * model.impact_speed_mps, 900.0 * model.mass_kg);
    model.spring.ordinates.back() += 100.0 * model.mass_kg;
    models.push_back(model);
  }
  SimulateOptions options = CrushClosedForm::options();
  options.end_time_s = 1.0;
  for (const CrushModel& model : models) {
    const CrushResponse r = simulate(model, options);
    ASSERT_TRUE(r.usable()) << r.message;
    const double energy = 0.5 * model.mass_kg * model.impact_speed_mps * model.impact_speed_mps;
    const double crush = crush_of_energy(model.spring, energy);
    EXPECT_NEAR(r.max_crush_m, crush, kSolver * crush);
    EXPECT_NEAR(r.rebound_velocity_mps, -model.impact_speed_mps, kSolver * model.impact_speed_mps);
  }
}

}  // namespace
}  // namespace crashsim
