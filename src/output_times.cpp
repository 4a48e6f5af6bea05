#include "output_times.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {

void check_output_times(const std::vector<double>& times_s, std::string_view what) {
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double t = times_s[i];
    if (!std::isfinite(t) || (i > 0 ? t <= times_s[i - 1] : t < 0.0))
      throw InvalidInput(fmt::format("{}[{}] = {} s: times must be finite and increase from 0", what, i, t));
  }
  if (!times_s.empty() && times_s.back() == 0.0)
    throw InvalidInput(fmt::format("{}: the last time is the end of the run and must be > 0 s", what));
}

std::vector<double> output_times(double first_s, double end_s, double dt_s, std::string_view what) {
  constexpr double kMaxSamples = 1e7;
  constexpr double kSameMultiple = 1e-9;  // an end this near a multiple of dt is one
  const double intervals = std::max(1.0, std::ceil((end_s - first_s) / dt_s - kSameMultiple));
  if (intervals > kMaxSamples)
    throw InvalidInput(fmt::format("{} = {} s: gives {:.3g} samples, more than {:g}: take a longer one", what, dt_s,
                                   intervals, kMaxSamples));
  std::vector<double> times = uniform_times(first_s, dt_s, static_cast<std::size_t>(intervals) + 1);
  times.back() = end_s;
  return times;
}

}  // namespace crashsim
