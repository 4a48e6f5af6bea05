#include <crashsim/simulate_many.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_models(py::module_& module) {
  ValueClass<CrushModels>(module, "CrushModels",
                          R"(Crush models of one structure, n of them. What has an array has one value, or one row, a
model; what has none is that of `common` in all. Fields are keywords of the constructor.)")
      .field("common", &CrushModels::common, "CrushModel: law, extrapolation, unloading, and all that has no array.")
      .field("mass_kg", &CrushModels::mass_kg, "Test masses, array of n [kg], > 0.")
      .field("impact_speed_mps", &CrushModels::impact_speed_mps, "Impact speeds, array of n [m/s], > 0.")
      .field("restitution", &CrushModels::restitution, "Of plastic unloading, array of n, 0..1.")
      .field("spring_ordinates", &CrushModels::spring_ordinates,
             "Array of n x spring knots [N]; with law 'stiffness' [N/m].")
      .field("damper_ordinates", &CrushModels::damper_ordinates, "Array of n x damper knots [N s/m].")
      .field("spring_knots", &CrushModels::spring_knots, "Array of n x knots [m], each row from 0 and increasing.")
      .field("damper_knots", &CrushModels::damper_knots, "Array of n x knots [m/s]; with law 'crush_damping' [m].")
      .field("rate_coefficient", &CrushModels::rate_coefficient, "Of law 'rate', array of n, >= 0.")
      .def("__len__", &CrushModels::count)
      .def("model", &CrushModels::model, py::arg("index"),
           "One of them, a CrushModel. Raises InvalidInput when `index` is none.");
}

void bind_responses(py::module_& module) {
  ValueClass<CrushResponses> responses(
      module, "CrushResponses",
      R"(What a simulation of n crush models gives, in their order. Arrays are read-only
views of the engine's memory; each of Metrics is one of n values, NaN where it does not exist.)");
  responses.field("outcome", &CrushResponses::outcome, "How each ended, array of n texts: see CrushResponse.outcome.")
      .columns(&CrushResponses::metrics, kMetricFields)
      .field("time_s", &CrushResponses::time_s, "Output times, the same for all, array of m [s].")
      .field("accel_mps2", &CrushResponses::accel_mps2,
             "dv/dt, array of n x m [m/s^2]; NaN after a motion that broke off.")
      .field("velocity_mps", &CrushResponses::velocity_mps, "Velocity, array of n x m [m/s].")
      .field("displacement_m", &CrushResponses::displacement_m, "Crush, array of n x m [m].")
      .field("steps", &CrushResponses::steps, "Of the integrator, all models together.")
      .def_property_readonly("completed", &CrushResponses::completed, "Number of models whose outcome is 'completed'.")
      .def("__len__", [](const CrushResponses& self) { return self.outcome.size(); });
  py::list table(py::make_tuple("outcome"));
  for (const MetricField& metric : kMetricFields) table.append(py::str(std::string(metric.name)));
  responses.attr("_columns") = py::tuple(table);
}

}  // namespace

void bind_simulate_many(py::module_& module) {
  bind_models(module);
  bind_responses(module);
  module.def(
      "simulate_many",
      [](const CrushModels& models, const py::kwargs& keywords) {
        const auto options = options_from<SimulateManyOptions>(keywords, "simulate_many");
        return unlocked([&] { return simulate_many(models, options); });
      },
      py::arg("models"),
      with_options_doc<SimulateManyOptions>(
          R"(Simulates the crush of many models from impact, as many at once as the processor has lanes and cores.

The numbers of a model depend neither on the other models nor on the threads. ``to_dataframe()`` of the result has a row
a model.

Parameters
----------
models : CrushModels
**options
    See below.

Returns
-------
CrushResponses
    Look at ``outcome``: numerical trouble is reported there, model by model.

Raises
------
InvalidInput
    On arrays that do not fit together, a bad value (named with its model) or a bad option.

Examples
--------
>>> import crashsim
>>> spring = crashsim.PiecewiseLinear([0.0], [8e5])
>>> car = crashsim.CrushModel(mass_kg=1200, spring=spring)
>>> models = crashsim.CrushModels(common=car, impact_speed_mps=[10.0, 12.0, 14.0])
>>> crashsim.simulate_many(models, samples=False).max_crush_m.round(3)
array([0.387, 0.465, 0.542]))")
          .c_str());
}

}  // namespace crashsim::python
