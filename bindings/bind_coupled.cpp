#include <crashsim/coupled_model.hpp>
#include <crashsim/simulate_coupled.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_model(py::module_& module) {
  ValueClass<GroundContact>(module, "GroundContact",
                            R"(What the suspension does beyond its linear range; with all defaults it is linear.

Lift-off: an axle's load is max(0, static load - k d - c d'), d the rise of the body over the axle. Bump stop: an axle
compressed by more than the gap adds the stop's stiffness times what exceeds it. Fields are keywords of the constructor
and take text with units; bad values raise InvalidInput.)")
      .option_fields();
  ValueClass<CoupledModel>(module, "CoupledModel",
                           R"(Crush, heave and pitch as one model of three degrees of freedom, from impact.

    s = x + (h_F - h_cg) theta,  F_x = F_k(s) + F_c(s')
    m x'' = -F_x,  m z'' = -F_v + P_1 + P_2,  J theta'' = F_x (h_cg - h_F) + F_v l_Q - lf P_1 + lr P_2

x is travel of the centre of gravity towards the barrier, z heave (up positive), theta pitch (nose-down positive, small),
s crush where the force acts, P the axles' loads less the static ones. Forces follow from virtual work, so the energies
balance. Raises InvalidInput when it is used with a bad value.)")
      .field("crush", &CoupledModel::crush, "CrushModel of the front.")
      .field("body", &CoupledModel::body,
             "HeavePitchModel: heights needed, the arm with a vertical force; derived equations only.")
      .field("vertical", &CoupledModel::vertical, "VerticalForceLaw; by default no vertical force.")
      .field("ground", &CoupledModel::ground,
             "GroundContact: values of an axle, also where the body's are one wheel's.")
      .def(
          "validate", [](const CoupledModel& self) { validate(self); },
          "Raises InvalidInput on a bad part, masses that differ, a height not set, half a bump stop, printed "
          "equations.")
      .def("with_one_mass", &with_one_mass,
           "The same model with its mass in both parts. Raises InvalidInput when neither has it, or they differ.");
}

/// The curves and how it ended.
void add_curves(ValueClass<CoupledResponse>& response) {
  using R = CoupledResponse;
  response
      .field("outcome", &R::outcome,
             "How it ended: 'not_run', 'completed', 'no_max_crush', 'left_knot_range', 'unloading_too_soft', "
             "'step_limit' or 'failed'.")
      .field("message", &R::message, "Why it is not usable, or ''.")
      .field("notes", &R::notes, "What a careful reader should know.")
      .field("time_s", &R::time_s, "Times [s], uniform but for the last interval.")
      .field("displacement_m", &R::displacement_m, "Travel x of the centre of gravity [m].")
      .field("velocity_mps", &R::velocity_mps, "x' [m/s].")
      .field("accel_mps2", &R::accel_mps2, "x'' [m/s^2].")
      .field("crush_m", &R::crush_m, "Crush s, where the force acts [m].")
      .field("heave_m", &R::heave_m, "Heave z, up positive [m].")
      .field("heave_velocity_mps", &R::heave_velocity_mps, "z' [m/s].")
      .field("heave_accel_mps2", &R::heave_accel_mps2, "z'' [m/s^2].")
      .field("pitch_rad", &R::pitch_rad, "Pitch theta, nose-down positive [rad].")
      .field("pitch_rate_radps", &R::pitch_rate_radps, "theta' [rad/s].")
      .field("pitch_accel_radps2", &R::pitch_accel_radps2, "theta'' [rad/s^2].")
      .field("longitudinal_force_n", &R::longitudinal_force_n, "F_x, positive while it stops the vehicle [N].")
      .field("vertical_force_n", &R::vertical_force_n, "F_v on the vehicle, downward positive [N].")
      .field("front_axle_load_n", &R::front_axle_load_n,
             "Force of the ground on the front axle, up positive, static included [N].")
      .field("rear_axle_load_n", &R::rear_axle_load_n, "The same of the rear axle [N].")
      .field("energy_residual_j", &R::energy_residual_j,
             "All energies + work done - initial energy [J]; 0 up to the integration error.");
}

