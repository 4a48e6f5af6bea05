#include <string>

#include "bindings.hpp"

#include <crashsim/error.hpp>
#include <crashsim/version.hpp>

namespace crashsim::python {
namespace {

void bind_errors(py::module_& module) {
  py::register_exception<InvalidInput>(module, "InvalidInput", PyExc_ValueError).doc() =
      "A bad value, file, name or unit: the message says which, the rule and the remedy.";
  py::register_exception<NumericalFailure>(module, "NumericalFailure", PyExc_RuntimeError).doc() =
      "The numbers failed and no result could be formed.";
  py::register_exception<SystemFailure>(module, "SystemFailure", PyExc_OSError).doc() =
      "The machine failed: a file cannot be written, no memory.";
  py::register_exception<Interrupted>(module, "Interrupted", PyExc_KeyboardInterrupt).doc() = "The user asked to stop.";
}

/// __all__: what is written without an underscore.
void list_public_names(py::module_& module) {
  py::list names;
  for (const auto& [name, value] : py::dict(module.attr("__dict__")))
    if (const auto text = py::cast<std::string>(name); text.front() != '_') names.append(text);
  module.attr("__all__") = names;
}

}  // namespace
}  // namespace crashsim::python

PYBIND11_MODULE(_core, module) {
  using namespace crashsim::python;
  module.doc() = "The engine of crashsim; use it as `import crashsim`.";
  module.attr("__version__") = crashsim::kVersion;
  bind_errors(module);
  bind_units(module);
  bind_traces(module);
  bind_pulse(module);
  bind_crush(module);
  bind_simulate_many(module);
  bind_identify(module);
  bind_select(module);
  bind_judgement(module);
  bind_uncertainty(module);
  bind_predict(module);
  bind_rating(module);
  bind_plausibility(module);
  bind_wall(module);
  bind_sensors(module);
  bind_motion(module);
  bind_pitch(module);
  bind_pitch_identify(module);
  bind_vertical(module);
  bind_coupled(module);
  bind_design(module);
  bind_samples(module);
  bind_case(module);
  bind_sweep(module);
  bind_batch(module);
  bind_files(module);
  list_public_names(module);
}
