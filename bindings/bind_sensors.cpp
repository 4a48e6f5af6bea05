#include <string>
#include <tuple>
#include <utility>

#include <crashsim/sensor_correction.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_sensor_classes(py::module_& module) {
  ValueClass<ChannelCorrection>(
      module, "ChannelCorrection",
      "What is wrong with one channel: measured(t) = gain a(t - time_shift) + bias. NaN is what was not corrected.")
      .field("channel", &ChannelCorrection::channel, "'93 LEFT REAR SEAT CROSSMEMBER X'.")
      .numbers(kChannelCorrectionNumbers);
  using C = CorrectionCondition;
  ValueClass<C>(module, "CorrectionCondition",
                "A velocity that is known otherwise, and what the mean of the channels makes of it.")
      .field("name", &C::name, "'velocity at 0.15 s', 'rebound velocity', 'velocity at 0.15 s by the wall's impulse'.")
      .field("known_mps", &C::known_mps, "Velocity known [m/s]; of an impulse by the wall as it measured.")
      .field("standard_deviation_mps", &C::standard_deviation_mps,
             "Its standard deviation [m/s], of an impulse with that of the wall's gain.")
      .field("before_mps", &C::before_mps, "By the mean of the channels as they are [m/s].")
      .field("after_mps", &C::after_mps, "By the mean of the corrected channels [m/s].");
  using S = SensorCorrection;
  ValueClass<S>(module, "SensorCorrection", "What a correction of accelerometers gives.")
      .field("outcome", &S::outcome, "How it ended: 'not_run', 'completed' or 'not_converged'.")
      .field("message", &S::message, "Why it did not complete, or ''.")
      .field("channels", &S::channels, "Every channel as a ChannelCorrection.")
      .field("conditions", &S::conditions, "Every velocity known as a CorrectionCondition.")
      .field("wall_gain", &S::wall_gain, "Gain of the wall; NaN without one, or where it is exact.")
      .field("wall_gain_error", &S::wall_gain_error, "Its standard error.")
      .field("noise_mps2", &S::noise_mps2,
             "Standard deviation of a channel of weight 1 about the common motion [m/s^2]; NaN of one channel.")
      .field("correlation_time_s", &S::correlation_time_s, "Over which this noise is alike [s].")
      .field("by_prior", &S::by_prior, "Corrections of which the data leave more than half the prior's uncertainty.")
      .field("corrected", &S::corrected,
             "TraceSet from impact on, not filtered: accel_mps2, the mean, then each channel; make_pulse() takes it.")
      .field("time_zero_s", &S::time_zero_s, "Impact on the clock of the traces [s].")
      .field("steps", &S::steps, "What was done, in order.")
      .field("warnings", &S::warnings, "What looked unusual.")
      .field("input_files", &S::input_files, "Every file read.")
      .def_property_readonly("usable", &S::usable, "True when it completed.")
      .def("brief_report", &S::brief_report, "One line: how it ended and what it changed.");
}

SensorCorrection told(SensorCorrection correction) {
  log_warnings(correction.warnings);
  return correction;
}

/// What both functions take beside the channels.
std::string described(const std::string& what, const std::string& from) {
  return with_options_doc<PulseOptions, SensorCorrectionOptions>(what + R"(

Each channel is taken to show gain a(t - time_shift) + bias of the acceleration a of one rigid compartment. Bias, gain
and time shift, each with a prior, are found by weighted least squares: from the channels' differences to their weighted
mean, whose noise and its correlation in time they tell themselves, and from what is known otherwise, velocities and the
force on a load-cell wall. Channels are picked, turned forward, freed of offset and filtered as for a pulse; what comes
back is not filtered.

Parameters
----------
)" + from + R"(
wall : LoadCellWall, optional
    Wall of the same test, its time zero that of the pulse; needs the mass.
**options
    See below: those of a pulse, and those of the correction.

Returns
-------
SensorCorrection

Raises
------
InvalidInput
    When a channel is no accelerometer, nothing is known that could correct it, or what is needed (impact speed for
    velocities, mass for a wall) is not known.)");
}

}  // namespace

void bind_sensors(py::module_& module) {
  bind_sensor_classes(module);
  module.def(
      "correct_sensors",
      [](const TraceSet& traces, const LoadCellWall* wall, const py::kwargs& keywords) {
        const auto options = options_of<PulseOptions, SensorCorrectionOptions>(keywords, "correct_sensors");
        return told(
            unlocked([&] { return correct_sensors(traces, std::get<0>(options), std::get<1>(options), wall); }));
      },
      py::arg("traces"), py::arg("wall") = py::none(),
      described("Corrects accelerometers so that they agree with each other and with what is known otherwise.",
                "traces : TraceSet\n    Channels read, as by read_traces.")
          .c_str());
  module.def(
      "read_sensor_correction",
      [](const py::object& path, const LoadCellWall* wall, const py::kwargs& keywords) {
        const std::string file = path_text(path);
        const auto options = options_of<PulseOptions, SensorCorrectionOptions>(keywords, "read_sensor_correction");
        return told(
            unlocked([&] { return read_sensor_correction(file, std::get<0>(options), std::get<1>(options), wall); }));
      },
      py::arg("path"), py::arg("wall") = py::none(),
      described("Reads the channels that a pulse would be made of, and corrects them.",
                "path : str or os.PathLike\n    Trace file or folder of any format that read_traces reads.")
          .c_str());
}

}  // namespace crashsim::python
