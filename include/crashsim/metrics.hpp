#pragma once
/// Pulse metrics as crash engineers know them.

#include <array>
#include <span>
#include <string_view>

#include <crashsim/error.hpp>

namespace crashsim {

/// Metrics of one longitudinal pulse; unset (NaN) where a quantity does not exist.
struct Metrics {
  double t_m_s = kUnset;                 ///< Time of maximum crush: first zero of velocity [s].
  double max_crush_m = kUnset;           ///< Dynamic crush, displacement at t_m [m].
  double static_crush_m = kUnset;        ///< Crush left when the vehicle has separated [m].
  double peak_decel_g = kUnset;          ///< Largest deceleration [g].
  double mean_decel_g = kUnset;          ///< v0 / t_m [g].
  double delta_v_mps = kUnset;           ///< v0 - smallest velocity [m/s].
  double rebound_velocity_mps = kUnset;  ///< Smallest velocity, negative [m/s].
  double restitution = kUnset;           ///< -rebound velocity / v0.
  double centroid_s = kUnset;            ///< Time centroid of the deceleration over 0..t_m, C / v0 [s].
  double olc_g = kUnset;                 ///< Occupant load criterion [g of 9.81].
  double sm10_g = kUnset, sm25_g = kUnset, sm38_g = kUnset, sm50_g = kUnset;  ///< Largest moving mean over w ms [g].
  double asi = kUnset;            ///< Acceleration severity index, 50 ms moving mean.
  double vpi_g = kUnset;          ///< Vehicle pulse index, ISO/TR 12353-3 [g].
  double kw400_n_per_m = kUnset;  ///< Work-equivalent stiffness over 25..400 mm of crush [N/m].
  double energy_j = kUnset;       ///< Work of the crush force over 0..C, m v0^2 / 2 [J].
};

/// Name and member of each metric, in the order they are printed; the one list for CLI, JSON, tables and Python.
struct MetricField {
  std::string_view name;
  double Metrics::*member;
  std::string_view doc;
};
inline constexpr std::array<MetricField, 18> kMetricFields = {{
    {"t_m_s", &Metrics::t_m_s, "time of maximum crush"},
    {"max_crush_m", &Metrics::max_crush_m, "maximum dynamic crush"},
    {"static_crush_m", &Metrics::static_crush_m, "crush left after separation"},
    {"peak_decel_g", &Metrics::peak_decel_g, "peak deceleration"},
    {"mean_decel_g", &Metrics::mean_decel_g, "mean deceleration to t_m"},
    {"delta_v_mps", &Metrics::delta_v_mps, "change of velocity"},
    {"rebound_velocity_mps", &Metrics::rebound_velocity_mps, "rebound velocity"},
    {"restitution", &Metrics::restitution, "coefficient of restitution"},
    {"centroid_s", &Metrics::centroid_s, "time centroid of the pulse"},
    {"olc_g", &Metrics::olc_g, "occupant load criterion"},
    {"sm10_g", &Metrics::sm10_g, "largest 10 ms mean"},
    {"sm25_g", &Metrics::sm25_g, "largest 25 ms mean"},
    {"sm38_g", &Metrics::sm38_g, "largest 38 ms mean"},
    {"sm50_g", &Metrics::sm50_g, "largest 50 ms mean"},
    {"asi", &Metrics::asi, "acceleration severity index"},
    {"vpi_g", &Metrics::vpi_g, "vehicle pulse index"},
    {"kw400_n_per_m", &Metrics::kw400_n_per_m, "work-equivalent stiffness"},
    {"energy_j", &Metrics::energy_j, "energy absorbed to maximum crush"},
}};

/// Longitudinal motion from impact: times from 0, crush and impact velocity positive, deceleration negative.
struct Motion {
  std::span<const double> time_s, accel_mps2, velocity_mps, displacement_m;
};

/// All metrics of a motion. `mass_kg` unset leaves those that need it unset.
/// @throws InvalidInput when lengths differ, there are fewer than 3 samples or the first velocity is not > 0.
Metrics metrics(const Motion& motion, double mass_kg = kUnset);

/// Occupant load criterion [g of 9.81] and the two times that bound it [s].
struct Olc {
  double olc_g = kUnset, t1_s = kUnset, t2_s = kUnset;
};
/// Occupant flies freely 65 mm relative to the vehicle, then is held at constant deceleration for 235 mm more.
/// Beyond the last sample the vehicle keeps its last velocity. Unset when the occupant does not travel that far.
Olc occupant_load_criterion(std::span<const double> time_s, std::span<const double> velocity_mps,
                            std::span<const double> displacement_m);

/// Largest mean deceleration over any window of `window_s` [m/s^2].
double sliding_mean_peak(std::span<const double> time_s, std::span<const double> velocity_mps, double window_s);

/// Vehicle pulse index (ISO/TR 12353-3): peak acceleration of a unit mass on a belt of 2500 N/m with 30 mm slack
/// [m/s^2].
double vehicle_pulse_index(const Motion& motion);

/// Which definition of the acceleration severity index: 50 ms moving means, or CFC180 and a phaseless 4-pole 13 Hz
/// filter.
enum class AsiMethod { moving_mean_1998, butterworth_2010 };

/// Acceleration severity index of three acceleration channels [m/s^2], uniform at dt_s; y and z may be empty.
double acceleration_severity_index(std::span<const double> ax, std::span<const double> ay, std::span<const double> az,
                                   double dt_s, AsiMethod method = AsiMethod::moving_mean_1998);

/// Work-equivalent stiffness KW400 [N/m] of a force [N] over crush [m]; unset when crush stays below 0.4 m.
double kw400(std::span<const double> displacement_m, std::span<const double> force_n);

}  // namespace crashsim
