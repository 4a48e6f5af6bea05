#pragma once
/// One function a topic, each in a file of its own.
#include <pybind11/pybind11.h>

namespace crashsim::python {

namespace py = pybind11;

void bind_units(py::module_& module);
void bind_traces(py::module_& module);
void bind_pulse(py::module_& module);
void bind_crush(py::module_& module);
void bind_simulate_many(py::module_& module);
void bind_identify(py::module_& module);
void bind_predict(py::module_& module);
void bind_select(py::module_& module);
void bind_uncertainty(py::module_& module);
void bind_judgement(py::module_& module);
void bind_rating(py::module_& module);
void bind_plausibility(py::module_& module);
void bind_wall(py::module_& module);
void bind_sensors(py::module_& module);
void bind_motion(py::module_& module);
void bind_pitch(py::module_& module);
void bind_pitch_identify(py::module_& module);
void bind_vertical(py::module_& module);
void bind_coupled(py::module_& module);
void bind_design(py::module_& module);
void bind_samples(py::module_& module);
void bind_case(py::module_& module);
void bind_sweep(py::module_& module);
void bind_batch(py::module_& module);
void bind_files(py::module_& module);

}  // namespace crashsim::python
