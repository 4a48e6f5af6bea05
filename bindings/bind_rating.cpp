#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <crashsim/comparison.hpp>
#include <crashsim/coupled_columns.hpp>
#include <crashsim/rating.hpp>
#include <crashsim/redundancy.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/units.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

/// Names of the curves that pulses, responses and measured motions have.
std::vector<std::string> curve_names() {
  std::vector<std::string> names = {"accel_mps2", "velocity_mps", "displacement_m", "spring_force_n", "damper_force_n"};
  const auto add = [&names](const auto& columns) {
    for (const auto& column : columns)
      if (column.name != "time_s" && std::find(names.begin(), names.end(), column.name) == names.end())
        names.emplace_back(column.name);
  };
  add(kCoupledColumns);
  add(kPitchColumns);
  return names;
}

/// A curve of an object: a series of its own, or an array over the object's time_s. Empty when it has none.
TimeSeries curve_of(const py::object& motion, const std::string& name) {
  if (!py::hasattr(motion, name.c_str())) return {};
  const py::object values = motion.attr(name.c_str());
  return series_from(py::isinstance<TimeSeries>(values) ? values : py::make_tuple(motion.attr("time_s"), values), name);
}

/// The caller's set, which the caller keeps; any other object's curves as a set.
std::shared_ptr<const TraceSet> traces_of(const py::object& motion, const std::string& role) {
  if (py::isinstance<TraceSet>(motion)) return {std::shared_ptr<const TraceSet>(), &motion.cast<const TraceSet&>()};
  TraceSet set;
  set.path = role;
  if (py::hasattr(motion, "mass_kg")) set.mass_kg = number_or_unset(motion.attr("mass_kg"), "kg", role + ".mass_kg");
  for (const std::string& name : curve_names()) {
    TimeSeries curve = curve_of(motion, name);
    if (curve.empty()) continue;
    Trace trace;
    trace.id = trace.name = name;
    trace.dimension = dimension_of(unit_of_name(name));
    trace.time_s = std::make_shared<const std::vector<double>>(std::move(curve.time_s));
    trace.values = std::move(curve.values);
    set.traces.push_back(std::move(trace));
  }
  if (set.traces.empty())
    throw py::type_error(
        role + ": " + std::string(py::str(py::type::of(motion))) +
        " has no curves; give a TraceSet, a Pulse, a response or an object with time_s and accel_mps2");
  return std::make_shared<const TraceSet>(std::move(set));
}

Comparison compare_motions(const py::object& reference, const py::object& candidate, const CompareOptions& options) {
  const auto test = traces_of(reference, "reference"), model = traces_of(candidate, "candidate");
  return unlocked([&] { return compare(*test, *model, options); });
}

Rating rate_channel(const py::object& reference, const py::object& candidate, const CompareOptions& options) {
  const Comparison comparison = compare_motions(reference, candidate, options);
  if (comparison.channels.size() != 1)
    throw InvalidInput("channel = \"" + options.channels.front() + "\": " + std::to_string(comparison.channels.size()) +
                       " channels to rate; compare() rates several");
  const ChannelComparison& channel = comparison.channels.front();
  if (!channel.not_rated.empty()) throw InvalidInput(channel.name + ": " + channel.not_rated);
  return channel.rating;
}

