#include <optional>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/select_model.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "pulse_argument.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_rows(py::module_& module) {
  ValueClass<LeftOutTest> left_out(module, "LeftOutTest",
                                   "A test that was left out, and what the fit to the others says of it.");
  left_out.field("impact_speed_mps", &LeftOutTest::impact_speed_mps, "Of the test [m/s].")
      .field("predicted", &LeftOutTest::predicted, "False: the fit to the others, or its simulation, failed.")
      .field("error", &LeftOutTest::error, "E on it.")
      .field("max_crush_m", &LeftOutTest::max_crush_m, "Predicted [m]; NaN when maximum crush is not reached.")
      .field("t_m_s", &LeftOutTest::t_m_s, "Predicted [s]; infinite when it is not reached.")
      .field("max_crush_error", &LeftOutTest::max_crush_error, "Predicted / measured - 1; NaN when it is not reached.")
      .field("t_m_error", &LeftOutTest::t_m_error, "Predicted / measured - 1; infinite when it is not reached.");
  left_out.def_property_readonly("failed", &LeftOutTest::failed, "Not predicted, or without t_m.")
      .def_property_readonly("score", &LeftOutTest::score,
                             "E plus the sizes of the errors of maximum crush and t_m; infinite when it failed.");
  using R = SelectionRow;
  ValueClass<R>(module, "SelectionRow", "One model that was tried.")
      .field("name", &R::name, "'crush_damping 7+1', with placement and curve where these are not the default.")
      .field("law", &R::law, "'stiffness', 'force', 'crush_damping' or 'rate'.")
      .field("spring_knots", &R::spring_knots, "Number of knots of the spring.")
      .field("damper_knots", &R::damper_knots, "Number of knots of the damper.")
      .field("placement", &R::placement, "'uniform', 'quantile' or 'free'.")
      .field("curve", &R::curve, "'linear' or 'pchip'.")
      .field("outcome", &R::outcome, "Of its identification.")
      .field("message", &R::message, "Why it has no model, or ''.")
      .field("model", &R::model, "CrushModel fitted to all tests.")
      .field("error", &R::error, "Its FitError.")
      .field("parameters", &R::parameters, "Free ones: neither at a bound nor without any sample that depends on them.")
      .field("identifiable", &R::identifiable, "True when every ordinate is determined.")
      .field("left_out", &R::left_out, "A LeftOutTest each; empty of one test.")
      .field("failures", &R::failures, "Of the tests left out.")
      .field("as_good_as_best", &R::as_good_as_best, "Cannot be told apart from the best.")
      .field("recommended", &R::recommended, "True of the one recommended.")
      .numbers(kSelectionNumbers);
}

void bind_selection(py::module_& module) {
  ValueClass<Selection> selection(module, "Selection", "What a selection gives.");
  selection
      .field("outcome", &Selection::outcome,
             "'not_run', 'completed', 'no_max_crush', 'interrupted' or 'nothing_usable'.")
      .field("message", &Selection::message, "Why it is not usable, or ''.")
      .field("recommendation", &Selection::recommendation, "In words.")
      .field("rows", &Selection::rows, "A SelectionRow each, best first.")
      .field("tests", &Selection::tests, "Number of tests.")
      .field("observations", &Selection::observations, "Effective number of observations, over all tests.")
      .field("seconds", &Selection::seconds, "Wall time [s].")
      .result();
  selection.def_property_readonly(
      "recommended",
      [](const Selection& self) -> std::optional<SelectionRow> {
        const SelectionRow* row = self.recommended();
        return row == nullptr ? std::nullopt : std::optional<SelectionRow>(*row);
      },
      "The SelectionRow recommended; None when there is none.");
}

}  // namespace

void bind_select(py::module_& module) {
  bind_rows(module);
  bind_selection(module);
  module.def(
      "select_model",
      [](const py::object& pulses, const py::object& progress, const py::kwargs& keywords) {
        const std::vector<Pulse> tests = pulses_of(pulses);
        const auto options = options_from<SelectOptions>(keywords, "select_model");
        return watched(
            progress, [&](const Progress& told) { return select_model(std::span<const Pulse>(tests), options, told); });
      },
      py::arg("pulses"), py::kw_only(), py::arg("progress") = py::none(),
      with_options_doc<SelectOptions>(
          R"(Chooses between crush models by what they predict.

Every combination of laws, numbers of knots, placements and curves is fitted to all pulses, and to all but each in turn,
whose motion is then predicted. Of several tests the candidate with the fewest parameters among those that predict about
as well as the best is recommended; of one test the least AICc, which says nothing of prediction.

Parameters
----------
pulses : Pulse or sequence of Pulse
    Tests of one structure.
progress : callable or tqdm bar, optional
    ``progress(done, total)`` is called now and then with the fits done; return False to stop. A tqdm bar is moved.
**options
    See below.

Returns
-------
Selection
    A pulse without t_m gives the outcome 'no_max_crush'.

Raises
------
InvalidInput
    On bad options, no candidate, or a pulse without mass.
KeyboardInterrupt
    On Ctrl-C.)")
          .c_str());
}

}  // namespace crashsim::python
