#include <string>

#include <crashsim/design.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_responses(py::module_& module) {
  ValueClass<DesignResponses>(
      module, "DesignResponses",
      "What a design is judged by; all NaN when its motion is not usable. The drop is the lowest "
      "heave's negative; olc_g is in g of 9.81 m/s^2.")
      .numbers(kDesignResponses);
  module.def("design_responses", &design_responses, py::arg("response"), py::call_guard<py::gil_scoped_release>(),
             R"(What a design is judged by, of a coupled motion.

Parameters
----------
response : CoupledResponse
    A simulated motion.

Returns
-------
DesignResponses
    All NaN when the motion is not usable.

Raises
------
TypeError
    When `response` is no CoupledResponse.
)");
  module.def(
      "quantity_of",
      [](const DesignResponses& responses, const std::string& quantity) {
        return quantity_of(responses, from_python<DesignQuantity>(py::str(quantity), "quantity"));
      },
      py::arg("responses"), py::arg("quantity"),
      R"(A quantity that can be minimised or limited, of a design's responses.

Parameters
----------
responses : DesignResponses
    Of a design.
quantity : {'none', 'pitch', 'drop', 'max_crush', 'olc', 'peak_decel'}
    Which one.

Returns
-------
float
    Pitch [rad], drop or crush [m], criterion or deceleration [g]; NaN for 'none'.

Raises
------
InvalidInput
    When there is no such quantity.
)");
}

void bind_parts(py::module_& module) {
  ValueClass<DesignVariable>(module, "DesignVariable", "One parameter of a design; numbers in its SI unit.")
      .field("name", &DesignVariable::name, "'force_height_m', 'k3_n_per_m', ...")
      .field("unit", &DesignVariable::unit, "SI symbol.")
      .field("lower", &DesignVariable::lower, "Lower bound [unit].")
      .field("upper", &DesignVariable::upper, "Upper bound [unit].")
      .field("before", &DesignVariable::before, "In the given model [unit].")
      .field("after", &DesignVariable::after, "At the optimum [unit].")
      .field("at_bound", &DesignVariable::at_bound, "Whether the optimum lies on a bound.");
  ValueClass<DesignSensitivity>(module, "DesignSensitivity",
                                "How one response of the given model reacts to one parameter.")
      .field("parameter", &DesignSensitivity::parameter, "Name of a DesignVariable.")
      .field("response", &DesignSensitivity::response, "Name of a field of DesignResponses.")
      .field("derivative", &DesignSensitivity::derivative,
             "d response / d parameter [SI]; NaN when a neighbouring design is not usable.")
      .field("error", &DesignSensitivity::error, "Estimate of its error [SI].")
      .field("relative", &DesignSensitivity::relative,
             "% of the response per % of the parameter; NaN where either is 0.");
  ValueClass<DesignLimit>(module, "DesignLimit", "A limit, and how the designs keep to it; numbers in SI units or g.")
      .field("quantity", &DesignLimit::quantity, "'pitch', 'drop', 'max_crush', 'olc' or 'peak_decel'.")
      .field("limit", &DesignLimit::limit, "Largest value allowed [rad, m or g].")
      .field("before", &DesignLimit::before, "Value of the given model [rad, m or g].")
      .field("after", &DesignLimit::after, "Value at the optimum [rad, m or g].")
      .field("active", &DesignLimit::active, "Whether the optimum lies on it.");
  ValueClass<TradeOffPoint>(
      module, "TradeOffPoint",
      "The optimum under one limit of the trade-off curve; values NaN or empty when there is none.")
      .field("limit", &TradeOffPoint::limit, "The limit [rad, m or g].")
      .field("feasible", &TradeOffPoint::feasible, "Whether a design keeps all limits.")
      .field("objective", &TradeOffPoint::objective, "The quantity minimised [rad, m or g].")
      .field("responses", &TradeOffPoint::responses, "DesignResponses of the optimum.")
      .field("values", &TradeOffPoint::values, "Values of the parameters [SI], read-only array.");
}

void bind_result(py::module_& module) {
  using R = DesignResult;
  ValueClass<R>(module, "DesignResult", "What a design study gives.")
      .field("outcome", &R::outcome, "'not_run', 'completed', 'infeasible', 'model_failed' or 'interrupted'.")
      .field("message", &R::message, "Why it is not usable, or ''.")
      .field("variables", &R::variables, "A DesignVariable each, in the order of `parameters`.")
      .field("sensitivities", &R::sensitivities, "A DesignSensitivity each, of the given model, by parameter.")
      .field("before", &R::before, "DesignResponses of the given model.")
      .field("after", &R::after,
             "DesignResponses at the optimum; when infeasible, of the design nearest to the limits.")
      .field("minimised", &R::minimised, "Quantity that was minimised.")
      .field("limits", &R::limits, "A DesignLimit each.")
      .field("optimum", &R::optimum, "CoupledModel of the optimum; the given one where nothing was minimised.")
      .field("traded", &R::traded, "Quantity whose limit varies along the trade-off curve.")
      .field("trade_off", &R::trade_off, "A TradeOffPoint each, by increasing limit.")
      .field("starts", &R::starts, "Optimisations from different designs.")
      .field("starts_at_best", &R::starts_at_best, "Starts within 0.1 % of the best.")
      .field("simulations", &R::simulations, "Simulations it took.")
      .field("seconds", &R::seconds, "Wall time [s].")
      .field("warnings", &R::warnings, "What a careful reader should know.")
      .result();
}

}  // namespace

void bind_design(py::module_& module) {
  bind_responses(module);
  bind_parts(module);
  bind_result(module);
  module.def(
      "design",
      [](const CoupledModel& model, const py::object& progress, const py::kwargs& keywords) {
        const auto [options, simulation] = options_of<DesignOptions, CoupledOptions>(keywords, "design");
        return watched(progress, [&, &chosen = options, &how = simulation](const Progress& told) {
          return design(model, chosen, how, told);
        });
      },
      py::arg("model"), py::kw_only(), py::arg("progress") = py::none(),
      with_options_doc<DesignOptions, CoupledOptions>(
          R"(Sensitivities of crush, pitch and drop to a model's numbers, and the best numbers under limits.

A parameter is a number of HeavePitchModel or VerticalForceLaw by name (``force_height_m``, ``angle_rad``), or an ordinate
of the crush curves: ``k1``, ``k2``, .. of the spring, ``c1``, ``c2``, .. of the damper, in the order of the knots.
Sensitivities are central differences, extrapolated to a step of 0 (Ridders); the optimum is of NLopt's SLSQP from each
start, then COBYLA from the best; the trade-off curve is the same under each limit.

Parameters
----------
model : CoupledModel
    The design to start from.
progress : callable, optional
    ``progress(done, total)`` is called now and then; return False to stop.
**options
    See below; `parameters` is needed. `rtol` is not used: all simulations have 1e-10.

Returns
-------
DesignResult

Raises
------
InvalidInput
    On a bad model or option, an unknown parameter, or one that the model leaves unset.
KeyboardInterrupt
    On Ctrl-C.)")
          .c_str());
}

}  // namespace crashsim::python