void bind_scores(py::module_& module) {
  ValueClass<Rating>(module, "Rating", "Scores of ISO/TS 18571, each 0..1; overall R = 0.4 Z + 0.2 (EP + EM + ES).")
      .numbers(kRatingFields)
      .def_property_readonly(
          "grade", [](const Rating& self) { return std::string(grade(self.overall)); },
          "'excellent', 'good', 'fair', 'poor' or 'unrated'.");
  ValueClass<ErrorSummary>(module, "ErrorSummary",
                           "Errors of a candidate against a reference on the same samples, in the channel's unit.")
      .numbers(kErrorFields);
  module.def(
      "grade", [](double overall) { return std::string(grade(overall)); }, py::arg("overall"),
      R"(Grade of an overall rating, ISO/TS 18571.

Parameters
----------
overall : float
    Rating R, 0..1, or NaN.

Returns
-------
str
    'excellent' (> 0.94), 'good' (> 0.80), 'fair' (> 0.58), 'poor', or 'unrated' for NaN.

Raises
------
TypeError
    When it is no number.
)");
  module.def(
      "errors",
      [](const py::object& reference, const py::object& candidate) {
        const Doubles test(reference, "reference"), model(candidate, "candidate");
        return errors(test.view(), model.view());
      },
      py::arg("reference"), py::arg("candidate"),
      R"(Mean, root mean square and largest error of a candidate.

Parameters
----------
reference : array_like of shape (n,)
    Samples of the test, any unit.
candidate : array_like of shape (n,)
    Samples of the model at the same times, same unit.

Returns
-------
ErrorSummary

Raises
------
InvalidInput
    When lengths differ, there are no samples or a value is not finite.
)");
}

void bind_rate(py::module_& module) {
  module.def(
      "rate",
      [](const py::object& reference, const py::object& candidate, const py::object& dt_s, const std::string& channel,
         const py::object& start_s, const py::object& end_s) {
        if (dt_s.is_none())
          return rate_channel(
              reference, candidate,
              {{channel}, number_or_unset(start_s, "s", "start_s"), number_or_unset(end_s, "s", "end_s")});
        const Doubles test(reference, "reference"), model(candidate, "candidate");
        const double step = number_or_unset(dt_s, "s", "dt_s");
        return unlocked([&] { return rate(test.view(), model.view(), step); });
      },
      py::arg("reference"), py::arg("candidate"), py::arg("dt_s") = py::none(), py::kw_only(),
      py::arg("channel") = "accel_mps2", py::arg("start_s") = py::none(), py::arg("end_s") = py::none(),
      R"(Objective rating of a model's curve against a test's, ISO/TS 18571.

Two arrays sampled alike are rated with `dt_s`. Of two motions, without `dt_s`, one channel is rated over the time that
they have in common, the candidate interpolated at the reference's samples. Another rate than the 10 kHz of the
standard is brought to it by linear interpolation.

Parameters
----------
reference : array_like of shape (n,), Pulse, response or TraceSet
    The test.
candidate : array_like of shape (n,), Pulse, response or TraceSet
    The model.
dt_s : float or str, optional
    Sampling interval of arrays [s], > 0; 10 samples to 2 s.
channel : str
    Channel of motions to rate.
start_s, end_s : float or str, optional
    Range of motions to rate [s]; all that they have in common by default.

Returns
-------
Rating

Raises
------
InvalidInput
    When lengths differ, there are fewer than 10 samples or more than 2 s of them, a value is not finite, `dt_s` is not
    > 0, the reference is zero throughout, or the motions have no such channel or no time in common.
)");
}

std::vector<MetricComparison> compare_metrics_of(const py::object& reference, const py::object& candidate) {
  const auto test = traces_of(reference, "reference"), model = traces_of(candidate, "candidate");
  return unlocked([&] { return compare_metrics(*test, *model); });
}

void bind_metric_comparison(py::module_& module) {
  using M = MetricComparison;
  ValueClass<M>(module, "MetricComparison", "One metric of a reference's motion beside the candidate's.")
      .field("name", &M::name, "As in Metrics: 'max_crush_m'.")
      .field("doc", &M::doc, "For people: 'maximum dynamic crush'.")
      .field("reference", &M::reference, "Of the reference, in the unit of its name; NaN where it does not exist.")
      .field("candidate", &M::candidate, "Of the candidate.")
      .field("difference", &M::difference, "(candidate - reference) / abs(reference).");
  module.def("compare_metrics", &compare_metrics_of, py::arg("reference"), py::arg("candidate"),
             R"(All metrics of two motions side by side, each from time 0 to its own end.

Parameters
----------
reference : TraceSet, Pulse, response or alike
    The test: any object with accel_mps2, velocity_mps and displacement_m over time_s.
candidate : TraceSet, Pulse, response or alike
    The model.

Returns
-------
list of MetricComparison
    In the order of Metrics; empty when a trace set holds no motion towards the barrier.

Raises
------
InvalidInput
    When a motion has a missing value.
TypeError
    When an object has no curves at all.
)");
}

