/// The Taylor kernel in SIMD lanes against CVODE, on random models of every kind.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/simulate_many.hpp>

#include "parallel.hpp"
#include "support/many_models.hpp"

namespace crashsim {
namespace {

constexpr int kFamilies = 100;
constexpr int kFamiliesOfLaw = 20;
constexpr std::size_t kModelsEach = 100;
constexpr double kAgreement = 1e-8;  // of each channel's size, for both engines at rtol 1e-10
constexpr double kEnd_s = 0.15;

/// Largest difference of a row from a reference, by the reference's largest value or by `least`.
double difference(const RowMatrix& rows, std::size_t row, const std::vector<double>& reference, double least) {
  double size = least, worst = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    size = std::max(size, std::fabs(reference[i]));
    const double other = rows(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i));
    worst =
        std::isnan(other) ? std::numeric_limits<double>::infinity() : std::max(worst, std::fabs(reference[i] - other));
  }
  return worst / size;
}

bool broke_off(CrushOutcome outcome) {
  return outcome != CrushOutcome::completed && outcome != CrushOutcome::no_max_crush;
}

struct Worst {
  double displacement = 0.0, velocity = 0.0, accel = 0.0;
  std::size_t model = 0;
  std::string outcomes;
};

Worst compare(const CrushModels& models) {
  SimulateManyOptions options;
  options.end_time_s = kEnd_s;
  options.dt_s = 5e-4;
  options.rtol = 1e-10;
  options.jobs = 1;
  const CrushResponses many = simulate_many(models, options);
  Worst worst;
  for (std::size_t i = 0; i < models.count(); ++i) {
    SimulateOptions alone;
    alone.times_s = many.time_s;
    alone.rtol = 1e-10;
    const CrushResponse record = simulate(models.model(i), alone);
    // What grows without bound ends as `failed` or at the step limit, by the engine.
    const bool both_broke_off = broke_off(record.outcome) && broke_off(many.outcome[i]);
    if (record.outcome != many.outcome[i] && !both_broke_off)
      worst.outcomes += std::to_string(i) + ": " + std::string(name_of(many.outcome[i])) + ", CVODE " +
                        std::string(name_of(record.outcome)) + "; ";
    if (broke_off(record.outcome)) continue;
    const double x = difference(many.displacement_m, i, record.displacement_m, 0.1);
    const double v = difference(many.velocity_mps, i, record.velocity_mps, 1.0);
    const double a = difference(many.accel_mps2, i, record.accel_mps2, 1.0);
    if (std::max({x, v, a}) > std::max({worst.displacement, worst.velocity, worst.accel})) {
      worst.displacement = x;
      worst.velocity = v;
      worst.accel = a;
      worst.model = i;
    }
  }
  return worst;
}

/// Compares families 1..count, made by `make`(seed).
template <class Make>
void expect_agreement(int count, const Make& make) {
  std::vector<Worst> worst(static_cast<std::size_t>(count));
  parallel_for(count, thread_count(0),
               [&](int, int family) {
                 worst[static_cast<std::size_t>(family)] = compare(make(static_cast<std::uint64_t>(family) + 1));
               },
               {});
  for (int family = 0; family < count; ++family) {
    const Worst& here = worst[static_cast<std::size_t>(family)];
    EXPECT_EQ(here.outcomes, "") << "family " << family;
    EXPECT_LE(here.displacement, kAgreement) << "family " << family << ", model " << here.model;
    EXPECT_LE(here.velocity, kAgreement) << "family " << family << ", model " << here.model;
    EXPECT_LE(here.accel, kAgreement) << "family " << family << ", model " << here.model;
  }
}

TEST(ManyModels, TenThousandRandomOnesAgreeWithCvode) {
  expect_agreement(kFamilies, [](std::uint64_t seed) { return test::random_family(seed, kModelsEach); });
}

TEST(ManyModels, OfCrushDampingAgreeWithCvode) {
  expect_agreement(kFamiliesOfLaw, [](std::uint64_t seed) {
    return test::random_family_of(CrushLaw::crush_damping, seed, kModelsEach);
  });
}

TEST(ManyModels, OfRateAgreeWithCvode) {
  expect_agreement(kFamiliesOfLaw / 2,
                   [](std::uint64_t seed) { return test::random_family_of(CrushLaw::rate, seed, kModelsEach / 2); });
}

}  // namespace
}  // namespace crashsim
