#pragma once
/// The crash pulse: the vehicle's longitudinal motion from impact, made from raw channels.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// Where time zero is: the trace's own, found from the signal, or given [s on the trace's clock].
enum class TimeZero { trace, automatic, given };
inline constexpr std::string_view kTimeZeroNames[] = {"trace", "auto", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<TimeZero>{kTimeZeroNames};

/// What offset is taken off: the mean before impact (where samples exist), none, or the mean over a window [s, s].
enum class Bias { pre_impact, none, given };
inline constexpr std::string_view kBiasNames[] = {"pre_impact", "none", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Bias>{kBiasNames};

/// How a pulse is made from raw channels.
struct PulseOptions {
  std::vector<std::string> channels;  ///< Selectors; several are averaged. Empty: the file's compartment channels.
  double cfc = 60.0;                  ///< Channel frequency class [Hz]; 0: no filter.
  CfcStandard cfc_standard = CfcStandard::j211;
  Setting<Bias> bias;
  Setting<TimeZero> t0;
  double mass_kg = kUnset;           ///< Test mass [kg]; unset: the file's, if it says it.
  double impact_speed_mps = kUnset;  ///< Speed at time zero [m/s]; unset: the file's.
  std::string columns, units;        ///< As in ReadOptions.

  bool operator==(const PulseOptions&) const = default;
};
inline constexpr std::array<Field<PulseOptions>, 9> kPulseFields = {{
    {"channels", "channel", "", "channel to use: number, name, code or glob; several are averaged",
     &PulseOptions::channels},
    {"cfc", "cfc", "Hz", "channel frequency class of the filter; 0 for none", &PulseOptions::cfc, at_least(0.0)},
    {"cfc_standard", "cfc-standard", "", "definition of the filter", choice<&PulseOptions::cfc_standard>()},
    {"bias", "bias", "s", "offset taken off: mean before impact, none, or mean over a window",
     setting<&PulseOptions::bias>()},
    {"t0", "t0", "s", "time zero: the trace's own, found (first 5 g walked back to 0.5 g), or a time",
     setting<&PulseOptions::t0>()},
    {"mass_kg", "mass", "kg", "test mass; default: the file's", &PulseOptions::mass_kg, positive()},
    {"impact_speed_mps", "speed", "m/s", "impact speed; default: the file's", &PulseOptions::impact_speed_mps,
     positive()},
    {"columns", "columns", "", "columns of a CSV file: time:ms,accel:g", &PulseOptions::columns},
    {"units", "units", "", "unit system of FE output: kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms", &PulseOptions::units},
}};
template <>
inline constexpr std::span<const Field<PulseOptions>> fields<PulseOptions>{kPulseFields};

/// Longitudinal motion from time zero on: crush positive, acceleration negative while the vehicle decelerates.
struct Pulse {
  std::vector<double> time_s;          ///< From 0, uniform.
  std::vector<double> accel_mps2;      ///< dv/dt [m/s^2].
  std::vector<double> velocity_mps;    ///< Starts at the impact speed [m/s].
  std::vector<double> displacement_m;  ///< Starts at 0 [m].
  double mass_kg = kUnset;             ///< Test mass [kg], unset when unknown.
  double impact_speed_mps = kUnset;    ///< Speed at time zero [m/s].
  double t_m_s = kUnset;               ///< Time of maximum crush: first zero of v, between samples [s]; unset: none.
  double max_crush_m = kUnset;         ///< Displacement at t_m [m].
  double time_zero_s = 0.0;            ///< Time zero on the clock of the trace it was made from [s].
  std::vector<std::string> channels;   ///< What it was made from: "93 LEFT REAR SEAT CROSSMEMBER X".
  std::vector<std::string> steps;      ///< What was done, in order.
  std::vector<std::string> warnings;   ///< What looked unusual.
  std::vector<std::string> input_files;
};

/// Makes a pulse from a deceleration that starts at impact; velocity and displacement by trapezoids.
/// @param time_s sample times [s], uniform when `cfc` > 0.
/// @param accel_mps2 acceleration [m/s^2], negative while decelerating.
/// @throws InvalidInput on bad series, speed or mass.
Pulse make_pulse(std::span<const double> time_s, std::span<const double> accel_mps2, double impact_speed_mps,
                 double mass_kg = kUnset, double cfc = 0.0);

/// Makes a pulse from traces, by the steps of `options`. Velocity channels are filtered, then differentiated.
/// @throws InvalidInput naming the channel and the rule it breaks.
Pulse make_pulse(const TraceSet& traces, const PulseOptions& options = {});

/// read_traces() and make_pulse(); a `pulse.csv` of our own comes back as it was written.
Pulse read_pulse(const std::string& path, const PulseOptions& options = {});

/// Time of maximum crush and crush there for sampled motion with piecewise-linear acceleration: first zero of v after
/// the start, between samples. {kUnset, kUnset} when there is none.
struct MaxCrush {
  double t_m_s = kUnset, max_crush_m = kUnset;
};
MaxCrush find_max_crush(std::span<const double> time_s, std::span<const double> accel_mps2,
                        std::span<const double> velocity_mps, std::span<const double> displacement_m);

}  // namespace crashsim
