#include <string>
#include <vector>

#include <crashsim/forcing.hpp>
#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/simulate_pitch.hpp>

#include "bindings.hpp"
#include "forcing_argument.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {

PitchForcing forcing_from(const py::handle& force, const std::string& what) {
  if (py::isinstance<PitchForcing>(force)) return force.cast<PitchForcing>();
  if (py::isinstance<MeasuredForcing>(force)) return force.cast<const MeasuredForcing&>().forcing;
  if (py::isinstance<CrushResponse>(force)) return forcing_of(force.cast<const CrushResponse&>());
  PitchForcing vertical;
  vertical.vertical_force_n = series_from(force, what);
  return vertical;
}

namespace {

py::array matrix(const Eigen::Matrix2d& m) {
  return array_of(std::vector<std::vector<double>>{{m(0, 0), m(0, 1)}, {m(1, 0), m(1, 1)}});
}

void bind_model(py::module_& module) {
  ValueClass<Mode>(module, "Mode", "One free motion exp(lambda t): a conjugate pair of eigenvalues, or a real one.")
      .field("eigenvalue", &Mode::eigenvalue, "lambda, complex with imaginary part >= 0 [1/s].")
      .field("frequency_hz", &Mode::frequency_hz, "abs(lambda) / (2 pi), undamped natural frequency [Hz].")
      .field("damping_ratio", &Mode::damping_ratio, "-Re(lambda) / abs(lambda); NaN for a rigid-body mode.")
      .field("pitch_per_heave", &Mode::pitch_per_heave,
             "abs(theta / z) of the shape [rad/m]; infinite for pure pitch.");
  ValueClass<HeavePitchModel>(module, "HeavePitchModel",
                              R"(Heave z and pitch theta of the body on its axles, [Noorsumar2021] eq. (5)-(10).

    M q'' + C q' + K q = Q,  q = (z, theta),  M = diag(m, J),  Q_z = -F_v,  Q_theta = F_v l_Q + F_x (h_cg - h_F)

z is up positive from static equilibrium, theta nose-down positive. F_v is the barrier's vertical force on the vehicle,
downward positive, l_Q = force_arm_m ahead of the centre of gravity; F_x is the longitudinal crush force, positive while
it stops the vehicle, at the height h_F. The formulation 'as_printed' keeps the paper's equation (10), whose C is not
symmetric. Fields are keywords of the constructor and take text with units; bad values raise InvalidInput.)")
      .option_fields()
      .def(
          "validate", [](const HeavePitchModel& self) { validate(self); },
          "Raises InvalidInput naming the field, its value and the rule when the model is not one.")
      .def("with_axle_values", &with_axle_values, "The same model with axle values: per_wheel resolved.")
      .def(
          "mass_matrix", [](const HeavePitchModel& self) { return matrix(mass_matrix(self)); },
          "M over (z, theta): array of shape (2, 2) [SI].")
      .def(
          "damping_matrix", [](const HeavePitchModel& self) { return matrix(damping_matrix(self)); },
          "C over (z, theta), of the formulation: array of shape (2, 2) [SI].")
      .def(
          "stiffness_matrix", [](const HeavePitchModel& self) { return matrix(stiffness_matrix(self)); },
          "K over (z, theta): array of shape (2, 2) [SI].")
      .def("is_dissipative", &is_dissipative,
           "True when damping takes energy from every motion; always so for 'derived', not for 'as_printed'.")
      .def(
          "modes", [](const HeavePitchModel& self) { return py::tuple(py::cast(modes(self))); },
          "The free motions, each a Mode, in order of frequency: two when both oscillate, up to four when overdamped.");
}

void bind_forcing(py::module_& module) {
  ValueClass<PitchForcing>(
      module, "PitchForcing",
      "What drives heave and pitch, each a TimeSeries on one clock on which impact is 0. Forces are "
      "zero outside their samples; the height is held there.")
      .field("vertical_force_n", &PitchForcing::vertical_force_n, "F_v on the vehicle [N], downward positive.")
      .field("longitudinal_force_n", &PitchForcing::longitudinal_force_n,
             "F_x on the vehicle [N], positive while it stops the vehicle.")
      .field("force_height_m", &PitchForcing::force_height_m, "h_F over time [m]; empty: the model's force_height_m.")
      .field("t_m_s", &PitchForcing::t_m_s, "Time of maximum crush on that clock [s]; needed to start there.");
  ValueClass<MeasuredForcing>(module, "MeasuredForcing", "Forcing read from a trace, with what was done to get it.")
      .field("forcing", &MeasuredForcing::forcing, "The PitchForcing.")
      .field("steps", &MeasuredForcing::steps, "What was done, in order.")
      .field("warnings", &MeasuredForcing::warnings, "What a careful reader should know.")
      .field("input_files", &MeasuredForcing::input_files, "Every file read.");
  module.def(
      "read_forcing",
      [](const py::object& file, const py::kwargs& keywords) {
        auto options = options_from<ForcingOptions>(keywords, "read_forcing");
        options.file = path_text(file);
        return unlocked([&] { return read_forcing(options); });
      },
      py::arg("file"),
      with_options_doc<ForcingOptions>(R"(Reads the barrier's force on the vehicle from a trace file.

Without channels named, those called ``vertical_force_n``, ``longitudinal_force_n`` and ``force_height_m``, or the total
force of a wall.csv, or the spring and damper force of a response.csv, are taken. An impulse is differentiated.

Parameters
----------
file : str or os.PathLike
    Trace file or folder of any format that read_traces reads.
**options
    See below.

Returns
-------
MeasuredForcing

Raises
------
InvalidInput
    Names file and channel when it cannot be read, has no such channel or none to take, or a channel is no force,
    impulse or height.)")
          .c_str());
  module.def("forcing_of", &forcing_of, py::arg("response"),
             R"(The longitudinal force of a simulated crush, with its time of maximum crush.

Parameters
----------
response : CrushResponse
    A simulated crush.

Returns
-------
PitchForcing

Raises
------
InvalidInput
    When the response holds no motion.
)");
}

void bind_response(py::module_& module) {
  using R = PitchResponse;
  ValueClass<R>(
      module, "PitchResponse",
      "Heave and pitch over time. Numbers are NaN and arrays empty until computed; arrays are read-only, of n.")
      .field("outcome", &R::outcome, "How it ended: 'not_run', 'completed', 'step_limit' or 'failed'.")
      .field("message", &R::message, "Why it is not usable, or ''.")
      .field("notes", &R::notes, "What a careful reader should know.")
      .field("time_s", &R::time_s, "Times on the forcing's clock [s], from 0 or an earlier start.")
      .field("heave_m", &R::heave_m, "Heave z, up positive [m].")
      .field("heave_velocity_mps", &R::heave_velocity_mps, "z' [m/s].")
      .field("pitch_rad", &R::pitch_rad, "Pitch theta, nose-down positive [rad].")
      .field("pitch_rate_radps", &R::pitch_rate_radps, "theta' [rad/s].")
      .field("heave_accel_mps2", &R::heave_accel_mps2, "z'' [m/s^2].")
      .field("pitch_accel_radps2", &R::pitch_accel_radps2, "theta'' [rad/s^2].")
      .field("front_deflection_m", &R::front_deflection_m, "Rise of the body over the front axle, z - lf theta [m].")
      .field("rear_deflection_m", &R::rear_deflection_m, "Rise of the body over the rear axle, z + lr theta [m].")
      .field("front_axle_force_n", &R::front_axle_force_n,
             "Force of the front axle on the body, up positive, less its static load [N].")
      .field("rear_axle_force_n", &R::rear_axle_force_n, "The same of the rear axle [N].")
      .field("heave_force_n", &R::heave_force_n, "Q_z applied [N].")
      .field("pitch_moment_nm", &R::pitch_moment_nm, "Q_theta applied [N m].")
      .field("start_time_s", &R::start_time_s, "Start of the motion [s].")
      .field("pitch_max_rad", &R::pitch_max_rad, "Largest pitch after the start, between samples [rad].")
      .field("pitch_max_time_s", &R::pitch_max_time_s, "Its time [s].")
      .field("heave_min_m", &R::heave_min_m, "Smallest heave [m].")
      .field("heave_min_time_s", &R::heave_min_time_s, "Its time [s].")
      .field("heave_velocity_min_mps", &R::heave_velocity_min_mps, "Smallest heave velocity [m/s].")
      .field("heave_velocity_min_time_s", &R::heave_velocity_min_time_s, "Its time [s].")
      .field("modes", &R::modes, "Free motions of the model, each a Mode.")
      .field("statistics", &R::statistics, "Work of the integrator, SolverStatistics.")
      .result();
}

void bind_simulation(py::module_& module) {
  module.def(
      "simulate_pitch",
      [](const HeavePitchModel& model, const py::object& force, const py::kwargs& keywords) {
        const PitchForcing forcing = forcing_from(force, "force");
        const auto options = options_from<PitchOptions>(keywords, "simulate_pitch");
        return unlocked([&] { return simulate_pitch(model, forcing, options); });
      },
      py::arg("model"), py::arg("force"),
      with_options_doc<PitchOptions>(
          R"(Simulates heave and pitch under the barrier's force, [Noorsumar2021] eq. (5)-(10).

The initial state is the one at the start; until then the body is held in it.

Parameters
----------
model : HeavePitchModel
    The body on its axles.
force : PitchForcing, MeasuredForcing, CrushResponse, TimeSeries, Trace or (time_s, values)
    What drives it. A simulated crush gives its longitudinal force and its t_m; a series is a vertical force [N],
    downward positive, which has no t_m: start at impact or a time.
**options
    See below.

Returns
-------
PitchResponse

Raises
------
InvalidInput
    On a bad model, series or option, or when the model lacks what the force needs.)")
          .c_str());
}

}  // namespace

void bind_pitch(py::module_& module) {
  bind_model(module);
  bind_forcing(module);
  bind_response(module);
  bind_simulation(module);
}

}  // namespace crashsim::python
