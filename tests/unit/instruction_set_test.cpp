/// The kernels give the same bits from every instruction set.

#include "instruction_set.hpp"

#include <cstring>
#include <vector>

#include <gmock/gmock.h>

#include "optimize/fit_kernel.hpp"
#include "solver/propagator_kernel.hpp"
#include "support/random.hpp"

namespace crashsim {
namespace {

class InstructionSetOf : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!is_available(GetParam())) GTEST_SKIP() << "this processor does not have it";
  }
};
INSTANTIATE_TEST_SUITE_P(All, InstructionSetOf, testing::Values(InstructionSet::avx2, InstructionSet::avx512),
                         [](const auto& set) { return set.param == InstructionSet::avx2 ? "Avx2" : "Avx512"; });

std::vector<double> random_numbers(test::Random& random, std::size_t count, double size) {
  std::vector<double> numbers(count);
  for (double& number : numbers) number = random.between(-size, size);
  return numbers;
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// A piece of a motion, and samples in it.
struct FitCase {
  FitPiece piece{};
  std::vector<double> time, accel, velocity, displacement;

  explicit FitCase(test::Random& random, std::size_t samples) {
    for (int n = 0; n <= kFitDegree; ++n) {
      piece.x[n] = random.between(-1.0, 1.0);
      piece.v[n] = random.between(-1.0, 1.0);
    }
    for (double& coefficient : piece.force) coefficient = random.between(0.0, 1e5);
    for (auto& basis : piece.basis)
      for (double& coefficient : basis) coefficient = random.between(-1.0, 1.0);
    piece.mass = 1500.0;
    time = random_numbers(random, samples + kColumnLanes, 0.3);
    accel = random_numbers(random, samples + kColumnLanes, 300.0);
    velocity = random_numbers(random, samples + kColumnLanes, 1.0);
    displacement = random_numbers(random, samples + kColumnLanes, 1.0);
  }
  [[nodiscard]] FitSamples samples() const {
    return {time.data(), accel.data(), velocity.data(), displacement.data(), time.size() - kColumnLanes, 0.01};
  }
};

TEST_P(InstructionSetOf, FitKernelGivesTheBitsOfTheBaseline) {
  const FitKernel& kernel = KernelChoice<FitKernel>{kFitKernelBaseline, kFitKernelAvx2, kFitKernelAvx512}(GetParam());
  test::Random random(21);
  for (const std::size_t samples : {1u, 7u, 8u, 9u, 40u, 61u}) {
    const FitCase fit(random, samples);
    SensitivitySeries series{}, expected_series{};
    kernel.sensitivities(fit.piece, series);
    kFitKernelBaseline.sensitivities(fit.piece, expected_series);
    for (int n = 0; n <= kFitDegree; ++n)
      for (std::size_t c = 0; c < kColumns; ++c) {
        EXPECT_EQ(series.x[n][c], expected_series.x[n][c]);
        EXPECT_EQ(series.v[n][c], expected_series.v[n][c]);
      }
    for (const auto kind : {Penalty::absolute, Penalty::rounded, Penalty::squared, Penalty::huber}) {
      const Penalty penalty{kind, 0.003, 0.06, 1.4, 0.02, 0.02, 0.02};
      PieceLoss loss{}, expected{};
      kernel.loss(fit.piece, fit.samples(), penalty, loss);
      kFitKernelBaseline.loss(fit.piece, fit.samples(), penalty, expected);
      EXPECT_TRUE(same_bits(loss, expected));
      kernel.loss_and_gradient(fit.piece, series, fit.samples(), penalty, loss);
      kFitKernelBaseline.loss_and_gradient(fit.piece, series, fit.samples(), penalty, expected);
      EXPECT_TRUE(same_bits(loss, expected));
      kernel.normal_equations(fit.piece, series, fit.samples(), penalty, loss);
      kFitKernelBaseline.normal_equations(fit.piece, series, fit.samples(), penalty, expected);
      EXPECT_TRUE(same_bits(loss, expected));
    }
  }
}

TEST_P(InstructionSetOf, PropagatorKernelGivesTheBitsOfTheBaseline) {
  const PropagatorKernel& kernel = KernelChoice<PropagatorKernel>{kPropagatorKernelBaseline, kPropagatorKernelAvx2,
                                                                  kPropagatorKernelAvx512}(GetParam());
  constexpr std::size_t kSteps = 50;
  test::Random random(22);
  const std::vector<double> matrix = random_numbers(random, 40, 0.3), forces = random_numbers(random, 6 * kSteps, 1.0);
  std::vector<double> states = random_numbers(random, 4 * (kSteps + 1), 1.0), expected = states;
  kernel.run(matrix.data(), forces.data(), states.data(), kSteps);
  kPropagatorKernelBaseline.run(matrix.data(), forces.data(), expected.data(), kSteps);
  EXPECT_EQ(std::memcmp(states.data(), expected.data(), states.size() * sizeof(double)), 0);
}

}  // namespace
}  // namespace crashsim
