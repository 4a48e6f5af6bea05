#include "optimize/parameter_verdict.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "optimize/identifiability.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

constexpr double kWellConditioned = 50.0;  // as for ordinates of a crush model
constexpr double kNarrow = 0.1;            // standard error, relative to the way between the bounds
constexpr double kAtBound = 1e-6;          // of that way
constexpr double kTakesPart = 0.2;         // of the largest share in the weakest combination

/// The combination of parameters that the fit hardly depends on, as changes relative to the values: "front_axle_m
/// by +1 %, rear_axle_m by -0.62 %".
std::string weakest_combination(std::span<const SoughtRange> parameters, std::span<const double> values,
                                const ColumnAnalysis& analysis) {
  const double largest_share = analysis.weakest.cwiseAbs().maxCoeff();
  std::vector<std::pair<std::size_t, double>> changes;
  double largest = 0.0;
  for (std::size_t j = 0; j < analysis.determined.size(); ++j) {
    const double share = analysis.weakest[static_cast<Index>(j)];
    if (std::fabs(share) < kTakesPart * largest_share) continue;
    const std::size_t i = analysis.determined[j];
    const double size = values[i] != 0.0 ? std::fabs(values[i]) : parameters[i].upper - parameters[i].lower;
    changes.emplace_back(i, share / analysis.norms[static_cast<Index>(j)] / size);
    if (std::fabs(changes.back().second) > std::fabs(largest)) largest = changes.back().second;
  }
  std::vector<std::string> texts;
  for (const auto& [i, change] : changes)
    texts.push_back(fmt::format("{} by {:+.2g} %{}", parameters[i].name, change / largest,
                                values[i] != 0.0 ? "" : " of its range"));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string explain(std::span<const SoughtRange> parameters, std::span<const double> values,
                    const ParameterVerdict& judged, const ColumnAnalysis& analysis,
                    const std::vector<std::string>& vague) {
  const Verdict& verdict = judged.verdict;
  const std::string numbers =
      fmt::format("rank {} of {}, condition {:.3g}", verdict.rank, analysis.determined.size(), verdict.condition);
  std::vector<std::string> texts;
  if (verdict.identifiable)
    texts.push_back(fmt::format("every parameter is determined ({})", numbers));
  else if (!analysis.has_full_rank() || verdict.condition > kWellConditioned)
    texts.push_back(
        fmt::format("the parameters {} be told apart ({}): changing {} together leaves the fit nearly as it "
                    "is; fix one of them, or give more channels or a longer record",
                    analysis.has_full_rank() ? "can hardly" : "cannot", numbers,
                    weakest_combination(parameters, values, analysis)));
  else
    texts.push_back(fmt::format("not every parameter is determined ({})", numbers));
  if (!vague.empty())
    texts.push_back(
        fmt::format("the data leave {} open: a standard error of more than a tenth of the way between the "
                    "bounds",
                    fmt::join(vague, ", ")));
  for (const ParameterReport& report : judged.parameters)
    if (report.untouched) texts.push_back(fmt::format("no sample depends on {}", report.name));
  return fmt::format("{}", fmt::join(texts, "; "));
}

ParameterReport describe(const SoughtRange& parameter, double value, bool touched, double standard_error) {
  ParameterReport report;
  report.name = parameter.name;
  report.unit = parameter.unit;
  report.value = value;
  report.standard_error = standard_error;
  report.lower_bound = parameter.lower;
  report.upper_bound = parameter.upper;
  report.untouched = !touched;
  const double place = parameter.place_of(value);
  report.at_bound = place <= kAtBound || place >= 1.0 - kAtBound;
  return report;
}

}  // namespace

ParameterVerdict judge_parameters(std::span<const SoughtRange> parameters, std::span<const double> values,
                                  const Eigen::MatrixXd& jacobian, double residual_variance) {
  Eigen::VectorXd sizes(static_cast<Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) sizes[static_cast<Index>(i)] = parameters[i].slope_at(values[i]);
  const std::vector<bool> touched = touched_columns(jacobian, sizes);
  const ColumnAnalysis analysis = analyse_columns(jacobian, sizes);
  ParameterErrors errors = errors_of(analysis, residual_variance);
  ParameterVerdict out;
  std::vector<std::string> vague;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double error = errors.standard_errors[i];
    out.parameters.push_back(describe(parameters[i], values[i], touched[i], error));
    if (error > kNarrow * sizes[static_cast<Index>(i)]) vague.push_back(out.parameters.back().name);
  }
  out.correlation = std::move(errors.correlation);
  if (analysis.determined.empty()) {
    out.verdict.message = "no sample depends on any parameter";
    return out;
  }
  out.verdict.rank = analysis.rank;
  out.verdict.condition = analysis.condition;
  out.verdict.identifiable = analysis.has_full_rank() && analysis.determined.size() == parameters.size() &&
                             analysis.condition <= kWellConditioned && vague.empty();
  out.verdict.message = explain(parameters, values, out, analysis, vague);
  return out;
}

void warn_at_bounds(std::span<const ParameterReport> parameters, std::vector<std::string>& warnings) {
  for (const ParameterReport& parameter : parameters)
    if (parameter.at_bound && !parameter.untouched)
      warnings.push_back(fmt::format("{} = {:.6g} {} is at its bound: the best value may lie beyond it", parameter.name,
                                     parameter.value, parameter.unit));
}

}  // namespace crashsim
