#include "uncertainty_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "optimize/fisher_spectrum.hpp"

namespace crashsim {
namespace {

std::vector<std::string> names_with(const Uncertainty& uncertainty, OrdinateState state) {
  std::vector<std::string> names;
  for (const OrdinateUncertainty& ordinate : uncertainty.ordinates)
    if (ordinate.state == state) names.push_back(ordinate.name);
  return names;
}

void add_state(const Uncertainty& uncertainty, OrdinateState state, const char* what, std::string& text) {
  const std::vector<std::string> names = names_with(uncertainty, state);
  if (!names.empty()) text += fmt::format("; {}: {}", what, fmt::join(names, ", "));
}

/// Half the widest band of the total force along the tests, relative to the largest force.
double force_error(const std::vector<Band>& forces) {
  double worst = 0.0, largest = 0.0;
  for (const Band& force : forces)
    for (std::size_t i = 0; i < force.at.size(); ++i) {
      worst = std::max(worst, 0.5 * (force.high[i] - force.low[i]));
      largest = std::max(largest, std::fabs(force.value[i]));
    }
  return largest > 0.0 ? worst / largest : kUnset;
}

}  // namespace

std::string words_of(const Uncertainty& uncertainty) {
  const auto& ordinates = uncertainty.ordinates;
  Eigen::VectorXd theta(static_cast<Eigen::Index>(ordinates.size()));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ordinates.size(); ++i) {
    theta[static_cast<Eigen::Index>(i)] = ordinates[i].value;
    names.push_back(ordinates[i].name);
  }
  const Eigen::VectorXd sizes = sizes_of(theta, names);
  std::size_t determined = 0, worst = 0;
  double most = -1.0;
  for (std::size_t i = 0; i < ordinates.size(); ++i) {
    const double error = ordinates[i].standard_error / sizes[static_cast<Eigen::Index>(i)];
    if (error <= kNotDetermined) ++determined;
    if (error > most) most = error, worst = i;
  }
  std::string text = fmt::format("{} of {} ordinates are determined to {:.0f} % (standard error)", determined,
                                 ordinates.size(), 100.0 * kNotDetermined);
  if (most >= 0.0) text += fmt::format(", {} the least, to {:.2g} %", names[worst], 100.0 * most);
  if (!uncertainty.force.empty())
    text += fmt::format("; the total force along the tests to {:.2g} % of its largest (half the {:.4g} % band)",
                        100.0 * force_error(uncertainty.force), 100.0 * uncertainty.level);
  if (most > kNotDetermined && !uncertainty.spectrum.empty()) text += "; " + uncertainty.spectrum.front().words;
  add_state(uncertainty, OrdinateState::at_bound, "held at a bound", text);
  add_state(uncertainty, OrdinateState::untouched, "no sample depends on", text);
  add_state(uncertainty, OrdinateState::undetermined, "without curvature", text);
  return text;
}

}  // namespace crashsim