void add_numbers(ValueClass<CoupledResponse>& response) {
  using R = CoupledResponse;
  response.field("impact_speed_mps", &R::impact_speed_mps, "Speed simulated [m/s].")
      .field("t_m_s", &R::t_m_s, "Time of maximum crush, the first zero of s' [s].")
      .field("max_crush_m", &R::max_crush_m, "Crush s at t_m [m].")
      .field("separation_s", &R::separation_s, "Time contact with the barrier was lost [s]; NaN: never.")
      .field("static_crush_m", &R::static_crush_m, "Crush at separation after maximum crush [m].")
      .field("rebound_velocity_mps", &R::rebound_velocity_mps, "x' at separation after maximum crush [m/s].")
      .field("displacement_max_m", &R::displacement_max_m, "Largest travel, between samples [m].")
      .field("displacement_max_time_s", &R::displacement_max_time_s, "Its time [s].")
      .field("peak_decel_g", &R::peak_decel_g, "Largest deceleration -x'' [g].")
      .field("pitch_max_rad", &R::pitch_max_rad, "Largest pitch, between samples [rad].")
      .field("pitch_max_time_s", &R::pitch_max_time_s, "Its time [s].")
      .field("heave_min_m", &R::heave_min_m, "Smallest heave, between samples [m].")
      .field("heave_min_time_s", &R::heave_min_time_s, "Its time [s].")
      .field("heave_velocity_min_mps", &R::heave_velocity_min_mps, "Smallest heave velocity [m/s].")
      .field("front_axle_load_max_n", &R::front_axle_load_max_n, "Largest load of the front axle [N].")
      .field("front_axle_load_min_n", &R::front_axle_load_min_n, "Smallest load of the front axle [N].")
      .field("rear_axle_load_min_n", &R::rear_axle_load_min_n, "Smallest load of the rear axle [N].")
      .field("front_lift_off_s", &R::front_lift_off_s, "First time the front wheels leave the ground [s]; NaN: never.")
      .field("rear_lift_off_s", &R::rear_lift_off_s, "The same of the rear wheels [s].")
      .field("kinetic_energy_j", &R::kinetic_energy_j, "Of travel, heave and pitch at the end [J].")
      .field("crush_energy_j", &R::crush_energy_j,
             "Absorbed by the structure until the end, less what it gave back [J].")
      .field("suspension_energy_j", &R::suspension_energy_j,
             "Of springs, bump stops and gravity at the end, 0 at rest [J].")
      .field("suspension_dissipated_j", &R::suspension_dissipated_j, "By the suspension until the end [J].")
      .field("vertical_work_j", &R::vertical_work_j,
             "Done by the vehicle against the vertical force until the end [J].")
      .field("statistics", &R::statistics, "Work of the integrator, SolverStatistics.");
}

}  // namespace

void bind_coupled(py::module_& module) {
  bind_model(module);
  ValueClass<CoupledResponse> response(
      module, "CoupledResponse",
      "Crush, heave and pitch over time. Numbers are NaN and arrays empty until computed; arrays are read-only, of n.");
  add_curves(response);
  add_numbers(response);
  response.result();
  module.def(
      "simulate_coupled",
      [](const CoupledModel& model, const py::object& vertical_force_n, const py::kwargs& keywords) {
        const TimeSeries force = series_from(vertical_force_n, "vertical_force_n");
        const auto options = options_from<CoupledOptions>(keywords, "simulate_coupled");
        return unlocked([&] { return simulate_coupled(model, options, force); });
      },
      py::arg("model"), py::kw_only(), py::arg("vertical_force_n") = py::none(),
      with_options_doc<CoupledOptions>(R"(Simulates crush, heave and pitch together from impact.

The body starts in static equilibrium.

Parameters
----------
model : CoupledModel
    Crush, body, vertical force and suspension; a mass in one part is enough.
vertical_force_n : TimeSeries, Trace or (time_s, values), optional
    F_v [N] over time from impact, downward positive, linear between samples and zero outside them, whatever the
    contact; instead of the model's law.
**options
    See below.

Returns
-------
CoupledResponse

Raises
------
InvalidInput
    On a bad model, series or option, without an impact speed, or with a law and a series.)")
          .c_str());
}

}  // namespace crashsim::python
