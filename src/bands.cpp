#include "bands.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <crashsim/error.hpp>
#include <crashsim/sample_statistics.hpp>

namespace crashsim {

std::pair<double, double> interval_of(std::vector<double>& values, double level) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return {kUnset, kUnset};
  std::sort(values.begin(), values.end());
  const double outside = 0.5 * (1.0 - level);
  return {quantile_of(values, outside), quantile_of(values, 1.0 - outside)};
}

void band_of(const RowMatrix& rows, double level, std::vector<double>& low, std::vector<double>& high) {
  const auto points = static_cast<std::size_t>(rows.cols());
  low.resize(points);
  high.resize(points);
  std::vector<double> values;
  for (std::size_t i = 0; i < points; ++i) {
    const auto column = rows.col(static_cast<Eigen::Index>(i));
    values.assign(column.begin(), column.end());
    std::tie(low[i], high[i]) = interval_of(values, level);
  }
}

}  // namespace crashsim
