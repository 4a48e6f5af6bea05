#include "optimize/gauss_newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Relative to the largest curvature. The first steps are short: where the motion ends early, most of the curve is out
// of sight, and a long step leads into a corner of the box.
constexpr double kFirstDamping = 3e-2, kLeastDamping = 1e-9, kMostDamping = 1e6;
constexpr double kGoodStep = 0.75, kPoorStep = 0.25;  // of the decrease that the quadratic model promised

std::span<const double> view(const VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
std::span<double> view(VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// Quadratic model of the function about a point of the box.
struct Model {
  VectorXd point, gradient;
  MatrixXd hessian;
  double value = kUnset;

  explicit Model(Index n) : point(n), gradient(n), hessian(n, n) {}

  void evaluate(const NormalEquations& function) {
    value = function(view(std::as_const(point)), view(gradient), hessian);
  }
  /// Decrease promised by a step.
  [[nodiscard]] double promise(const VectorXd& step) const {
    return -(gradient.dot(step) + 0.5 * step.dot(hessian * step));
  }
};

/// Damped step that stays in the box: what would leave it goes to its bound, and the others are solved for again.
class BoxStep {
 public:
  explicit BoxStep(Index n) : matrix_(n, n), right_(n), step_(n), free_(static_cast<std::size_t>(n)) {}

  const VectorXd& solve(const Model& model, double damping) {
    const double largest = model.hessian.diagonal().maxCoeff();
    step_.setZero();
    free_.clear();
    for (Index i = 0; i < model.point.size(); ++i) {
      const bool pushes_out =
          (model.point[i] <= 0.0 && model.gradient[i] > 0.0) || (model.point[i] >= 1.0 && model.gradient[i] < 0.0);
      if (!pushes_out && model.hessian(i, i) > 0.0) free_.push_back(i);  // what no sample depends on stays
    }
    while (!free_.empty()) {
      solve_free(model, damping * largest);
      if (!clamp_one_round(model.point)) break;
    }
    return step_;
  }

 private:
  void solve_free(const Model& model, double damping) {
    const auto m = static_cast<Index>(free_.size());
    auto matrix = matrix_.topLeftCorner(m, m);
    auto right = right_.head(m);
    for (Index a = 0; a < m; ++a) step_[free_[static_cast<std::size_t>(a)]] = 0.0;
    for (Index a = 0; a < m; ++a) {
      const Index i = free_[static_cast<std::size_t>(a)];
      right[a] = -model.gradient[i] - model.hessian.col(i).dot(step_);
      for (Index b = 0; b < m; ++b) matrix(a, b) = model.hessian(i, free_[static_cast<std::size_t>(b)]);
      matrix(a, a) += damping;
    }
    const VectorXd solved = matrix.ldlt().solve(right);
    for (Index a = 0; a < m; ++a) step_[free_[static_cast<std::size_t>(a)]] = solved[a];
  }

  /// Puts every free coordinate that would leave the box on its bound. @returns whether there was one.
  bool clamp_one_round(const VectorXd& point) {
    const std::size_t before = free_.size();
    std::erase_if(free_, [&](Index i) {
      const double to = point[i] + step_[i];
      if (to >= 0.0 && to <= 1.0) return false;
      step_[i] = (to < 0.0 ? 0.0 : 1.0) - point[i];
      return true;
    });
    return free_.size() < before;
  }

  MatrixXd matrix_;
  VectorXd right_, step_;
  std::vector<Index> free_;  ///< Coordinates that are solved for.
};

}  // namespace

Minimum minimize_by_gauss_newton(const NormalEquations& function, std::span<const double> start, double ftol_rel,
                                 int max_evaluations) {
  const auto n = static_cast<Index>(start.size());
  Model here(n), trial(n);
  here.point = Eigen::Map<const VectorXd>(start.data(), n);
  here.evaluate(function);
  Minimum best;
  best.evaluations = 1;
  BoxStep box(n);
  double damping = kFirstDamping;
  while (std::isfinite(here.value) && best.evaluations < max_evaluations && damping < kMostDamping) {
    const VectorXd& step = box.solve(here, damping);
    const double promised = here.promise(step);
    if (!(promised > 0.0)) break;
    trial.point = (here.point + step).cwiseMax(0.0).cwiseMin(1.0);
    trial.evaluate(function);
    ++best.evaluations;
    const double decrease = here.value - trial.value;
    if (!(decrease > 0.0)) {
      if (promised <= ftol_rel * here.value) break;
      damping *= 8.0;
      continue;
    }
    if (decrease > kGoodStep * promised) damping = std::max(damping / 5.0, kLeastDamping);
    if (decrease < kPoorStep * promised) damping *= 3.0;
    std::swap(here, trial);
    if (decrease <= ftol_rel * here.value && damping < kFirstDamping) break;  // not for a step that was held short
  }
  best.point.assign(here.point.begin(), here.point.end());
  best.value = here.value;
  return best;
}

}  // namespace crashsim
