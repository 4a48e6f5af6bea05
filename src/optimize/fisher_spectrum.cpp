#include "optimize/fisher_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <Eigen/SVD>

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmallest = 0.1;       // size of a parameter, relative to the largest of its curve
constexpr double kShown = 0.4;          // of the largest change of a direction
constexpr double kCounter = 0.1;        // of it that one of the other sign has at least
constexpr std::size_t kMostShown = 4;   // parameters of a direction
constexpr double kLargestChange = 0.1;  // of a parameter, in words
constexpr double kMuchBetter = 0.5;     // of its own error that a sum may have to be told of

/// The curve that a parameter is of: "k" of "k3".
std::string_view curve_of(std::string_view name) { return name.substr(0, name.find_first_of("0123456789")); }

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

/// The parameters worth a word, the most changed first: those that change nearly as much, and the one that makes up
/// for them most.
std::vector<std::size_t> told_of(const std::vector<double>& change) {
  std::vector<std::size_t> order(change.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return std::fabs(change[i]); });
  const double first = change[order.front()];
  const auto share = [&](std::size_t i) { return change[i] / first; };
  const auto counter = std::ranges::find_if(order, [&](std::size_t i) { return share(i) < -kCounter; });
  std::vector<std::size_t> told;
  for (const std::size_t i : order)
    if (std::fabs(share(i)) >= kShown && told.size() < kMostShown) told.push_back(i);
  if (counter == order.end() || std::ranges::find(told, *counter) != told.end()) return told;
  if (told.size() == kMostShown) told.pop_back();
  told.push_back(*counter);
  return told;
}

/// "k3 and c5 trade off: raising k3 by 10 % and lowering c5 by 7 %".
std::string words_of(const std::vector<double>& change, const std::vector<std::string>& names) {
  const std::vector<std::size_t> told = told_of(change);
  std::vector<std::string> who, what;
  bool trades = false;
  for (const std::size_t i : told) {
    const bool is_raised = change[i] / change[told.front()] > 0.0;
    trades = trades || !is_raised;
    who.push_back(names[i]);
    what.push_back(
        fmt::format("{} {} by {:.2g} %", is_raised ? "raising" : "lowering", names[i], 100.0 * std::fabs(change[i])));
  }
  const char* how = who.size() == 1 ? "stands alone" : trades ? "trade off" : "act alike";
  return fmt::format("{} {}: {}", joined(who), how, joined(what));
}

}  // namespace

VectorXd sizes_of(const VectorXd& theta, const std::vector<std::string>& names) {
  VectorXd sizes = theta.cwiseAbs();
  for (Index i = 0; i < sizes.size(); ++i) {
    double largest = 0.0;
    for (Index j = 0; j < sizes.size(); ++j)
      if (curve_of(names[static_cast<std::size_t>(j)]) == curve_of(names[static_cast<std::size_t>(i)]))
        largest = std::max(largest, std::fabs(theta[j]));
    sizes[i] = std::max(sizes[i], largest > 0.0 ? kSmallest * largest : 1.0);
  }
  return sizes;
}

std::vector<FisherDirection> fisher_spectrum(const LinearFit& fit, const MatrixXd& covariance,
                                             const std::vector<std::string>& names, double error) {
  const VectorXd sizes = sizes_of(fit.theta, names);
  std::vector<Index> free;
  for (Index i = 0; i < sizes.size(); ++i)
    if (fit.is_free[static_cast<std::size_t>(i)]) free.push_back(i);
  if (free.empty()) return {};
  MatrixXd columns(fit.rows.rows(), static_cast<Index>(free.size()));
  for (std::size_t j = 0; j < free.size(); ++j)
    columns.col(static_cast<Index>(j)) = fit.rows.col(free[j]) * sizes[free[j]];
  const Eigen::JacobiSVD<MatrixXd> svd(columns, Eigen::ComputeThinV);
  const VectorXd& sigma = svd.singularValues();
  std::vector<FisherDirection> spectrum;
  for (Index k = sigma.size(); k-- > 0;) {
    const VectorXd direction = svd.matrixV().col(k);
    FisherDirection& out = spectrum.emplace_back();
    out.singular_value = sigma[k] / sigma[0];
    out.change.assign(names.size(), 0.0);
    const double scale = kLargestChange / direction.cwiseAbs().maxCoeff();
    double variance = 0.0;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto a = static_cast<Index>(i);
      out.change[static_cast<std::size_t>(free[i])] = scale * direction[a];
      for (std::size_t j = 0; j < free.size(); ++j)
        variance += direction[a] * direction[static_cast<Index>(j)] * covariance(free[i], free[j]) /
                    (sizes[free[i]] * sizes[free[j]]);
    }
    out.relative_error = std::sqrt(variance);
    out.error_change = scale * scale * sigma[k] * sigma[k] / static_cast<double>(fit.targets.size());
    out.words = fmt::format("{} changes E by {:.2g} %", words_of(out.change, names), 100.0 * out.error_change / error);
  }
  return spectrum;
}

std::vector<std::string> determined_sums(const LinearFit& fit, const MatrixXd& covariance,
                                         const std::vector<std::string>& names) {
  const VectorXd sizes = sizes_of(fit.theta, names);
  std::vector<std::string> sums;
  std::vector<bool> is_told(names.size(), false);
  for (Index i = 0; i < sizes.size(); ++i) {
    const double variance = covariance(i, i), own = std::sqrt(variance) / sizes[i];
    if (!(own > kNotDetermined) || is_told[static_cast<std::size_t>(i)]) continue;
    Index best = -1;
    double least = variance;
    for (Index j = 0; j < sizes.size(); ++j) {
      const double rest = variance - covariance(i, j) * covariance(i, j) / covariance(j, j);
      if (j == i || !(covariance(j, j) > 0.0) || !(rest < least)) continue;
      best = j;
      least = rest;
    }
    if (best < 0) continue;
    const double factor = -covariance(i, best) / covariance(best, best);
    const double sum = fit.theta[i] + factor * fit.theta[best],
                 within = std::sqrt(std::max(0.0, least)) / std::fabs(sum);
    if (!(within < kMuchBetter * own)) continue;
    is_told[static_cast<std::size_t>(best)] = true;
    const auto name = [&](Index at) { return names[static_cast<std::size_t>(at)]; };
    sums.push_back(fmt::format("{} {} {:.3g} {} is known to {:.2g} % (standard error), {} alone to {:.2g} %", name(i),
                               factor < 0.0 ? "-" : "+", std::fabs(factor), name(best), 100.0 * within, name(i),
                               100.0 * own));
  }
  return sums;
}

}  // namespace crashsim
