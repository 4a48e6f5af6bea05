#include "output_times.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {

std::vector<double> output_times(double first_s, double end_s, double dt_s, std::string_view what) {
  constexpr double kMaxSamples = 1e8;
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
