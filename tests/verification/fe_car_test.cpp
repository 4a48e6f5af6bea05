/// The finite-element car of data/fe-car: what its trimmed time histories must say, checked against the run's own
/// displacements and momentum.

#include <algorithm>
#include <ostream>
#include <string>

#include <gmock/gmock.h>

#include <crashsim/case.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/trace_io.hpp>

#include "support/source_dir.hpp"

namespace crashsim {
namespace {

// The filter shortens the sharp turn of v at maximum crush: C of a filtered pulse against the run's own displacement.
constexpr double kFilteredCrush = 2e-3;   // solver: relative
constexpr double kSolverDigits = 1e-6;    // rounding: the run prints seven digits
constexpr double kGroundFriction = 0.02;  // solver: share of the momentum that the ground takes

struct Run {
  const char* name;
  double speed_mps;
};
void PrintTo(const Run& run, std::ostream* out) { *out << run.name; }

class FeCar : public testing::TestWithParam<Run> {
 protected:
  static std::string path() { return std::string(test::source_dir()) + "/data/fe-car/" + GetParam().name + ".csv"; }
  static const Trace& named(const TraceSet& set, const std::string& name) {
    return set.traces.at(select_channels(set, name).at(0));
  }
};

TEST_P(FeCar, UnitsMassAndSpeedComeFromTheFile) {
  const TraceSet set = read_traces(path());
  EXPECT_EQ(set.format, "csv");
  EXPECT_THAT(set.warnings, testing::IsEmpty());
  EXPECT_EQ(set.mass_kg, 1190.017);
  EXPECT_EQ(set.impact_speed_mps, GetParam().speed_mps);
  EXPECT_NEAR(named(set, "LEFT_REAR_VX").values.front(), -GetParam().speed_mps, kSolverDigits * GetParam().speed_mps);
  const double momentum = -set.mass_kg * set.impact_speed_mps;
  EXPECT_NEAR(named(set, "momentum_x").values.front(), momentum, -kSolverDigits * momentum);
  EXPECT_NEAR(named(set, "kinetic_energy").values.front(), -0.5 * momentum * set.impact_speed_mps,
              -kSolverDigits * momentum * set.impact_speed_mps);
  EXPECT_NEAR(named(set, "LEFT_REAR_AZ").values.front(), -9.81, 9.81 * kSolverDigits);
}

TEST_P(FeCar, TheWallTakesTheMomentum) {
  const TraceSet set = read_traces(path());
  const auto& momentum = named(set, "momentum_x").values;
  const double on_the_wall = named(set, "barrier_impulse_FNX").values.back();
  EXPECT_NEAR(momentum.back() - momentum.front(), -on_the_wall, -kGroundFriction * on_the_wall);
}

TEST_P(FeCar, ThePulseOfTheRearNodesCrushesAsTheyMove) {
  PulseOptions options;
  options.channels = {"LEFT_REAR_VX", "RIGHT_REAR_VX"};
  const Pulse pulse = read_pulse(path(), options);
  EXPECT_EQ(pulse.mass_kg, 1190.017);
  EXPECT_EQ(pulse.velocity_mps.front(), GetParam().speed_mps);
  EXPECT_THAT(pulse.warnings, testing::Contains(testing::HasSubstr("channel 13 LEFT_REAR_VX: sign turned")));

  const TraceSet set = read_traces(path());
  const auto& left = named(set, "LEFT_REAR_DX").values;
  const auto& right = named(set, "RIGHT_REAR_DX").values;
  double crush_m = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) crush_m = std::max(crush_m, -0.5 * (left[i] + right[i]));
  EXPECT_NEAR(pulse.max_crush_m, crush_m, kFilteredCrush * crush_m);
}

TEST(FeCarCase, ReboundsAsTheCarWhenUnloadedPlastically) {
  constexpr double kRebound = 0.2;       // solver: relative, model against the nodes' own velocity
  constexpr double kStaticCrush = 0.03;  // solver: relative
  const std::string folder = std::string(test::source_dir()) + "/data/fe-car/";
  const TraceSet set = read_traces(folder + "C56.csv");
  const auto& left = set.traces.at(select_channels(set, "LEFT_REAR_VX").at(0)).values;
  const auto& right = set.traces.at(select_channels(set, "RIGHT_REAR_VX").at(0)).values;
  double rebound_mps = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) rebound_mps = std::max(rebound_mps, 0.5 * (left[i] + right[i]));

  Case study = read_case(folder + "case.toml");
  study.identify.starts = 1;
  study.what.speeds_mps.clear();
  study.what.unloading = UnloadingKind::elastic;
  const CaseResult elastic = run_case(study);
  study.what.unloading = UnloadingKind::plastic;
  const CaseResult plastic = run_case(study);
  ASSERT_TRUE(plastic.usable()) << plastic.response.message;
  EXPECT_EQ(plastic.model.spring, elastic.model.spring);  // identification does not look beyond maximum crush
  EXPECT_EQ(plastic.model.damper, elastic.model.damper);
  EXPECT_NEAR(-plastic.response.rebound_velocity_mps, rebound_mps, kRebound * rebound_mps);
  EXPECT_GT(-elastic.response.rebound_velocity_mps, (1.0 + kRebound) * rebound_mps);
  const double static_crush_m = metrics_of(*plastic.pulse).static_crush_m;
  EXPECT_NEAR(plastic.response.static_crush_m, static_crush_m, kStaticCrush * static_crush_m);
}

INSTANTIATE_TEST_SUITE_P(Runs, FeCar, testing::Values(Run{"C40", 11.111}, Run{"C56", 15.64}));

}  // namespace
}  // namespace crashsim
