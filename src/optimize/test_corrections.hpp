#pragma once
/// Errors of the tests' accelerometers, found together with the model.

#include <span>
#include <vector>

#include <crashsim/pulse.hpp>

#include "optimize/fit_study.hpp"

namespace crashsim {

/// measured(t) = gain * true(t - time_shift_s) + bias_mps2.
struct TestCorrection {
  double time_shift_s = 0.0, gain = 1.0, bias_mps2 = 0.0;
};

/// The target as the pulse would be without the error: its acceleration corrected, velocity and displacement by what
/// that adds to their integrals. Times and weights stay.
FitTarget corrected(const FitTarget& target, const Pulse& pulse, const TestCorrection& correction);

/// Which errors are sought, and where they are among the numbers: for each test in turn those with a deviation.
class SoughtCorrections {
 public:
  SoughtCorrections(const IdentifyOptions& options, std::size_t tests);

  [[nodiscard]] bool empty() const { return kinds_.empty(); }
  [[nodiscard]] std::size_t size() const { return kinds_.size() * tests_; }
  [[nodiscard]] std::size_t tests() const { return tests_; }
  /// Deviation expected of a number.
  [[nodiscard]] double deviation(std::size_t index) const { return kinds_[index % kinds_.size()].deviation; }
  [[nodiscard]] std::size_t test_of(std::size_t index) const { return index / kinds_.size(); }
  [[nodiscard]] TestCorrection of_test(std::span<const double> numbers, std::size_t test) const;
  /// Member of a report that a number belongs to, and that of its standard error.
  struct Reported {
    double TestReport::*value;
    double TestReport::*error;
  };
  [[nodiscard]] Reported reported(std::size_t index) const { return kinds_[index % kinds_.size()].reported; }

 private:
  struct Kind {
    double TestCorrection::*member;
    double deviation;
    Reported reported;
  };
  std::vector<Kind> kinds_;
  std::size_t tests_;
};

/// Model and corrections that fit together best.
struct CorrectedFit {
  std::vector<double> parameters, corrections;
  std::vector<FitTarget> targets;  ///< Corrected.
};
CorrectedFit fit_corrections(const FitStudy& study, std::span<const Pulse> pulses, const SoughtCorrections& sought,
                             std::vector<double> parameters);

/// Derivatives of the scaled residuals by the corrections, in the rows of FitObjective::jacobian().
Eigen::MatrixXd correction_jacobian(const FitStudy& study, std::span<const Pulse> pulses,
                                    const SoughtCorrections& sought, std::span<const double> corrections);

/// Rows that what is expected of the corrections adds to those.
Eigen::MatrixXd correction_rows(const FitStudy& study, const SoughtCorrections& sought);

}  // namespace crashsim
