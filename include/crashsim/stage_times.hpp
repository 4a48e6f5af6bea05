#pragma once
/// Where the time of a case goes.

#include <array>

#include <crashsim/named_number.hpp>

namespace crashsim {

/// Wall time of the steps of a case [s]; no part of what it writes.
struct StageTimes {
  double read_s = 0.0;      ///< Case file.
  double pulse_s = 0.0;     ///< Trace and pulse, or the model that is used.
  double identify_s = 0.0;  ///< Spring and damper.
  double simulate_s = 0.0;  ///< Crush, and its predictions.
  double pitch_s = 0.0;     ///< Heave and pitch.
  double compare_s = 0.0;   ///< Errors and ratings.
  double samples_s = 0.0;   ///< Sweep or Monte Carlo.
  double write_s = 0.0;     ///< Files.

  bool operator==(const StageTimes&) const = default;
};
inline constexpr std::array<NamedNumber<StageTimes>, 8> kStageTimes = {{
    {"read_s", &StageTimes::read_s, "case file"},
    {"pulse_s", &StageTimes::pulse_s, "trace and pulse, or model"},
    {"identify_s", &StageTimes::identify_s, "identification"},
    {"simulate_s", &StageTimes::simulate_s, "simulation"},
    {"pitch_s", &StageTimes::pitch_s, "heave and pitch"},
    {"compare_s", &StageTimes::compare_s, "comparison"},
    {"samples_s", &StageTimes::samples_s, "sweep or Monte Carlo"},
    {"write_s", &StageTimes::write_s, "writing"},
}};

}  // namespace crashsim