void bind_comparison(py::module_& module) {
  ValueClass<ChannelComparison>(module, "ChannelComparison", "One channel compared, over the samples of the reference.")
      .field("name", &ChannelComparison::name, "As the reference calls it.")
      .field("unit", &ChannelComparison::unit, "SI symbol of its errors.")
      .field("errors", &ChannelComparison::errors, "Errors of the candidate, an ErrorSummary.")
      .field("rating", &ChannelComparison::rating, "ISO/TS 18571, a Rating; NaN when it does not apply.")
      .field("not_rated", &ChannelComparison::not_rated, "Why it does not apply, or ''.");
  ValueClass<Comparison>(module, "Comparison", "A model's curves against a test's, channel by channel.")
      .field("start_s", &Comparison::start_s, "Start of the range compared [s].")
      .field("end_s", &Comparison::end_s, "End of the range compared [s].")
      .field("dt_s", &Comparison::dt_s, "Sampling interval compared at [s].")
      .field("channels", &Comparison::channels, "Every ChannelComparison, in the reference's order.")
      .field("notes", &Comparison::notes, "What a careful reader should know.");
  ValueClass<NamedComparison>(module, "NamedComparison", "One comparison of several.")
      .field("name", &NamedComparison::name, "Name in files: 'to_max_crush'.")
      .field("doc", &NamedComparison::doc, "For people: 'to maximum crush'.")
      .field("result", &NamedComparison::result, "The Comparison.");
  module.def(
      "compare",
      [](const py::object& reference, const py::object& candidate, const py::kwargs& keywords) {
        return compare_motions(reference, candidate, options_from<CompareOptions>(keywords, "compare"));
      },
      py::arg("reference"), py::arg("candidate"),
      with_options_doc<CompareOptions>(R"(Compares the curves of the same name that a model and a test both have.

Of trace sets a unit suffix may differ (``accel_g`` and ``accel_mps2``). The candidate is interpolated linearly at the
reference's samples; a reference with non-uniform steps is first brought to uniform ones.

Parameters
----------
reference : TraceSet, Pulse, response, MeasuredMotion or alike
    The test: any object with curves such as ``accel_mps2`` over ``time_s``.
candidate : TraceSet, Pulse, response or alike
    The model.
**options
    See below.

Returns
-------
Comparison

Raises
------
InvalidInput
    When they have no channel or no time in common, or a channel has a missing value.)")
          .c_str());
}

}  // namespace

void bind_rating(py::module_& module) {
  bind_scores(module);
  bind_rate(module);
  bind_comparison(module);
  bind_metric_comparison(module);
  module.def("check_redundant", &check_redundant, py::arg("traces"), py::call_guard<py::gil_scoped_release>(),
             R"(Findings of redundant channels, and of the compartment's two sides, that should agree and do not.

Each redundant channel (CHSTAT R) is compared with the primary one of the same vehicle, seat, sensor, place, axis and
unit, and the longitudinal channels of the compartment with each other by their change of speed. Signals are filtered
by CFC60 where their rate allows. Only channels that were read and are not flagged bad are compared.

Parameters
----------
traces : TraceSet
    Channels read, as by read_traces.

Returns
-------
list of str
    One sentence a finding: a difference beyond 10 % (RMS), 2 % (offset), 1 ms (shift) or 5 % (change of speed).

Raises
------
TypeError
    When `traces` is no TraceSet.
)");
}

}  // namespace crashsim::python
