#include "optimize/smoothing_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "optimize/bounded_least_squares.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

constexpr double kUnseen = 1e-8;      // sine or cosine below which data or roughness say nothing of a direction
constexpr double kMargin = 100.0;     // of the range of weights, beyond those at which any direction turns
constexpr int kPerDecade = 8;         // weights tried
constexpr double kRefinement = 1e-6;  // of ln weight
constexpr double kGolden = 0.61803398874989485;

/// The samples in as few rows as there are ordinates, and one for what these cannot follow.
struct Reduced {
  Eigen::MatrixXd rows, roughness;
  Eigen::VectorXd rhs;
  double samples;
};

Reduced reduce(const EquationErrorSystem& system) {
  Eigen::MatrixXd both(system.rows.rows(), system.rows.cols() + 1);
  both << system.rows, system.rhs;
  const Index kept = std::min(both.rows(), both.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(both);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
  return {r.leftCols(system.rows.cols()), system.roughness, r.rightCols(1), static_cast<double>(system.rows.rows())};
}

/// |A p - b|^2 and |R p - d|^2 at the p that makes |A p - b|^2 + s |R p - d|^2 least, in the basis that makes both
/// matrices diagonal, A = U C X, R = V S X with C^2 + S^2 = 1 (their generalised singular values):
///     |A p - b|^2 = residual + sum s^2 S^2 w^2 / (C^2 + s S^2)^2,
///     |R p - d|^2 = roughness + sum C^2 w^2 / (C^2 + s S^2)^2,   w = S U'b - C V'd
struct Spectrum {
  Eigen::ArrayXd cosine, sine, w;
  double residual = 0.0, roughness = 0.0;  ///< What no weight changes.
};

Spectrum decompose(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::MatrixXd& r,
                   const Eigen::VectorXd& d) {
  Eigen::MatrixXd stacked(a.rows() + r.rows(), a.cols());
  stacked << a, r;
  const Eigen::JacobiSVD<Eigen::MatrixXd> whole(stacked, Eigen::ComputeThinU);
  const Eigen::MatrixXd q = whole.matrixU().leftCols(whole.rank());
  const Eigen::JacobiSVD<Eigen::MatrixXd> data(q.topRows(a.rows()), Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::MatrixXd bent = q.bottomRows(r.rows()) * data.matrixV();
  Spectrum out;
  out.cosine = data.singularValues().array();
  out.sine = bent.colwise().norm().transpose().array();
  const Eigen::ArrayXd along_data = (data.matrixU().transpose() * b).array();
  const Eigen::ArrayXd along_roughness =
      (out.sine > kUnseen).select((bent.transpose() * d).array() / out.sine.max(kUnseen), 0.0);
  out.w = out.sine * along_data - out.cosine * along_roughness;
  out.residual = std::max(0.0, b.squaredNorm() - along_data.square().sum());
  out.roughness = std::max(0.0, d.squaredNorm() - along_roughness.square().sum());
  return out;
}

/// How the ordinates stand to their bounds.
enum class Place : char { free, lower, upper };
using Places = std::vector<Place>;

/// The criterion as a function of the weight.
class Criterion {
 public:
  Criterion(const EquationErrorSystem& system, Eigen::VectorXd upper, Smoothing rule, double inflation)
      : small_(reduce(system)), upper_(std::move(upper)), rule_(rule), inflation_(inflation) {
    const double size = small_.roughness.norm();
    balance_ = size > 0.0 ? small_.rows.norm() / size : 1.0;
    small_.roughness *= balance_;
  }

  /// Smallest and largest weight at which anything changes; both 0 when nothing does.
  [[nodiscard]] std::pair<double, double> range() {
    const Spectrum& all = spectrum(Places(static_cast<std::size_t>(upper_.size()), Place::free));
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (Index i = 0; i < all.cosine.size(); ++i) {
      if (all.sine[i] <= kUnseen || all.cosine[i] <= kUnseen) continue;
      const double turn = all.cosine[i] * all.cosine[i] / (all.sine[i] * all.sine[i]);
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    if (high == 0.0) return {0.0, 0.0};
    const double scale = balance_ * balance_;
    return {low / kMargin * scale, high * kMargin * scale};
  }

  /// With what it says there.
  SmoothingChoice at(double smooth) {
    const double s = smooth / (balance_ * balance_);
    const Spectrum& x = spectrum(places_at(s));
    const Eigen::ArrayXd c2 = x.cosine.square(), s2 = x.sine.square(), both = (c2 + s * s2).max(kUnseen * kUnseen);
    SmoothingChoice out;
    out.smooth = smooth;
    out.freedom = (c2 / both).sum();
    out.residual = x.residual + (s * s * s2 * (x.w / both).square()).sum();
    const double roughness = x.roughness + (c2 * (x.w / both).square()).sum();
    out.roughness = roughness / (balance_ * balance_);
    if (rule_ == Smoothing::gcv) {
      const double left = small_.samples - inflation_ * out.freedom;
      out.criterion = left > 0.0 ? small_.samples * out.residual / (left * left) : kUnset;
    } else {
      out.criterion = curvature(x, s, out.residual, roughness);
    }
    return out;
  }

  /// Larger is better; the worst where the criterion does not exist.
  [[nodiscard]] double merit(const SmoothingChoice& choice) const {
    if (std::isnan(choice.criterion)) return -std::numeric_limits<double>::infinity();
    return rule_ == Smoothing::gcv ? -choice.criterion : choice.criterion;
  }

 private:
  Places places_at(double s) const {
    Eigen::MatrixXd a(small_.rows.rows() + small_.roughness.rows(), small_.rows.cols());
    a << small_.rows, std::sqrt(s) * small_.roughness;
    Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
    b.head(small_.rhs.size()) = small_.rhs;
    const Eigen::VectorXd p = bounded_least_squares(a, b, upper_);
    Places places(static_cast<std::size_t>(p.size()), Place::free);
    for (Index i = 0; i < p.size(); ++i) {
      if (p[i] <= 0.0) places[static_cast<std::size_t>(i)] = Place::lower;
      if (p[i] >= upper_[i]) places[static_cast<std::size_t>(i)] = Place::upper;
    }
    return places;
  }

  const Spectrum& spectrum(const Places& places) {
    const auto known = spectra_.find(places);
    if (known != spectra_.end()) return known->second;
    std::vector<Index> free;
    Eigen::VectorXd held = Eigen::VectorXd::Zero(upper_.size());
    for (Index i = 0; i < upper_.size(); ++i) {
      if (places[static_cast<std::size_t>(i)] == Place::free) free.push_back(i);
      if (places[static_cast<std::size_t>(i)] == Place::upper) held[i] = upper_[i];
    }
    const Eigen::MatrixXd a = small_.rows(Eigen::all, free), r = small_.roughness(Eigen::all, free);
    return spectra_.emplace(places, decompose(a, small_.rhs - small_.rows * held, r, -(small_.roughness * held)))
        .first->second;
  }

  /// Of (ln residual, ln roughness) along ln s: x' y'' - x'' y' over (x'^2 + y'^2)^(3/2).
  static double curvature(const Spectrum& spectrum, double s, double residual, double roughness) {
    const Eigen::ArrayXd c2 = spectrum.cosine.square(), s2 = spectrum.sine.square(), both = c2 + s * s2;
    const Eigen::ArrayXd part = c2 * s2 * spectrum.w.square() / both.cube();
    const double first = -2.0 * part.sum(), second = 6.0 * (part * s2 / both).sum();  // of the roughness by s
    const double x1 = -s * s * first / residual;
    const double x2 = -s * s * (2.0 * first + s * second) / residual - x1 * x1;
    const double y1 = s * first / roughness, y2 = s * (first + s * second) / roughness - y1 * y1;
    const double speed = std::hypot(x1, y1);
    return speed > 0.0 ? (x1 * y2 - x2 * y1) / (speed * speed * speed) : kUnset;
  }

  Reduced small_;
  Eigen::VectorXd upper_;
  Smoothing rule_;
  double inflation_, balance_ = 1.0;  ///< Roughness is scaled by this, to the size of the rows.
  std::map<Places, Spectrum> spectra_;
};

/// Golden section between two weights; the better of what it finds and `best`.
SmoothingChoice refine(Criterion& criterion, double low, double high, SmoothingChoice best) {
  double a = std::log(low), b = std::log(high);
  double left = b - kGolden * (b - a), right = a + kGolden * (b - a);
  SmoothingChoice at_left = criterion.at(std::exp(left)), at_right = criterion.at(std::exp(right));
  while (b - a > kRefinement) {
    const bool goes_left = criterion.merit(at_left) >= criterion.merit(at_right);
    const SmoothingChoice& better = goes_left ? at_left : at_right;
    if (criterion.merit(better) > criterion.merit(best)) best = better;
    if (goes_left) {
      b = right;
      right = left;
      at_right = at_left;
      left = b - kGolden * (b - a);
      at_left = criterion.at(std::exp(left));
    } else {
      a = left;
      left = right;
      at_left = at_right;
      right = a + kGolden * (b - a);
      at_right = criterion.at(std::exp(right));
    }
  }
  return best;
}

/// Index of the best weight. The L-curve's end, where it stops at the fit without smoothing, is no corner, however much
/// the curve bends there: without a corner inside, the smallest weight.
int best_of(const Criterion& criterion, Smoothing rule, const std::vector<SmoothingChoice>& tried) {
  const auto merit = [&](std::size_t i) { return criterion.merit(tried[i]); };
  std::size_t best = 0;
  double best_merit = rule == Smoothing::gcv ? merit(0) : 0.0;
  for (std::size_t i = 1; i < tried.size(); ++i) {
    const bool is_peak = i + 1 < tried.size() && merit(i) > merit(i - 1) && merit(i) > merit(i + 1);
    if ((rule == Smoothing::l_curve && !is_peak) || merit(i) <= best_merit) continue;
    best = i;
    best_merit = merit(i);
  }
  return static_cast<int>(best);
}

}  // namespace

SmoothingChoice choose_smoothing(const EquationErrorSystem& system, const Eigen::VectorXd& upper, Smoothing rule,
                                 double inflation) {
  Criterion criterion(system, upper, rule, inflation);
  const auto [low, high] = criterion.range();
  if (high == 0.0) {
    SmoothingChoice none = criterion.at(0.0);
    none.criterion = kUnset;
    return none;
  }
  const int count = 1 + static_cast<int>(std::ceil(kPerDecade * std::log10(high / low)));
  const auto weight = [&](int i) { return low * std::pow(high / low, static_cast<double>(i) / (count - 1)); };
  std::vector<SmoothingChoice> tried;
  for (int i = 0; i < count; ++i) tried.push_back(criterion.at(weight(i)));
  const int best = best_of(criterion, rule, tried);
  SmoothingChoice out = tried[static_cast<std::size_t>(best)];
  out.at_edge = best == 0 || best == count - 1;
  return out.at_edge ? out : refine(criterion, weight(best - 1), weight(best + 1), out);
}

}  // namespace crashsim
