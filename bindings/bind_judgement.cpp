#include <string>

#include <crashsim/metrics.hpp>
#include <crashsim/summary.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "motion_arrays.hpp"
#include "value_class.hpp"

namespace crashsim {

inline constexpr std::string_view kAsiMethodNames[] = {"moving_mean_1998", "butterworth_2010"};
template <>
inline constexpr std::span<const std::string_view> enum_names<AsiMethod>{kAsiMethodNames};

namespace python {
namespace {

Metrics metrics_of_arrays(const MotionArrays& motion, double mass_kg) {
  return unlocked([&] { return metrics(motion.view(), mass_kg); });
}

Metrics metrics_of_object(const py::object& motion, const py::object& mass_kg) {
  const double mass = number_or_unset(mass_kg, "kg", "mass_kg");
  if (py::isinstance<CrushResponse>(motion)) return metrics_of(motion.cast<const CrushResponse&>(), mass);
  if (!py::isinstance<Pulse>(motion) || !mass_kg.is_none()) return metrics_of_arrays(motion_of(motion), mass);
  return metrics_of(motion.cast<const Pulse&>());
}

void bind_metrics(py::module_& module) {
  ValueClass<Metrics>(
      module, "Metrics",
      "Metrics of one longitudinal pulse as crash engineers know them; g is 9.80665 m/s^2, but 9.81 m/s^2 "
      "in olc_g. NaN where a quantity does not exist.")
      .numbers(kMetricFields);
  module.def("metrics", &metrics_of_object, py::arg("motion"), py::arg("mass_kg") = py::none());
  module.def(
      "metrics",
      [](const py::object& time_s, const py::object& accel_mps2, const py::object& velocity_mps,
         const py::object& displacement_m, const py::object& mass_kg) {
        return metrics_of_arrays({Doubles(time_s, "time_s"), Doubles(accel_mps2, "accel_mps2"),
                                  Doubles(velocity_mps, "velocity_mps"), Doubles(displacement_m, "displacement_m")},
                                 number_or_unset(mass_kg, "kg", "mass_kg"));
      },
      py::arg("time_s"), py::arg("accel_mps2"), py::arg("velocity_mps"), py::arg("displacement_m"),
      py::arg("mass_kg") = py::none(),
      R"(All metrics of a longitudinal motion from impact, ``metrics(motion)`` or ``metrics(time_s, ...)``.

Samples before time 0 are left out. Those of a CrushResponse have times, crush and rebound exactly as its events found
them. A motion that does not reach maximum crush, or ends while it rebounds, has NaN for what comes later.

Parameters
----------
motion : Pulse, CrushResponse, CoupledResponse or alike
    Any object with the four arrays below as attributes.
time_s : array_like of shape (n,)
    Strictly increasing times [s], impact at 0; n >= 3.
accel_mps2 : array_like of shape (n,)
    dv/dt [m/s^2], negative while the vehicle decelerates.
velocity_mps : array_like of shape (n,)
    Velocity [m/s], the first one > 0.
displacement_m : array_like of shape (n,)
    Crush [m].
mass_kg : float or str, optional
    Mass [kg], > 0; a Pulse's own by default. Without it energy_j and kw400_n_per_m are NaN.

Returns
-------
Metrics

Raises
------
InvalidInput
    When lengths differ, a value is not finite, times do not increase, there are fewer than 3 samples from time 0 on,
    the first velocity is not > 0 or the mass is not > 0.
)");
}

void bind_olc(py::module_& module) {
  ValueClass<Olc>(module, "Olc", "Occupant load criterion and the two times that bound it; NaN when there is none.")
      .field("olc_g", &Olc::olc_g, "Occupant load criterion [g of 9.81 m/s^2].")
      .field("t1_s", &Olc::t1_s, "End of free flight [s].")
      .field("t2_s", &Olc::t2_s, "End of restraint [s].");
  module.def(
      "occupant_load_criterion",
      [](const py::object& time_s, const py::object& velocity_mps, const py::object& displacement_m) {
        const Doubles times(time_s, "time_s"), velocity(velocity_mps, "velocity_mps"),
            displacement(displacement_m, "displacement_m");
        return unlocked([&] { return occupant_load_criterion(times.view(), velocity.view(), displacement.view()); });
      },
      py::arg("time_s"), py::arg("velocity_mps"), py::arg("displacement_m"),
      R"(Occupant load criterion: 65 mm of free flight, then constant deceleration over 235 mm more.

With v0 t1 - s(t1) = 0.065 m and (v0 + v2)(t2 - t1)/2 - (s2 - s1) = 0.235 m, OLC = (v0 - v2)/(t2 - t1). Between samples
s is the cubic that has their s and v; beyond the last one the vehicle keeps its velocity.

Parameters
----------
time_s : array_like of shape (n,)
    Strictly increasing times [s]; n >= 2.
velocity_mps : array_like of shape (n,)
    Velocity of the vehicle [m/s].
displacement_m : array_like of shape (n,)
    Displacement of the vehicle [m].

Returns
-------
Olc
    All NaN when the occupant does not travel that far.

Raises
------
InvalidInput
    When lengths differ, times do not increase or a value is not finite.
)");
}

void bind_sliding_mean(py::module_& module) {
  module.def(
      "sliding_mean_peak",
      [](const py::object& time_s, const py::object& velocity_mps, double window_s) {
        const Doubles times(time_s, "time_s"), velocity(velocity_mps, "velocity_mps");
        return unlocked([&] { return sliding_mean_peak(times.view(), velocity.view(), window_s); });
      },
      py::arg("time_s"), py::arg("velocity_mps"), py::arg("window_s"),
      R"(Largest mean deceleration over any window inside the samples [m/s^2], velocity linear between samples.

Parameters
----------
time_s : array_like of shape (n,)
    Strictly increasing times [s]; n >= 2.
velocity_mps : array_like of shape (n,)
    Velocity [m/s].
window_s : float
    Length of the window [s], > 0.

Returns
-------
float
    NaN when the samples cover less than the window.

Raises
------
InvalidInput
    When lengths differ, times do not increase, a value is not finite or the window is not > 0.
)");
  module.def(
      "vehicle_pulse_index",
      [](const py::object& time_s, const py::object& accel_mps2) {
        const Doubles times(time_s, "time_s"), accel(accel_mps2, "accel_mps2");
        return unlocked([&] { return vehicle_pulse_index({times.view(), accel.view(), {}, {}}); });
      },
      py::arg("time_s"), py::arg("accel_mps2"),
      R"(Vehicle pulse index, ISO/TR 12353-3: peak acceleration of a unit mass on a belt [m/s^2].

The belt has 2500 N/m and 30 mm of slack. The acceleration is linear between samples; beyond the last one the vehicle
keeps its velocity.

Parameters
----------
time_s : array_like of shape (n,)
    Strictly increasing times [s]; n >= 2.
accel_mps2 : array_like of shape (n,)
    Acceleration of the vehicle [m/s^2], negative while it decelerates.

Returns
-------
float

Raises
------
InvalidInput
    When lengths differ, times do not increase or a value is not finite.
)");
}

void bind_asi(py::module_& module) {
  module.def(
      "acceleration_severity_index",
      [](const py::object& ax, const py::object& ay, const py::object& az, double dt_s, const std::string& method) {
        const auto axis = [](const py::object& given, const char* name) {
          return given.is_none() ? Doubles(py::tuple(), name) : Doubles(given, name);
        };
        const Doubles x(ax, "ax"), y = axis(ay, "ay"), z = axis(az, "az");
        const auto chosen = from_python<AsiMethod>(py::str(method), "method");
        return unlocked([&] { return acceleration_severity_index(x.view(), y.view(), z.view(), dt_s, chosen); });
      },
      py::arg("ax"), py::arg("ay") = py::none(), py::arg("az") = py::none(), py::kw_only(), py::arg("dt_s"),
      py::arg("method") = "moving_mean_1998",
      R"(Acceleration severity index, EN 1317-1: largest sqrt((ax/12 g)^2 + (ay/9 g)^2 + (az/10 g)^2), smoothed.

Parameters
----------
ax : array_like of shape (n,)
    Longitudinal acceleration [m/s^2].
ay, az : array_like of shape (n,), optional
    Lateral and vertical acceleration [m/s^2]; none by default.
dt_s : float
    Sampling interval [s], > 0.
method : {'moving_mean_1998', 'butterworth_2010'}
    Smoothing: moving means over 50 ms (1998), or CFC180 and a phaseless 4-pole Butterworth filter of 13 Hz (2010).

Returns
-------
float
    NaN when 50 ms are needed and not there.

Raises
------
InvalidInput
    When lengths differ, a value is not finite or the rate is too low for CFC180.
)");
}

void bind_stiffness(py::module_& module) {
  module.def(
      "kw400",
      [](const py::object& displacement_m, const py::object& force_n) {
        const Doubles displacement(displacement_m, "displacement_m"), force(force_n, "force_n");
        return kw400(displacement.view(), force.view());
      },
      py::arg("displacement_m"), py::arg("force_n"),
      R"(Work-equivalent stiffness KW400 = 2 (E(0.4 m) - E(0.025 m)) / (0.4^2 - 0.025^2) m^2 [N/m].

Parameters
----------
displacement_m : array_like of shape (n,)
    Crush [m]; n >= 2.
force_n : array_like of shape (n,)
    Force [N]; E is its work by trapezoids until crush first gets there.

Returns
-------
float
    NaN when crush does not cover 25..400 mm.

Raises
------
InvalidInput
    When lengths differ or there are fewer than 2 samples.
)");
  module.def(
      "ahof400",
      [](const py::object& displacement_m, const py::object& force_n, const py::object& height_m) {
        const Doubles displacement(displacement_m, "displacement_m"), force(force_n, "force_n"),
            height(height_m, "height_m");
        return ahof400(displacement.view(), force.view(), height.view());
      },
      py::arg("displacement_m"), py::arg("force_n"), py::arg("height_m"),
      R"(Average height of force AHOF400 [m]: mean height, weighted by the force's work over 25..400 mm of crush.

Parameters
----------
displacement_m : array_like of shape (n,)
    Crush [m]; n >= 2.
force_n : array_like of shape (n,)
    Force [N].
height_m : array_like of shape (n,)
    Height at which it acts [m].

Returns
-------
float
    NaN when crush does not cover 25..400 mm.

Raises
------
InvalidInput
    When lengths differ or there are fewer than 2 samples.
)");
}

void bind_crash3(py::module_& module) {
  ValueClass<Crash3>(module, "Crash3",
                     "CRASH3 stiffness: force per width A + B C at residual crush C, and G = A^2 / (2 B).")
      .field("a_n_per_m", &Crash3::a_n_per_m, "Force per width at which damage begins [N/m].")
      .field("b_n_per_m2", &Crash3::b_n_per_m2, "Stiffness per width [N/m^2].")
      .field("g_n", &Crash3::g_n, "Energy per width absorbed without damage [N].");
  module.def(
      "crash3_stiffness",
      [](const py::object& mass_kg, const py::object& impact_speed_mps, const py::object& residual_crush_m,
         const py::object& damage_width_m, const py::object& no_damage_speed_mps) {
        return crash3_stiffness(number_or_unset(mass_kg, "kg", "mass_kg"),
                                number_or_unset(impact_speed_mps, "m/s", "impact_speed_mps"),
                                number_or_unset(residual_crush_m, "m", "residual_crush_m"),
                                number_or_unset(damage_width_m, "m", "damage_width_m"),
                                number_or_unset(no_damage_speed_mps, "m/s", "no_damage_speed_mps"));
      },
      py::arg("mass_kg"), py::arg("impact_speed_mps"), py::arg("residual_crush_m"), py::arg("damage_width_m"),
      py::arg("no_damage_speed_mps") = 2.2352,
      R"(CRASH3 coefficients from one full-width barrier test, residual crush linear in speed.

Each quantity is a number in SI units, or text with a unit.

Parameters
----------
mass_kg : float or str
    Test mass [kg], > 0.
impact_speed_mps : float or str
    Impact speed [m/s], above the no-damage speed.
residual_crush_m : float or str
    Mean residual crush [m], > 0.
damage_width_m : float or str
    Width of the damage [m], > 0.
no_damage_speed_mps : float or str
    Speed up to which there is no residual crush [m/s], > 0; 5 mph by default.

Returns
-------
Crash3

Raises
------
InvalidInput
    When a quantity is not > 0 or the impact speed not above the no-damage speed.
)");
  module.def(
      "energy_equivalent_speed",
      [](const py::object& energy_j, const py::object& mass_kg) {
        return energy_equivalent_speed(number_or_unset(energy_j, "J", "energy_j"),
                                       number_or_unset(mass_kg, "kg", "mass_kg"));
      },
      py::arg("energy_j"), py::arg("mass_kg"),
      R"(Energy-equivalent speed sqrt(2 E / m) [m/s].

Parameters
----------
energy_j : float or str
    Energy E [J], >= 0.
mass_kg : float or str
    Mass m [kg], > 0.

Returns
-------
float

Raises
------
InvalidInput
    When the energy is negative or the mass not > 0.
)");
}

}  // namespace

void bind_judgement(py::module_& module) {
  bind_metrics(module);
  bind_olc(module);
  bind_sliding_mean(module);
  bind_asi(module);
  bind_stiffness(module);
  bind_crash3(module);
}

}  // namespace python
}  // namespace crashsim
