#pragma once
/// Pulse metrics as crash engineers know them. g is 9.80665 m/s^2 where nothing else is said.

#include <array>
#include <span>
#include <string_view>

#include <crashsim/error.hpp>
#include <crashsim/named_number.hpp>

namespace crashsim {

/// Metrics of one longitudinal pulse; unset (NaN) where a quantity does not exist.
struct Metrics {
  double t_m_s = kUnset;                 ///< Time of maximum crush: first zero of velocity [s].
  double max_crush_m = kUnset;           ///< Dynamic crush, displacement at t_m [m].
  double static_crush_m = kUnset;        ///< Crush left when the vehicle has separated: where v first is smallest [m].
  double peak_decel_g = kUnset;          ///< Largest deceleration [g].
  double mean_decel_g = kUnset;          ///< v0 / t_m [g].
  double delta_v_mps = kUnset;           ///< v0 - smallest velocity [m/s].
  double rebound_velocity_mps = kUnset;  ///< Smallest velocity after t_m, <= 0; unset while it still falls [m/s].
  double restitution = kUnset;           ///< -rebound velocity / v0.
  double centroid_s = kUnset;            ///< Time centroid of the deceleration over 0..t_m, C / v0 [s].
  double olc_g = kUnset;                 ///< Occupant load criterion [g of 9.81].
  double sm10_g = kUnset, sm25_g = kUnset, sm38_g = kUnset, sm50_g = kUnset;  ///< Largest moving mean over w ms [g].
  double asi = kUnset;            ///< Acceleration severity index of this axis alone: sm50_g / 12.
  double vpi_g = kUnset;          ///< Vehicle pulse index, ISO/TR 12353-3 [g].
  double kw400_n_per_m = kUnset;  ///< Work-equivalent stiffness of -m a over 25..400 mm of crush [N/m].
  double energy_j = kUnset;       ///< Work of the crush force over 0..C, m v0^2 / 2 [J].
};

using MetricField = NamedNumber<Metrics>;
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

/// Longitudinal motion from impact at time 0: crush and impact velocity positive, deceleration negative.
struct Motion {
  std::span<const double> time_s, accel_mps2, velocity_mps, displacement_m;
};

/// All metrics of a motion. Samples before time 0 are left out. `mass_kg` unset leaves those that need it unset; a
/// motion that does not reach maximum crush or ends while it rebounds leaves unset what comes later.
/// @throws InvalidInput when lengths differ, a value is not finite, times do not increase, there are fewer than 3
///         samples from time 0 on, the first velocity is not > 0 or the mass is not > 0.
Metrics metrics(const Motion& motion, double mass_kg = kUnset);

/// Occupant load criterion [g of 9.81] and the two times that bound it [s].
struct Olc {
  double olc_g = kUnset, t1_s = kUnset, t2_s = kUnset;
};
/// Occupant flies freely 65 mm relative to the vehicle, then is held at constant deceleration for 235 mm more:
///     v0 t1 - s(t1) = 0.065,  (v0 + v2)(t2 - t1) / 2 - (s2 - s1) = 0.235,  OLC = (v0 - v2) / (t2 - t1)
/// with times and displacements from the first sample. Between samples s is the cubic that has the samples' s and v;
/// beyond the last sample the vehicle keeps its last velocity. Unset when the occupant does not travel that far.
Olc occupant_load_criterion(std::span<const double> time_s, std::span<const double> velocity_mps,
                            std::span<const double> displacement_m);

/// Largest mean deceleration over any window of `window_s` inside the samples [m/s^2], velocity linear between samples;
/// unset when they cover less.
double sliding_mean_peak(std::span<const double> time_s, std::span<const double> velocity_mps, double window_s);

/// Vehicle pulse index (ISO/TR 12353-3): peak acceleration of a unit mass on a belt of 2500 N/m with 30 mm slack
/// [m/s^2]. Uses time and acceleration, linear between samples; beyond the last one the vehicle keeps its velocity.
double vehicle_pulse_index(const Motion& motion);

/// Which definition of the acceleration severity index: EN 1317-1:1998, moving means over 50 ms; or EN 1317-1:2010,
/// CFC180 and a phaseless 4-pole Butterworth filter of 13 Hz (-3 dB, both passes together) with ends held for 0.5 s.
enum class AsiMethod { moving_mean_1998, butterworth_2010 };

/// Acceleration severity index, the largest sqrt((ax/12 g)^2 + (ay/9 g)^2 + (az/10 g)^2) of three smoothed acceleration
/// channels [m/s^2], uniform at dt_s; y and z may be empty. Unset when 50 ms are needed and not there.
/// @throws InvalidInput when lengths differ, a value is not finite or the rate is too low for CFC180.
double acceleration_severity_index(std::span<const double> ax, std::span<const double> ay, std::span<const double> az,
                                   double dt_s, AsiMethod method = AsiMethod::moving_mean_1998);

/// Work-equivalent stiffness KW400 = 2 (E(0.4) - E(0.025)) / (0.4^2 - 0.025^2) [N/m] of a force [N] over crush [m], E
/// its work by trapezoids until crush first gets there; unset when crush does not cover 25..400 mm.
double kw400(std::span<const double> displacement_m, std::span<const double> force_n);

/// Average height of force AHOF400 [m]: mean of the force's height, weighted by its work over 25..400 mm of crush.
double ahof400(std::span<const double> displacement_m, std::span<const double> force_n,
               std::span<const double> height_m);

/// CRASH3 stiffness: force per width A + B C at residual crush C, and G = A^2 / (2 B).
struct Crash3 {
  double a_n_per_m = kUnset;   ///< Force per width at which damage begins [N/m].
  double b_n_per_m2 = kUnset;  ///< Stiffness per width [N/m^2].
  double g_n = kUnset;         ///< Energy per width absorbed without damage [N].
};
/// CRASH3 coefficients from one full-width barrier test, residual crush linear in speed from `no_damage_speed_mps` on
/// (default 5 mph). @throws InvalidInput when a quantity is not > 0 or the impact speed not above the no-damage speed.
Crash3 crash3_stiffness(double mass_kg, double impact_speed_mps, double residual_crush_m, double damage_width_m,
                        double no_damage_speed_mps = 2.2352);

/// Energy-equivalent speed sqrt(2 E / m) [m/s].
double energy_equivalent_speed(double energy_j, double mass_kg);

}  // namespace crashsim
