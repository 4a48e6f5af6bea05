#include "named_fit.hpp"

#include <algorithm>
#include <cmath>

namespace crashsim::cli {

Summary without_numbers(Summary summary, const std::vector<ParameterReport>& parameters) {
  std::erase_if(summary, [&](const SummaryItem& item) {
    return std::ranges::find(parameters, item.name, &ParameterReport::name) != parameters.end();
  });
  return summary;
}

std::vector<std::string> table_of(const std::vector<ParameterReport>& parameters) {
  std::vector<std::string> lines = {
      fmt::format("  {:<26} {:>12} {:>12} {:>12} {:>12}", "", "value", "std. error", "lower bound", "upper bound")};
  for (const ParameterReport& p : parameters)
    lines.push_back(fmt::format("  {:<26} {:>12.6g} {:>12} {:>12.4g} {:>12.4g}{}{}", p.name, p.value,
                                std::isnan(p.standard_error) ? "-" : fmt::format("{:.3g}", p.standard_error),
                                p.lower_bound, p.upper_bound, p.at_bound ? "  at bound" : "",
                                p.untouched ? "  no sample depends on it" : ""));
  return lines;
}

}  // namespace crashsim::cli
