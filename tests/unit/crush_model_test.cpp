#include <crashsim/crush_model.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;  // rounding: relative, of sums over 20 segments

/// SYN_A changed by `spoil` is refused with this message.
void expect_refused(const std::function<void(CrushModel&)>& spoil, const std::string& message) {
  CrushModel model = test::syn_a();
  spoil(model);
  EXPECT_THAT([&] { validate(model); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
  EXPECT_THAT([&] { simulate(model); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
}

TEST(CrushModel, RefusesABadMassOrSpeed) {
  expect_refused([](CrushModel& m) { m.mass_kg = -3.0; }, "CrushModel.mass_kg = -3 kg: must be > 0");
  expect_refused([](CrushModel& m) { m.mass_kg = 0.0; }, "CrushModel.mass_kg = 0 kg: must be > 0");
  expect_refused([](CrushModel& m) { m.mass_kg = kUnset; }, "CrushModel.mass_kg = nan kg: must be > 0");
  expect_refused([](CrushModel& m) { m.mass_kg = std::numeric_limits<double>::infinity(); },
                 "CrushModel.mass_kg = inf kg: must be > 0");
  expect_refused([](CrushModel& m) { m.impact_speed_mps = -1.0; }, "CrushModel.impact_speed_mps = -1 m/s: must be > 0");
}

TEST(CrushModel, RefusesBadCurves) {
  expect_refused([](CrushModel& m) { m.spring.knots[3] = 0.2; },
                 "CrushModel.spring.knots[3] = 0.2: must be greater than the knot before it, 0.2");
  expect_refused([](CrushModel& m) { m.damper.knots[2] = 1.0; },
                 "CrushModel.damper.knots[2] = 1: must be greater than the knot before it, 3");
  expect_refused([](CrushModel& m) { m.spring.knots[0] = 0.05; },
                 "CrushModel.spring.knots[0] = 0.05: the first knot must be 0");
  expect_refused([](CrushModel& m) { m.damper.ordinates[6] = -1.0; },
                 "CrushModel.damper.ordinates[6] = -1: must be >= 0");
  expect_refused([](CrushModel& m) { m.spring.ordinates[1] = kUnset; },
                 "CrushModel.spring.ordinates[1] = nan: must be finite");
  expect_refused([](CrushModel& m) { m.damper.knots[6] = kUnset; }, "CrushModel.damper.knots[6] = nan: must be finite");
  expect_refused([](CrushModel& m) { m.spring.ordinates.pop_back(); },
                 "CrushModel.spring: 7 knots but 6 ordinates: the numbers must be equal");
  expect_refused([](CrushModel& m) { m.damper.knots.clear(); }, "CrushModel.damper: has no knots");
}

TEST(CrushModel, RefusesBadUnloading) {
  const auto plastic = [](double stiffness, double restitution) {
    return [=](CrushModel& m) { m.unloading = {UnloadingKind::plastic, false, stiffness, restitution}; };
  };
  expect_refused(
      plastic(kUnset, kUnset),
      "CrushModel.unloading: kind plastic has neither unloading_stiffness_n_per_m nor restitution: give one");
  expect_refused(plastic(1e7, 0.1),
                 "CrushModel.unloading: kind plastic has both unloading_stiffness_n_per_m and restitution: give one");
  for (const double stiffness : {0.0, -3.0})
    expect_refused(plastic(stiffness, kUnset),
                   fmt::format("CrushModel.unloading.unloading_stiffness_n_per_m = {} N/m: must be > 0", stiffness));
  for (const double restitution : {-0.1, 1.5})
    expect_refused(plastic(kUnset, restitution),
                   fmt::format("CrushModel.unloading.restitution = {}: must be >= 0 and <= 1", restitution));
  expect_refused(plastic(std::numeric_limits<double>::infinity(), kUnset), "unloading_stiffness_n_per_m = inf N/m");
  expect_refused([](CrushModel& m) { m.unloading.restitution = 0.1; },
                 "CrushModel.unloading.restitution: goes with kind plastic, this is elastic: choose plastic or leave");
  expect_refused([](CrushModel& m) { m.unloading.unloading_stiffness_n_per_m = 1e7; },
                 "CrushModel.unloading.unloading_stiffness_n_per_m: goes with kind plastic, this is elastic");
  CrushModel model = test::syn_a();
  for (const double restitution : {0.0, 1.0}) {
    plastic(kUnset, restitution)(model);
    EXPECT_NO_THROW(validate(model));
  }
}

TEST(CrushModel, RefusesARateThatIsNone) {
  const auto rate = [](double r, double v_ref) {
    return [=](CrushModel& m) {
      m = test::syn_b();
      m.law = CrushLaw::rate;
      m.rate_coefficient = r;
      m.reference_speed_mps = v_ref;
    };
  };
  for (const double r : {kUnset, -0.1, std::numeric_limits<double>::infinity()})
    expect_refused(rate(r, 1.0), fmt::format("CrushModel.rate_coefficient = {}: must be >= 0 with law rate", r));
  for (const double v_ref : {kUnset, 0.0, -1.0})
    expect_refused(rate(0.1, v_ref),
                   fmt::format("CrushModel.reference_speed_mps = {} m/s: must be > 0 with law rate", v_ref));
  expect_refused(
      [&](CrushModel& m) {
        const PiecewiseLinear damper = m.damper;
        rate(0.1, 1.0)(m);
        m.damper = damper;
      },
      "CrushModel.damper: law rate has none: its rate effect is rate_coefficient");
  expect_refused([](CrushModel& m) { m.rate_coefficient = 0.1; },
                 "CrushModel.rate_coefficient: goes with law rate, this is stiffness: choose rate or leave it out");
  expect_refused(
      [](CrushModel& m) {
        m.law = CrushLaw::crush_damping;
        m.reference_speed_mps = 1.0;
      },
      "CrushModel.reference_speed_mps: goes with law rate, this is crush_damping");
  CrushModel model;
  rate(0.0, 1e-6)(model);
  EXPECT_NO_THROW(validate(model));
}

TEST(CrushModel, UnloadingIsEqualWhenTheSameNumbersAreUnset) {
  const Unloading elastic, plastic{UnloadingKind::plastic, false, kUnset, 0.1};
  EXPECT_EQ(elastic, Unloading());
  EXPECT_EQ(plastic, Unloading(plastic));
  EXPECT_NE(plastic, (Unloading{UnloadingKind::plastic, true, kUnset, 0.1}));
  EXPECT_NE(plastic, (Unloading{UnloadingKind::plastic, false, kUnset, 0.2}));
  EXPECT_NE(plastic, (Unloading{UnloadingKind::plastic, false, 0.1, kUnset}));
}

TEST(CrushModel, NeedsASpringOrADamper) {
  expect_refused([](CrushModel& m) { m.spring = m.damper = {}; },
                 "CrushModel: has neither spring nor damper: give one of them knots and ordinates");
  CrushModel model = test::syn_a();
  model.spring = {};
  EXPECT_NO_THROW(validate(model));
  EXPECT_EQ(spring_force(model, 0.3), 0.0);
  EXPECT_EQ(spring_energy(model, 0.3), 0.0);
  model = test::syn_b();
  EXPECT_NO_THROW(validate(model));
  EXPECT_EQ(damper_force(model, 3.0), 0.0);
}

/// Curve at |s|, extrapolated as the model says.
double ordinate(const CrushModel& model, const PiecewiseLinear& curve, double s) {
  const std::size_t n = curve.knots.size();
  if (model.extrapolation != Extrapolation::linear || n < 2 || s <= curve.knots.back()) return evaluate(curve, s);
  const double slope = (curve.ordinates[n - 1] - curve.ordinates[n - 2]) / (curve.knots[n - 1] - curve.knots[n - 2]);
  return curve.ordinates[n - 1] + slope * (s - curve.knots[n - 1]);
}

TEST(CrushModel, ForcesAreTheCurvesOrdinatesOddInTheirVariable) {
  test::Random random(11);
  for (int i = 0; i < 200; ++i) {
    CrushModel model = test::random_crush_model(random);
    if (i % 3 == 0) model.extrapolation = Extrapolation::error;
    for (int j = 0; j < 20; ++j) {
      if (!model.spring.knots.empty()) {
        const double x = model.spring.knots.back() * random.between(0.0, 1.5);
        const double k = ordinate(model, model.spring, x);
        const double expected = model.law == CrushLaw::stiffness ? k * x : k;
        const double scale = std::ranges::max(model.spring.ordinates) * (model.law == CrushLaw::stiffness ? x : 1.0);
        const double rounding = kRounding * static_cast<double>(model.spring.knots.size()) * scale;
        EXPECT_NEAR(spring_force(model, x), expected, rounding);
        EXPECT_NEAR(spring_force(model, -x), -expected, rounding);
      }
      if (model.damper.knots.empty()) continue;
      const double v = model.damper.knots.back() * random.between(0.0, 1.5);
      const double expected = ordinate(model, model.damper, v) * v;
      const double rounding =
          kRounding * std::ranges::max(model.damper.ordinates) * v * static_cast<double>(model.damper.knots.size());
      EXPECT_NEAR(damper_force(model, v), expected, rounding);
      EXPECT_NEAR(damper_force(model, -v), -expected, rounding);
    }
  }
}

TEST(CrushModel, DampingOverCrushIsTheCurvesOrdinateTimesVelocity) {
  test::Random random(13);
  for (int i = 0; i < 100; ++i) {
    CrushModel model = test::random_model_of(CrushLaw::crush_damping, random);
    if (model.damper.knots.empty()) continue;
    for (int j = 0; j < 20; ++j) {
      const double x = std::max(model.damper.knots.back(), 0.1) * random.between(0.0, 1.5);
      const double v = random.between(-20.0, 20.0);
      const double expected = ordinate(model, model.damper, x) * v;
      const double rounding = kRounding * std::ranges::max(model.damper.ordinates) * std::abs(v) *
                              static_cast<double>(model.damper.knots.size());
      EXPECT_NEAR(damper_force(model, x, v), expected, rounding);
      EXPECT_NEAR(damper_force(model, -x, v), expected, rounding) << "even in x";
      if (!model.spring.knots.empty()) {
        EXPECT_NEAR(spring_force(model, x), ordinate(model, model.spring, x),
                    kRounding * std::ranges::max(model.spring.ordinates) *
                        static_cast<double>(model.spring.knots.size() + model.damper.knots.size()));
      }
    }
    EXPECT_THAT([&] { damper_force(model, 1.0); },
                ThrowsMessage<InvalidInput>(HasSubstr("with law crush_damping the damper's force depends on the crush, "
                                                      "too: give crush and velocity")));
  }
}

TEST(CrushModel, ARateIsALogarithmOfTheSpeedTimesTheForce) {
  test::Random random(14);
  for (int i = 0; i < 100; ++i) {
    const CrushModel model = test::random_model_of(CrushLaw::rate, random);
    const double x = std::max(model.spring.knots.back(), 0.1) * random.between(-1.5, 1.5);
    const double v = model.impact_speed_mps * random.between(-1.0, 1.0);
    const double factor = model.rate_coefficient * std::log(1.0 + std::abs(v) / model.reference_speed_mps);
    const double force = spring_force(model, x);
    EXPECT_NEAR(damper_force(model, x, v), force * factor, kRounding * std::abs(force) * (1.0 + factor));
    EXPECT_THAT([&] { damper_force(model, v); },
                ThrowsMessage<InvalidInput>(HasSubstr("with law rate the damper's force depends on the crush")));
  }
}

/// Integral of the spring's force over [0, x] by two-point Gauss quadrature between knots: exact for cubics.
double quadrature(const CrushModel& model, double x) {
  std::vector<double> ends = model.spring.knots;
  std::erase_if(ends, [&](double knot) { return knot >= x; });
  ends.push_back(x);
  double work = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double middle = 0.5 * (ends[i] + ends[i + 1]), half = 0.5 * (ends[i + 1] - ends[i]);
    for (const double side : {-1.0, 1.0}) work += half * spring_force(model, middle + side * half / std::sqrt(3.0));
  }
  return work;
}

TEST(CrushModel, SpringEnergyIsTheWorkOfTheForce) {
  test::Random random(12);
  for (int i = 0; i < 300; ++i) {
    const CrushModel model = test::random_crush_model(random);
    if (model.spring.knots.empty()) continue;
    const double x = model.spring.knots.back() * random.between(0.01, 1.5);
    const double scale = std::ranges::max(model.spring.ordinates) * x * (model.law == CrushLaw::stiffness ? x : 1.0);
    const double rounding = kRounding * static_cast<double>(model.spring.knots.size()) * scale;
    EXPECT_NEAR(spring_energy(model, x), quadrature(model, x), rounding);
    EXPECT_NEAR(spring_energy(model, -x), quadrature(model, x), rounding);  // an even function
    EXPECT_EQ(spring_energy(model, 0.0), 0.0);
    EXPECT_THAT(spring_energy(model, kUnset), testing::IsNan());
  }
}

}  // namespace
}  // namespace crashsim
