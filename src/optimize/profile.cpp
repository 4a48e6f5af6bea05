#include "optimize/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "optimize/gauss_newton.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kFtol = 1e-10;             // of the sum of squares; its rises are chi^2 / n of it and more
constexpr int kMaxEvaluations = 60;         // of a minimum
constexpr int kMaxPoints = 24;              // of a side
constexpr double kThresholdReached = 1e-2;  // relative to the threshold
constexpr double kLongestStride = 2.0;      // times as far as the point before

/// Minima of the squared objective with one parameter held, each from where the last one ended. Points of the unit box.
class HeldMinimum {
 public:
  HeldMinimum(const FitStudy& study, const LinearFit& fit, std::size_t held)
      : upper_(study.upper),
        held_(static_cast<Index>(held)),
        objective_(study.structure, fit.targets, Loss::l2, study.smooth, study.prior),
        tests_(static_cast<double>(fit.targets.size())),
        point_(static_cast<std::size_t>(fit.theta.size())),
        parameters_(point_.size()) {
    for (std::size_t i = 0; i < point_.size(); ++i)
      point_[i] = std::clamp(fit.theta[static_cast<Index>(i)] / upper_[static_cast<Index>(i)], 0.0, 1.0);
  }

  /// Sum of squares; infinite when the simulations fail.
  double at(double parameter) {
    point_[static_cast<std::size_t>(held_)] = parameter / upper_[held_];
    return minimize(true);
  }
  double free_minimum() { return minimize(false); }
  [[nodiscard]] double parameter() const { return point_[static_cast<std::size_t>(held_)] * upper_[held_]; }

 private:
  double minimize(bool is_held) {
    const NormalEquations function = [&](std::span<const double> point, std::span<double> gradient,
                                         Eigen::MatrixXd& hessian) {
      for (std::size_t i = 0; i < point.size(); ++i) parameters_[i] = point[i] * upper_[static_cast<Index>(i)];
      const double value = objective_.normal_equations(parameters_, 0.0, gradient, hessian);
      for (std::size_t i = 0; i < point.size(); ++i) gradient[i] *= upper_[static_cast<Index>(i)];
      hessian = upper_.asDiagonal() * hessian * upper_.asDiagonal();
      if (is_held) {  // no curvature: it stays
        gradient[static_cast<std::size_t>(held_)] = 0.0;
        hessian.row(held_).setZero();
        hessian.col(held_).setZero();
      }
      return value;
    };
    const Minimum minimum = minimize_by_gauss_newton(function, point_, kFtol, kMaxEvaluations);
    point_ = minimum.point;
    return tests_ * minimum.value;  // E is the targets' mean
  }

  const VectorXd& upper_;
  Index held_;
  FitObjective objective_;
  double tests_;
  std::vector<double> point_, parameters_;
};

/// Where a side ends, and whether that is the bound.
struct End {
  double at = kUnset;
  bool is_open = false;
};

/// Steps from the best towards a bound until the rise reaches the threshold; its root is nearly linear in the
/// parameter.
End walk_side(HeldMinimum& minimum, double best, double least, double scale, double step, double bound,
              double threshold, const std::function<bool()>& go_on, Profile& out) {
  double inside = best, inside_root = 0.0, outside = bound, outside_root = kUnset;
  const double target = std::sqrt(threshold);
  double next = best + step;
  for (int i = 0; i < kMaxPoints && go_on(); ++i) {
    next = step > 0.0 ? std::min(next, bound) : std::max(next, bound);
    const double rise = std::max(0.0, scale * (minimum.at(next) - least)), root = std::sqrt(rise);
    if (!std::isfinite(rise)) return {};
    out.at.push_back(next);
    out.rise.push_back(rise);
    if (std::fabs(rise - threshold) <= kThresholdReached * threshold) {
      const double share = root > inside_root ? (target - inside_root) / (root - inside_root) : 1.0;
      return {inside + share * (next - inside), false};
    }
    if (rise < threshold) {
      if (next == bound) return {bound, true};
      inside = next;
      inside_root = root;
    } else {
      outside = next;
      outside_root = root;
    }
    if (!std::isnan(outside_root)) {
      next = inside + (outside - inside) * (target - inside_root) / (outside_root - inside_root);
    } else {
      const double reach = root > 0.0 ? (next - best) * (target / root) : kLongestStride * (next - best);
      const double far = kLongestStride * (next - best);
      next = best + (std::fabs(reach) < std::fabs(far) ? reach : far);
    }
  }
  return {};
}

void sort_points(Profile& profile) {
  std::vector<std::size_t> order(profile.at.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return profile.at[i]; });
  Profile sorted = profile;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.at[i] = profile.at[order[i]];
    sorted.rise[i] = profile.rise[order[i]];
  }
  profile = std::move(sorted);
}

}  // namespace

Profile profile_of(const FitStudy& study, const LinearFit& fit, std::size_t index, double scale, double deviation,
                   double threshold, const std::function<bool()>& go_on) {
  HeldMinimum minimum(study, fit, index);
  Profile profile;
  const double least = minimum.free_minimum(), best = minimum.parameter();
  if (!std::isfinite(least)) return profile;
  profile.at.push_back(best);
  profile.rise.push_back(0.0);
  const double upper = study.upper[static_cast<Index>(index)], step = std::sqrt(threshold) * deviation;
  HeldMinimum downwards = minimum;
  End low{0.0, true}, high{upper, true};
  if (best > 0.0) low = walk_side(downwards, best, least, scale, -step, 0.0, threshold, go_on, profile);
  if (best < upper) high = walk_side(minimum, best, least, scale, step, upper, threshold, go_on, profile);
  profile.low = low.at;
  profile.low_open = low.is_open;
  profile.high = high.at;
  profile.high_open = high.is_open;
  sort_points(profile);
  return profile;
}

}  // namespace crashsim
