#include <crashsim/simulate_many.hpp>

#include <cstring>

#include <gmock/gmock.h>

#include "support/many_models.hpp"

namespace crashsim {
namespace {

TEST(SimulateManyThreads, GiveTheSameBitsWhateverTheirNumber) {
  const CrushModels models = test::random_family(5, 500);
  SimulateManyOptions options;
  options.dt_s = 2e-3;
  options.metrics = ManyMetrics::all;
  options.jobs = 1;
  const CrushResponses one = simulate_many(models, options);
  for (const int jobs : {2, 7}) {
    options.jobs = jobs;
    const CrushResponses several = simulate_many(models, options);
    EXPECT_EQ(several.outcome, one.outcome);
    EXPECT_EQ(several.steps, one.steps);
    const auto bytes = static_cast<std::size_t>(one.accel_mps2.size()) * sizeof(double);
    EXPECT_EQ(std::memcmp(several.accel_mps2.data(), one.accel_mps2.data(), bytes), 0);
    EXPECT_EQ(std::memcmp(several.metrics.data(), one.metrics.data(), one.metrics.size() * sizeof(Metrics)), 0);
  }
}

}  // namespace
}  // namespace crashsim
