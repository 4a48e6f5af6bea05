#include <crashsim/simulate_many.hpp>

#include <cstring>
#include <string>

#include <gmock/gmock.h>

#include "support/many_models.hpp"

namespace crashsim {
namespace {

class SimulateManyThreads : public testing::TestWithParam<ManyIntegrator> {};
INSTANTIATE_TEST_SUITE_P(Integrators, SimulateManyThreads,
                         testing::Values(ManyIntegrator::taylor, ManyIntegrator::cvode_batch),
                         [](const auto& integrator) { return std::string(name_of(integrator.param)); });

TEST_P(SimulateManyThreads, GiveTheSameBitsWhateverTheirNumber) {
  const CrushModels models = test::random_family(5, 500);
  SimulateManyOptions options;
  options.integrator = GetParam();
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
