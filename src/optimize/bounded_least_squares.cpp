#include "optimize/bounded_least_squares.hpp"

#include <vector>

#include <Eigen/QR>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

using Eigen::Index;

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
    if (fraction < blocking.fraction || blocking.variable < 0) blocking = {fraction, i};
  }
  return blocking;
}

}  // namespace

Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& upper) {
  const Index n = a.cols();
  // Work on the triangular factor: the same problem with n rows.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::VectorXd rhs = (qr.householderQ().transpose() * b).head(n);
  const double tolerance = 1e-12 * r.norm() * rhs.norm();

  Eigen::VectorXd p = Eigen::VectorXd::Zero(n);
  std::vector<bool> is_free(static_cast<std::size_t>(n), false);
  for (Index iteration = 0; iteration < 20 * n + 20; ++iteration) {
    // Free the variable whose bound hurts most.
    const Eigen::VectorXd descent = r.transpose() * (rhs - r * p);
    Index entering = -1;
    double best = tolerance;
    for (Index i = 0; i < n; ++i) {
      if (is_free[static_cast<std::size_t>(i)]) continue;
      const double gain = p[i] > 0.0 ? -descent[i] : descent[i];
      if (gain > best) {
        best = gain;
        entering = i;
      }
    }
    if (entering < 0) return p;
    is_free[static_cast<std::size_t>(entering)] = true;
    while (true) {
      std::vector<Index> free;
      for (Index i = 0; i < n; ++i)
        if (is_free[static_cast<std::size_t>(i)]) free.push_back(i);
      const Eigen::VectorXd solution = solve_free(r, rhs, free, p);
      const Blocking blocking = first_blocking(free, p, solution, upper);
      for (std::size_t j = 0; j < free.size(); ++j)
        p[free[j]] += blocking.fraction * (solution[static_cast<Index>(j)] - p[free[j]]);
      if (blocking.variable < 0) break;
      double& stopped = p[blocking.variable];
      stopped = stopped < 0.5 * upper[blocking.variable] ? 0.0 : upper[blocking.variable];
      is_free[static_cast<std::size_t>(blocking.variable)] = false;
    }
  }
  throw NumericalFailure("bounded least squares did not converge");
}

}  // namespace crashsim
