/// The gradient of the vertical law's objective against complex steps through the law as it is written down.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "optimize/vertical_objective.hpp"
#include "support/random.hpp"
#include "support/vertical_fit_cases.hpp"

namespace crashsim {
namespace {

using Complex = std::complex<double>;
using L = VerticalForceLaw;

constexpr double kGradient = 1e-12;     // rounding: of the largest scaled derivative
constexpr double kComplexStep = 1e-30;  // no rounding, no truncation
constexpr std::array kNumbers = {&L::angle_rad, &L::angle_rate_rad_per_m, &L::angle_start_m, &L::friction};

Complex penalty(Loss loss, Complex u, double smoothing) {
  constexpr double kThreshold = 0.05;
  const double size = std::fabs(u.real());
  if (loss == Loss::l2) return u * u;
  if (loss == Loss::huber && size <= kThreshold) return u * u / (2.0 * kThreshold);
  if (loss == Loss::l1 && smoothing > 0.0) return std::sqrt(u * u + smoothing * smoothing) - smoothing;
  return (u.real() < 0.0 ? -u : u) - (loss == Loss::huber ? kThreshold / 2.0 : 0.0);
}

Complex reference_error(const std::array<Complex, 4>& p, const VerticalFitTarget& target, Loss loss, double smoothing) {
  double largest = 0.0;
  for (const VerticalSample& sample : target.samples) largest = std::max(largest, std::fabs(sample.vertical_n));
  Complex sum = 0.0;
  for (const VerticalSample& sample : target.samples) {
    const Complex past = sample.crush_m > p[2].real() ? sample.crush_m - p[2] : Complex(0.0);
    Complex ratio = std::tan(p[0] + p[1] * past);
    if (ratio.real() > p[3].real()) ratio = p[3];
    if (ratio.real() < -p[3].real()) ratio = -p[3];
    sum += penalty(loss, (sample.longitudinal_n * ratio - sample.vertical_n) / largest, smoothing);
  }
  return sum / static_cast<double>(target.samples.size());
}

TEST(VerticalGradient, OfRandomLawsIsThatOfComplexSteps) {
  test::Random random(91);
  IdentifyVerticalOptions options;
  options.free = {"angle", "angle-rate", "angle-start", "friction"};
  const VerticalForceTarget measured = test::measured_by({0.05, 1.0, 0.15, 0.3});
  const VerticalFitTarget target = make_vertical_target(measured, options);
  std::vector<std::string> warnings;
  const auto parameters = vertical_parameters({}, target.largest_crush_m, options, warnings);
  struct How {
    Loss loss;
    double smoothing;
  };
  for (const auto& [loss, smoothing] : {How{Loss::l1, 0.01}, {Loss::l1, 0.0}, {Loss::l2, 0.0}, {Loss::huber, 0.0}}) {
    const VerticalObjective objective({}, target, parameters, loss);
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> values = {random.between(-0.4, 0.4), random.between(-1.5, 1.5),
                                          random.between(0.0, 0.5), random.between(0.1, 0.6)};
      std::vector<double> gradient(4);
      const double error = objective.evaluate(values, smoothing, gradient);
      EXPECT_EQ(objective.evaluate(values, smoothing, {}), error);
      for (std::size_t p = 0; p < kNumbers.size(); ++p) {
        std::array<Complex, 4> moved;
        std::ranges::copy(values, moved.begin());
        moved[p] += Complex(0.0, kComplexStep);
        const Complex reference = reference_error(moved, target, loss, smoothing);
        EXPECT_NEAR(error, reference.real(), kGradient * error);
        EXPECT_NEAR(gradient[p], reference.imag() / kComplexStep, kGradient * std::max(1.0, std::fabs(gradient[p])))
            << "law " << i << ", number " << p << ", " << name_of(loss);
      }
    }
  }
}

/// At the law that made the target all residuals vanish, and the squared loss's Hessian is 2 J'J.
TEST(VerticalGradient, ItsJacobianIsTheHessianWithoutResiduals) {
  constexpr double kStep = 1e-5;
  constexpr double kDifferences = 1e-4;  // central differences: truncation and samples at a kink
  IdentifyVerticalOptions options;
  options.free = {"angle", "angle-rate", "friction"};
  const VerticalFitTarget target = make_vertical_target(test::measured_by({0.05, 1.0, 0.15, 0.3}), options);
  std::vector<std::string> warnings;
  const auto parameters = vertical_parameters({}, target.largest_crush_m, options, warnings);
  const VerticalObjective objective({.angle_start_m = 0.15}, target, parameters, Loss::l2);
  const std::vector<double> values = {0.05, 1.0, 0.3};
  const Eigen::MatrixXd jacobian = objective.jacobian(values);
  const Eigen::MatrixXd hessian = 2.0 * jacobian.transpose() * jacobian;
  for (std::size_t p = 0; p < values.size(); ++p) {
    std::vector<double> moved = values, before(3), after(3);
    moved[p] = values[p] + kStep;
    objective.evaluate(moved, 0.0, after);
    moved[p] = values[p] - kStep;
    objective.evaluate(moved, 0.0, before);
    for (std::size_t q = 0; q < values.size(); ++q) {
      const auto i = static_cast<Eigen::Index>(p), j = static_cast<Eigen::Index>(q);
      EXPECT_NEAR((after[q] - before[q]) / (2.0 * kStep), hessian(i, j),
                  kDifferences * std::sqrt(hessian(i, i) * hessian(j, j)));
    }
  }
}

}  // namespace
}  // namespace crashsim
