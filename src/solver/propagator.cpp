#include "solver/propagator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "instruction_set.hpp"
#include "solver/propagator_kernel.hpp"

namespace crashsim {
namespace {

/// Largest norm of generator times step for which the Taylor series is used as it is.
constexpr double kSeriesRadius = 1.0;

/// Degree n at which the remainder is below rounding. The force's derivatives reach the positions through up to three
/// links of size one, so the remainder is norm^(n-2) / (n+1)! rather than norm^(n+1) / (n+1)!.
int series_degree(double norm) {
  int degree = 2;
  for (double remainder = 1.0 / 6.0; remainder > 0.25 * std::numeric_limits<double>::epsilon(); ++degree)
    remainder *= norm / (degree + 2);
  return degree;
}

}  // namespace

Propagator::Propagator(const LinearSystem& system, double same_step_s)
    : generator_(Matrix::Zero()), same_step_s_(same_step_s) {
  generator_.block<2, 2>(0, 2).setIdentity();
  generator_.block<2, 2>(2, 0) = -system.stiffness;
  generator_.block<2, 2>(2, 2) = -system.damping;
  generator_.block<2, 2>(2, 4).setIdentity();
  generator_.block<4, 4>(4, 6).setIdentity();
  norm_ = generator_.cwiseAbs().colwise().sum().maxCoeff();
}

template <int Columns>
void Propagator::multiply_by_exponential(Eigen::Matrix<double, kSize, Columns>& v, double h) const {
  Eigen::Matrix<double, kSize, Columns> term = v;
  const int degree = series_degree(norm_ * h);
  for (int k = 1; k <= degree; ++k) {
    term = (generator_.lazyProduct(term) * (h / k)).eval();
    v += term;
  }
}

Propagator::Matrix Propagator::exponential(double h) const {
  const int halvings = std::max(0, std::ilogb(norm_ * h / kSeriesRadius) + 1);
  Matrix result = Matrix::Identity();
  multiply_by_exponential(result, std::ldexp(h, -halvings));
  for (int i = 0; i < halvings; ++i) result = result.lazyProduct(result).eval();
  return result;
}

PitchState Propagator::step(const PitchState& y, const ForcePiece& force, double h) const {
  Eigen::Matrix<double, kSize, 1> v;
  v << y, force.reshaped();
  if (norm_ * h > kSeriesRadius) return (exponential(h) * v).head<4>();
  multiply_by_exponential(v, h);
  return v.head<4>();
}

/// Matrix of a step that was met before, nullptr for a new one.
const Propagator::StepMatrix* Propagator::matrix_if_recurring(double h) {
  for (Recurring& known : recurring_) {
    if (std::abs(known.h - h) > same_step_s_) continue;
    if (!known.has_matrix) known.matrix = exponential(known.h).topRows<4>();
    known.has_matrix = true;
    return &known.matrix;
  }
  recurring_[oldest_] = {.h = h};
  oldest_ = (oldest_ + 1) % recurring_.size();
  return nullptr;
}

void Propagator::run(std::span<const double> times, std::span<const ForcePiece> forces, std::span<PitchState> states) {
  static const PropagatorKernel& kernel = KernelChoice<PropagatorKernel>{
      kPropagatorKernelBaseline, kPropagatorKernelAvx2, kPropagatorKernelAvx512}(widest_instruction_set());
  const std::size_t last = times.size() - 1;
  for (std::size_t i = 0; i < last;) {
    const double h = times[i + 1] - times[i];
    const StepMatrix* matrix = matrix_if_recurring(h);
    if (matrix == nullptr) {
      states[i + 1] = step(states[i], forces[i], h);
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    while (end < last && std::abs(times[end + 1] - times[end] - h) <= same_step_s_) ++end;
    kernel.run(matrix->data(), forces[i].data(), states[i].data(), end - i);
    i = end;
  }
}

}  // namespace crashsim
