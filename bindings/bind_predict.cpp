#include <string>

#include <pybind11/stl.h>

#include <crashsim/model_io.hpp>
#include <crashsim/predict.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_basis(py::module_& module) {
  ValueClass<PredictionBasis>(module, "PredictionBasis",
                              "What predictions rest on: a model, its tests, and other models that these allow.")
      .field("model", &PredictionBasis::model, "CrushModel.")
      .field("tests", &PredictionBasis::tests, "A TestReport each that it was identified from.")
      .field("verdict", &PredictionBasis::verdict, "Verdict of the identification.")
      .field("replicates", &PredictionBasis::replicates, "CrushModels, a row each; none: no bands.")
      .field("level", &PredictionBasis::level, "Probability that the bands stand for.");
}

/// A row a speed: speed, outcome, what is extrapolated, every metric with its band.
py::dict table_of(const SpeedPrediction& self) {
  py::dict table;
  const auto add = [&](const std::string& name, const auto& get) {
    py::list column;
    for (const PredictedSpeed& speed : self.speeds) column.append(get(speed));
    table[py::str(name)] = column;
  };
  add("impact_speed_mps", [](const PredictedSpeed& speed) { return py::float_(speed.impact_speed_mps); });
  add("outcome", [](const PredictedSpeed& speed) { return py::str(std::string(name_of(speed.outcome))); });
  add("extrapolated", [](const PredictedSpeed& speed) { return py::bool_(speed.extrapolated()); });
  for (const MetricField& metric : kMetricFields) {
    const std::string name(metric.name);
    add(name, [&](const PredictedSpeed& speed) { return py::float_(speed.value.*metric.member); });
    add(name + "_low", [&](const PredictedSpeed& speed) { return py::float_(speed.low.*metric.member); });
    add(name + "_high", [&](const PredictedSpeed& speed) { return py::float_(speed.high.*metric.member); });
  }
  return table;
}

void bind_prediction(py::module_& module) {
  ValueClass<PredictedCurve>(module, "PredictedCurve", "A channel of the motion with its band.")
      .field("value", &PredictedCurve::value, "Of the model.")
      .field("low", &PredictedCurve::low, "Lower end of the band; empty without replicates.")
      .field("high", &PredictedCurve::high, "Its upper end.");
  using S = PredictedSpeed;
  ValueClass<S> speed(module, "PredictedSpeed", "What is said of one speed.");
  speed.field("impact_speed_mps", &S::impact_speed_mps, "[m/s]")
      .field("outcome", &S::outcome, "Of the model itself: see CrushResponse.outcome.")
      .field("value", &S::value, "Metrics of the model itself.")
      .field("low", &S::low, "Metrics: lower ends of the bands; NaN where there is none.")
      .field("high", &S::high, "Metrics: upper ends.")
      .field("without_max_crush", &S::without_max_crush, "Share of the replicates that never come to rest.")
      .field("outside_speeds", &S::outside_speeds, "Slower or faster than every test, or nothing is known of tests.")
      .field("beyond_crush", &S::beyond_crush, "Crushes deeper than any test; where none is known, than the last knot.")
      .field("reasons", &S::reasons, "Why it is to be taken with care, in words.")
      .field("time_s", &S::time_s, "Of the curves [s]; empty without `curves`.")
      .field("accel_mps2", &S::accel_mps2, "PredictedCurve [m/s^2].")
      .field("velocity_mps", &S::velocity_mps, "PredictedCurve [m/s].")
      .field("displacement_m", &S::displacement_m, "PredictedCurve of the crush [m].");
  speed.def_property_readonly("extrapolated", &S::extrapolated, "Outside the speeds or beyond the crush of the tests.");
  ValueClass<SpeedPrediction>(module, "SpeedPrediction", "Predictions at several speeds, in the order asked.")
      .field("speeds", &SpeedPrediction::speeds, "A PredictedSpeed each.")
      .field("replicates", &SpeedPrediction::replicates, "Behind the bands; 0: there are none.")
      .field("level", &SpeedPrediction::level, "Probability that the bands stand for; NaN without.")
      .field("mass_kg", &SpeedPrediction::mass_kg, "Test mass [kg].")
      .field("message", &SpeedPrediction::message, "What the predictions rest on, in words.")
      .result()
      .def("_table", &table_of);
}

PredictionBasis basis_of(const py::object& model, const py::object& uncertainty) {
  const bool has_uncertainty = !uncertainty.is_none();
  if (py::isinstance<Identification>(model))
    return prediction_basis(model.cast<const Identification&>(),
                            has_uncertainty ? uncertainty.cast<const Uncertainty&>() : Uncertainty{});
  if (has_uncertainty) throw py::type_error("uncertainty: goes with an Identification, of which it is");
  if (py::isinstance<PredictionBasis>(model)) return model.cast<PredictionBasis>();
  if (!py::isinstance<CrushModel>(model)) return read_prediction_basis(path_text(model));
  PredictionBasis basis;
  basis.model = model.cast<CrushModel>();
  return basis;
}

/// A speed as PredictOptions spells it.
std::string speed_text(const py::handle& speed) {
  if (py::isinstance<py::str>(speed)) return py::str(speed);
  return py::repr(py::float_(py::reinterpret_borrow<py::object>(speed)));
}

std::vector<std::string> speed_texts(const py::object& speeds) {
  if (speeds.is_none()) return {};
  if (py::isinstance<py::str>(speeds) || !py::isinstance<py::iterable>(speeds)) return {speed_text(speeds)};
  std::vector<std::string> texts;
  for (const py::handle speed : speeds) texts.push_back(speed_text(speed));
  return texts;
}

}  // namespace

void bind_predict(py::module_& module) {
  bind_basis(module);
  bind_prediction(module);
  module.def(
      "read_prediction_basis", [](const py::object& path) { return read_prediction_basis(path_text(path)); },
      py::arg("path"),
      R"(Reads model.json with the tests and replicates that predictions rest on.

Parameters
----------
path : str or os.PathLike

Returns
-------
PredictionBasis
    Without replicates where the file has none.

Raises
------
InvalidInput
    Naming the file, the field and the rule it breaks.)");
  module.def(
      "predict",
      [](const py::object& model, const py::object& speeds, const py::object& uncertainty, const py::kwargs& keywords) {
        const PredictionBasis basis = basis_of(model, uncertainty);
        auto options = options_from<PredictOptions>(keywords, "predict");
        options.speeds = speed_texts(speeds);
        return unlocked([&] { return predict(basis, options); });
      },
      py::arg("model"), py::arg("speeds") = py::none(), py::kw_only(), py::arg("uncertainty") = py::none(),
      with_options_doc<PredictOptions>(
          R"(Predicts crush, t_m and all metrics at other speeds, with bands where the model carries replicates.

Parameters
----------
model : str, os.PathLike, PredictionBasis, Identification or CrushModel
    A model.json, or what is in one. A CrushModel has no bands.
speeds : float, str or sequence of them, optional
    [m/s], or texts with a unit and ranges: "48km/h", "40km/h..72km/h:9". Those of the tests when not given.
uncertainty : Uncertainty, optional
    Of the Identification: its replicates give the bands.
**options
    See below.

Returns
-------
SpeedPrediction

Raises
------
InvalidInput
    On a bad model, option or speed, or when no speed is known.)")
          .c_str());
}

}  // namespace crashsim::python
