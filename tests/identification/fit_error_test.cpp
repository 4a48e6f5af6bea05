/// E of [Noorsumar2021] eq. (4), recomputed from its definition with an integrator of the tests' own.

#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <crashsim/identify.hpp>

#include "support/fit_cases.hpp"
#include "support/reference_motion.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-9;  // solver: between CVODE at rtol 1e-10 and small Runge-Kutta steps; measured 1e-11

using Penalty = std::function<double(double)>;

/// Sum over the samples 0..t_m of a channel's penalty(weight * error).
double channel_sum(const std::vector<double>& data, const std::vector<double>& model, double weight,
                   const Penalty& penalty) {
  double sum = 0.0;
  for (std::size_t i = 0; i < model.size(); ++i) sum += penalty(weight * (model[i] - data[i]));
  return sum;
}

struct Reference {
  std::vector<double> accel, velocity, displacement;
};

Reference reference_at_samples(const CrushModel& model, const Pulse& pulse) {
  std::vector<double> times;
  for (const double t : pulse.time_s)
    if (t <= pulse.t_m_s) times.push_back(t);
  Reference out;
  for (const auto& sample :
       test::ReferenceMotion<double>(model, test::ordinates_of(model), pulse.impact_speed_mps).at(times)) {
    out.accel.push_back(sample.a);
    out.velocity.push_back(sample.v);
    out.displacement.push_back(sample.x);
  }
  return out;
}

double largest(const std::vector<double>& channel, std::size_t count) {
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::fabs(channel[i]));
  return most;
}

void expect_same(const FitError& found, const std::array<double, 3>& channels, const std::string& what) {
  const double total = channels[0] + channels[1] + channels[2];
  const double tolerance = kAgreement * total;
  EXPECT_NEAR(found.accel, channels[0], tolerance) << what;
  EXPECT_NEAR(found.velocity, channels[1], tolerance) << what;
  EXPECT_NEAR(found.displacement, channels[2], tolerance) << what;
  EXPECT_NEAR(found.total, total, tolerance) << what;
}

double absolute(double u) { return std::fabs(u); }
double squared(double u) { return u * u; }
double huber(double u) {
  constexpr double kThreshold = 0.05;
  return std::fabs(u) > kThreshold ? std::fabs(u) - kThreshold / 2.0 : u * u / (2.0 * kThreshold);
}

class FitErrorOf : public testing::TestWithParam<CrushLaw> {};

/// Models off the pulse's own by tens of per cent, some of which stop long before it and rebound.
TEST_P(FitErrorOf, RandomModelsIsItsDefinition) {
  constexpr int kModels = 20;
  test::Random random(7);
  int judged = 0;
  for (int i = 0; i < kModels; ++i) {
    CrushModel model = test::random_crush_model(random, GetParam());
    const auto pulse = test::pulse_of(model, model.impact_speed_mps);
    if (!pulse) continue;
    for (double& k : model.spring.ordinates) k *= random.between(0.5, 2.5);
    const Reference r = reference_at_samples(model, *pulse);
    const std::size_t n = r.accel.size();
    const std::array<double, 3> weights = {1.0 / largest(pulse->accel_mps2, n), 1.0 / largest(pulse->velocity_mps, n),
                                           1.0 / largest(pulse->displacement_m, n)};
    const auto sums = [&](const std::array<double, 3>& w, const Penalty& penalty, double factor) {
      return std::array<double, 3>{factor * channel_sum(pulse->accel_mps2, r.accel, w[0], penalty),
                                   factor * channel_sum(pulse->velocity_mps, r.velocity, w[1], penalty),
                                   factor * channel_sum(pulse->displacement_m, r.displacement, w[2], penalty)};
    };
    const double mean = 1.0 / static_cast<double>(n);
    const std::string which = "model " + std::to_string(i);
    expect_same(fit_error(model, *pulse), sums(weights, absolute, mean), which + ", normalised l1");
    expect_same(fit_error(model, *pulse, {}, Loss::l2), sums(weights, squared, mean), which + ", normalised l2");
    expect_same(fit_error(model, *pulse, {}, Loss::huber), sums(weights, huber, mean), which + ", normalised huber");
    expect_same(fit_error(model, *pulse, {Weights::paper, {}}), sums({1.0, 1.0, 1.0}, absolute, 1.0),
                which + ", paper");
    const std::array<double, 3> given = {0.25, 3.0, 40.0};
    const Setting<Weights> setting{Weights::given, {given[0], given[1], given[2]}};
    expect_same(fit_error(model, *pulse, setting), sums(given, absolute, 1.0), which + ", given");
    ++judged;
  }
  EXPECT_GT(judged, kModels / 2);
}

INSTANTIATE_TEST_SUITE_P(Laws, FitErrorOf, testing::Values(CrushLaw::stiffness, CrushLaw::force),
                         [](const auto& law) { return std::string(name_of(law.param)); });

TEST(FitError, OfTheModelThatMadeThePulseVanishes) {
  constexpr double kVanishes = 1e-9;  // solver: as kAgreement
  const CrushModel model = test::example_model();
  EXPECT_LT(fit_error(model, test::pulse_of(model, model.impact_speed_mps).value()).total, kVanishes);
}

TEST(FitError, TakesThePulsesMassWhenTheModelHasNone) {
  CrushModel model = test::example_model();
  const Pulse pulse = test::pulse_of(model, model.impact_speed_mps).value();
  const FitError with = fit_error(model, pulse);
  model.mass_kg = kUnset;
  EXPECT_EQ(fit_error(model, pulse).total, with.total);
}

}  // namespace
}  // namespace crashsim
