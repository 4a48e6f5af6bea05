#pragma once
/// Samples of one quantity over time.

#include <vector>

namespace crashsim {

/// A quantity known at some times and linear between them.
struct TimeSeries {
  std::vector<double> time_s;  ///< Strictly increasing [s].
  std::vector<double> values;  ///< As many as times [SI].

  [[nodiscard]] bool empty() const { return time_s.empty() && values.empty(); }
};

}  // namespace crashsim
