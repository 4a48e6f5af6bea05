#include "optimize/bounded_least_squares.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/QR>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

using Eigen::Index;

constexpr double kStationary = 1e-12;  // descent along a unit column, relative to the right-hand side

/// Unconstrained solution in the free columns, the others held at p.
Eigen::VectorXd solve_free(const Eigen::MatrixXd& r, const Eigen::VectorXd& rhs, const std::vector<Index>& free,
                           const Eigen::VectorXd& p) {
  Eigen::MatrixXd columns(r.rows(), static_cast<Index>(free.size()));
  Eigen::VectorXd remainder = rhs - r * p;
  for (Index j = 0; j < columns.cols(); ++j) {
    columns.col(j) = r.col(free[static_cast<std::size_t>(j)]);
    remainder += columns.col(j) * p[free[static_cast<std::size_t>(j)]];
  }
  return columns.colPivHouseholderQr().solve(remainder);
}

/// Largest fraction of the way to `solution` that stays inside the bounds, and the variable that stops it (-1: none).
struct Blocking {
  double fraction = 1.0;
  Index variable = -1;
  bool at_upper = false;
};
Blocking first_blocking(const std::vector<Index>& free, const Eigen::VectorXd& p, const Eigen::VectorXd& solution,
                        const Eigen::VectorXd& upper) {
  Blocking blocking;
  for (std::size_t j = 0; j < free.size(); ++j) {
    const Index i = free[j];
    const double target = solution[static_cast<Index>(j)];
    if (target >= 0.0 && target <= upper[i]) continue;
    const double bound = target < 0.0 ? 0.0 : upper[i];
    const double fraction = (bound - p[i]) / (target - p[i]);
    if (fraction < blocking.fraction || blocking.variable < 0) blocking = {fraction, i, target > 0.0};
  }
  return blocking;
}

/// Bound variable whose release lowers the residual fastest, -1: none by more than the tolerance.
Index most_improving(const Eigen::VectorXd& descent, const Eigen::VectorXd& p, const std::vector<bool>& is_free,
                     const std::vector<bool>& is_refused, double tolerance) {
  Index entering = -1;
  double best = tolerance;
  for (Index i = 0; i < p.size(); ++i) {
    if (is_free[static_cast<std::size_t>(i)] || is_refused[static_cast<std::size_t>(i)]) continue;
    const double gain = p[i] > 0.0 ? -descent[i] : descent[i];
    if (gain > best) {
      best = gain;
      entering = i;
    }
  }
  return entering;
}

/// Moves the free variables towards their unconstrained minimum; those that meet a bound stop there.
void minimise_free(const Eigen::MatrixXd& r, const Eigen::VectorXd& rhs, const Eigen::VectorXd& upper,
                   std::vector<bool>& is_free, Eigen::VectorXd& p) {
  while (true) {
    std::vector<Index> free;
    for (Index i = 0; i < p.size(); ++i)
      if (is_free[static_cast<std::size_t>(i)]) free.push_back(i);
    if (free.empty()) return;
    const Eigen::VectorXd solution = solve_free(r, rhs, free, p);
    const Blocking blocking = first_blocking(free, p, solution, upper);
    for (std::size_t j = 0; j < free.size(); ++j) {
      const Index i = free[j];
      p[i] = std::clamp(p[i] + blocking.fraction * (solution[static_cast<Index>(j)] - p[i]), 0.0, upper[i]);
    }
    if (blocking.variable < 0) return;
    p[blocking.variable] = blocking.at_upper ? upper[blocking.variable] : 0.0;
    is_free[static_cast<std::size_t>(blocking.variable)] = false;
  }
}

/// The active-set iteration for columns of unit length.
Eigen::VectorXd solve_scaled(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& upper) {
  const Index n = a.cols(), rows = std::min(a.rows(), n);
  // Work on the triangular factor: the same problem with n rows.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  const Eigen::VectorXd rhs = (qr.householderQ().transpose() * b).head(rows);
  const double tolerance = kStationary * rhs.norm();

  Eigen::VectorXd p = Eigen::VectorXd::Zero(n);
  double residual = rhs.norm();
  std::vector<bool> is_free(static_cast<std::size_t>(n), false), is_refused(static_cast<std::size_t>(n), false);
  for (Index iteration = 0; iteration < 20 * n + 20; ++iteration) {
    const Index entering = most_improving(r.transpose() * (rhs - r * p), p, is_free, is_refused, tolerance);
    if (entering < 0) return p;
    is_free[static_cast<std::size_t>(entering)] = true;
    const Eigen::VectorXd before = p;
    const std::vector<bool> free_before = is_free;
    minimise_free(r, rhs, upper, is_free, p);
    const double now = (rhs - r * p).norm();
    if (now < residual) {
      residual = now;
      is_refused.assign(is_refused.size(), false);
    } else {  // rounding alone made it look useful: columns nearly dependent
      p = before;
      is_free = free_before;
      is_free[static_cast<std::size_t>(entering)] = false;
      is_refused[static_cast<std::size_t>(entering)] = true;
    }
  }
  throw NumericalFailure("bounded least squares did not converge");
}

}  // namespace

Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& upper) {
  // Columns of unit length, so that tolerances mean the same for each.
  Eigen::VectorXd norms = a.colwise().norm().transpose();
  for (double& norm : norms)
    if (norm == 0.0) norm = 1.0;
  const Eigen::VectorXd bound = upper.cwiseProduct(norms);
  const Eigen::VectorXd scaled = solve_scaled(a * norms.cwiseInverse().asDiagonal(), b, bound);
  return (scaled.array() < bound.array()).select(scaled.cwiseQuotient(norms).cwiseMin(upper), upper);
}

}  // namespace crashsim
