#include <string>

#include <crashsim/body_motion.hpp>
#include <crashsim/measured_motion.hpp>
#include <crashsim/time_series.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_series(py::module_& module) {
  ValueClass<TimeSeries>(module, "TimeSeries",
                         "A quantity known at n times and linear between them. Where a series is asked for, a pair "
                         "(time_s, values) or a Trace does as well, and None for none.")
      .field("time_s", &TimeSeries::time_s, "Strictly increasing times [s], read-only.")
      .field("values", &TimeSeries::values, "As many values [SI], read-only.")
      .def("__len__", [](const TimeSeries& self) { return self.time_s.size(); });
}

void bind_body(py::module_& module) {
  ValueClass<BodyStation>(module, "BodyStation",
                          "Nodes or sensors at one place along the vehicle; the mean of their traces is taken.")
      .field("position_m", &BodyStation::position_m, "Place towards the front, from any reference [m].")
      .field("traces", &BodyStation::traces, "Vertical displacements, velocities or accelerations, each a Trace.");
  ValueClass<BodyMotion>(module, "BodyMotion", "Heave and pitch of the body; rates of them from velocities.")
      .field("heave", &BodyMotion::heave, "Of the centre of gravity, up positive [m, m/s or m/s^2, as the traces].")
      .field("pitch", &BodyMotion::pitch, "Nose-down positive [rad, rad/s or rad/s^2].");
  module.def(
      "body_motion",
      [](const BodyStation& front, const BodyStation& rear, const py::object& cg_position_m, const std::string& sign) {
        const double position_m = number_or_unset(cg_position_m, "m", "cg_position_m");
        const auto positive = from_python<VerticalSign>(py::str(sign), "sign");
        return unlocked([&] { return body_motion(front, rear, position_m, positive); });
      },
      py::arg("front"), py::arg("rear"), py::arg("cg_position_m"), py::arg("sign") = "up",
      R"(Heave and pitch of the body, as a rigid one for small angles, from vertical traces at two places.

Pitch is (z_rear - z_front) / distance; heave is on the line through both.

Parameters
----------
front, rear : BodyStation
    The front station ahead of the rear one; traces of one dimension and one clock.
cg_position_m : float or str
    Place of the centre of gravity, from the same reference as the stations [m].
sign : {'up', 'down'}
    Which way the traces count as positive; SAE J1733 has down.

Returns
-------
BodyMotion

Raises
------
InvalidInput
    When a station has no trace, its place is not set or not ahead of the other's, or the traces are not of one
    dimension and one clock.
)");
}

void bind_measured(py::module_& module) {
  ValueClass<MeasuredMotion>(module, "MeasuredMotion",
                             "Measured heave and pitch, each a TimeSeries; what no channel measures is empty.")
      .field("heave_m", &MeasuredMotion::heave_m, "Heave of the centre of gravity, up positive [m].")
      .field("pitch_rad", &MeasuredMotion::pitch_rad, "Pitch, nose-down positive [rad].")
      .field("heave_velocity_mps", &MeasuredMotion::heave_velocity_mps, "Heave velocity [m/s].")
      .field("pitch_rate_radps", &MeasuredMotion::pitch_rate_radps, "Pitch rate [rad/s].")
      .field("warnings", &MeasuredMotion::warnings, "What a careful reader should know.")
      .field("input_files", &MeasuredMotion::input_files, "Every file read.");
  module.def(
      "read_motion",
      [](const py::object& file, const py::kwargs& keywords) {
        auto options = options_from<MotionOptions>(keywords, "read_motion");
        options.file = path_text(file);
        return unlocked([&] { return read_motion(options); });
      },
      py::arg("file"),
      with_options_doc<MotionOptions>(R"(Reads heave and pitch of the body from vertical channels at two places.

Parameters
----------
file : str or os.PathLike
    Trace file or folder of any format that read_traces reads.
**options
    See below.

Returns
-------
MeasuredMotion

Raises
------
InvalidInput
    Names file and channel when it cannot be read, a station has no channel or no place, a channel measures neither a
    displacement nor a velocity, or the other station lacks its like.)")
          .c_str());
}

}  // namespace

void bind_motion(py::module_& module) {
  bind_series(module);
  bind_body(module);
  bind_measured(module);
}

}  // namespace crashsim::python
