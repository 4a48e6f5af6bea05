/// The Taylor kernel in lanes: the same bits from every instruction set, whatever stands in the other lanes.

#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "solver/lane_motions.hpp"
#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

constexpr double kTolerance = 1e-9;

std::vector<CrushModel> random_models(int count) {
  test::Random random(11);
  std::vector<CrushModel> models;
  for (int i = 0; i < count; ++i)
    models.push_back(i % 3 == 2 ? test::random_model_of(CrushLaw::crush_damping, random)
                                : test::random_crush_model(random));
  return models;
}

struct Rows {
  std::vector<double> accel, velocity, displacement;
};

/// Motions of all the models, one after the other.
Rows run(const std::vector<CrushModel>& models, const std::vector<double>& times, InstructionSet set) {
  const std::size_t n = times.size();
  Rows rows;
  for (auto* row : {&rows.accel, &rows.velocity, &rows.displacement}) row->resize(models.size() * n);
  LaneMotions motions(times, kTolerance, set);
  motions.run({models.size(),
               [&](std::size_t i, LaneModel& lane) {
                 lane.force = make_force(models[i]);
                 lane.mass_kg = models[i].mass_kg;
                 lane.speed_mps = models[i].impact_speed_mps;
                 lane.unloading = models[i].unloading;
               },
               [&](std::size_t i) {
                 return LaneRow{&rows.accel[i * n], &rows.velocity[i * n], &rows.displacement[i * n]};
               },
               [](std::size_t, const MotionSummary&) {}});
  return rows;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

std::vector<double> grid() {
  std::vector<double> times;
  for (int i = 0; i <= 301; ++i) times.push_back(5e-4 * i);
  return times;
}

class LaneKernelOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(InstructionSets, LaneKernelOf, testing::Values(InstructionSet::avx2, InstructionSet::avx512),
                         [](const auto& set) { return set.param == InstructionSet::avx2 ? "Avx2" : "Avx512"; });

TEST_P(LaneKernelOf, GivesTheBitsOfTheBaseline) {
  if (!is_available(GetParam())) GTEST_SKIP() << "this processor does not have it";
  const std::vector<CrushModel> models = random_models(300);
  const Rows baseline = run(models, grid(), InstructionSet::baseline), wide = run(models, grid(), GetParam());
  EXPECT_TRUE(same_bits(baseline.accel, wide.accel));
  EXPECT_TRUE(same_bits(baseline.velocity, wide.velocity));
  EXPECT_TRUE(same_bits(baseline.displacement, wide.displacement));
}

TEST(LaneKernel, AMotionDoesNotDependOnTheOtherLanes) {
  const std::vector<CrushModel> models = random_models(40);
  const std::vector<double> times = grid();
  const Rows together = run(models, times, widest_instruction_set());
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Rows alone = run({models[i]}, times, widest_instruction_set());
    EXPECT_EQ(
        std::memcmp(alone.displacement.data(), &together.displacement[i * times.size()], times.size() * sizeof(double)),
        0)
        << "model " << i;
  }
}

TEST(LaneKernel, SamplesAtUnevenTimes) {
  const std::vector<CrushModel> models = random_models(30);
  const std::vector<double> even = grid();
  std::vector<double> uneven, places;
  for (std::size_t i = 0; i < even.size(); i = i < 20 ? i + 1 : i + 40) {
    uneven.push_back(even[i]);
    places.push_back(static_cast<double>(i));
  }
  const Rows all = run(models, even, widest_instruction_set());
  const Rows some = run(models, uneven, widest_instruction_set());
  for (std::size_t m = 0; m < models.size(); ++m)
    for (std::size_t i = 0; i < uneven.size(); ++i) {
      const double expected = all.velocity[m * even.size() + static_cast<std::size_t>(places[i])];
      const double actual = some.velocity[m * uneven.size() + i];
      if (std::isnan(expected)) continue;
      EXPECT_NEAR(actual, expected, 1e-7 * models[m].impact_speed_mps);
    }
}

TEST(LaneKernel, AlwaysHasTheBaseline) {
  EXPECT_TRUE(is_available(InstructionSet::baseline));
  EXPECT_TRUE(is_available(widest_instruction_set()));
}

}  // namespace
}  // namespace crashsim
