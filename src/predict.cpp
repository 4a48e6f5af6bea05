#include <crashsim/predict.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/simulate_many.hpp>

#include "bands.hpp"
#include "number_list.hpp"

namespace crashsim {
namespace {

constexpr double kSameSpeed = 1e-3;  // relative: as tests of one speed differ
constexpr double kSameCrush = 1e-2;  // relative: deeper than that is beyond
constexpr int kSpeedsOfRange = 9;    // where a range says none
constexpr double kKmhPerMps = 3.6;
constexpr double kNotable = 0.005;  // share of replicates worth a word

/// Tests that the model was identified from, as far as known.
std::vector<TestReport> known_tests(const PredictionBasis& basis) {
  if (!basis.tests.empty() || std::isnan(basis.model.impact_speed_mps)) return basis.tests;
  TestReport test;
  test.impact_speed_mps = basis.model.impact_speed_mps;
  return {test};
}

SimulateManyOptions many_options(const PredictOptions& options, bool with_samples) {
  SimulateManyOptions many;
  many.end_time_s = options.end_time_s;
  many.dt_s = options.dt_s;
  many.rtol = options.rtol;
  many.samples = with_samples;
  many.metrics = ManyMetrics::all;
  many.jobs = options.jobs;
  return many;
}

void judge_speed(const std::vector<TestReport>& tests, PredictedSpeed& out) {
  if (tests.empty()) {
    out.outside_speeds = true;
    out.reasons.emplace_back("the model does not say at which speeds it was identified");
    return;
  }
  const auto [slow, fast] = std::ranges::minmax(tests, {}, &TestReport::impact_speed_mps);
  const double low = slow.impact_speed_mps, high = fast.impact_speed_mps, speed = out.impact_speed_mps;
  if (speed >= low * (1.0 - kSameSpeed) && speed <= high * (1.0 + kSameSpeed)) return;
  out.outside_speeds = true;
  const std::string range =
      low == high ? fmt::format("speed identified, {:.1f} km/h", kKmhPerMps * low)
                  : fmt::format("speeds identified, {:.1f}..{:.1f} km/h", kKmhPerMps * low, kKmhPerMps * high);
  out.reasons.push_back(fmt::format("{} than the {}", speed < low ? "slower" : "faster", range));
}

/// Whether any test reached so far; where none is known, any knot.
void judge_crush(const PredictionBasis& basis, const std::vector<TestReport>& tests, PredictedSpeed& out) {
  const double crush = out.value.max_crush_m;
  if (std::isnan(crush)) return;
  double seen = kUnset;
  for (const TestReport& test : tests) seen = std::fmax(seen, test.max_crush_m);
  const std::vector<double>& knots = basis.model.spring.knots;
  const auto judge = [&](double limit, const char* what) {
    if (!(crush > limit * (1.0 + kSameCrush))) return;
    out.beyond_crush = true;
    out.reasons.push_back(fmt::format("crush {:.3f} m is beyond {}, {:.3f} m", crush, what, limit));
  };
  if (!std::isnan(seen))
    judge(seen, "the deepest seen");
  else if (knots.size() > 1)
    judge(knots.back(), "the last knot of the spring");
}

/// Band of a metric; one that ends of its own when the vehicle never comes to rest has no upper end.
void set_band(const CrushResponses& runs, const MetricField& field, double level, PredictedSpeed& out) {
  const bool needs_rest = field.name == "t_m_s" || field.name == "max_crush_m";
  std::vector<double> values;
  for (std::size_t i = 0; i < runs.metrics.size(); ++i) {
    const double value = runs.metrics[i].*field.member;
    const bool never = needs_rest && runs.outcome[i] == CrushOutcome::no_max_crush;
    values.push_back(never ? std::numeric_limits<double>::infinity() : value);
  }
  const auto [low, high] = interval_of(values, level);
  out.low.*field.member = std::isfinite(low) ? low : kUnset;
  out.high.*field.member = std::isfinite(high) ? high : kUnset;
}

void set_curve_band(const RowMatrix& rows, double level, PredictedCurve& out) {
  band_of(rows, level, out.low, out.high);
}

void add_bands(const PredictionBasis& basis, const PredictOptions& options, double level, PredictedSpeed& out) {
  CrushModels ensemble = basis.replicates;
  ensemble.common.mass_kg = std::isnan(options.mass_kg) ? basis.model.mass_kg : options.mass_kg;
  ensemble.common.impact_speed_mps = out.impact_speed_mps;
  const CrushResponses runs = simulate_many(ensemble, many_options(options, options.curves));
  const auto never = std::count(runs.outcome.begin(), runs.outcome.end(), CrushOutcome::no_max_crush);
  out.without_max_crush = static_cast<double>(never) / static_cast<double>(runs.outcome.size());
  for (const MetricField& field : kMetricFields) set_band(runs, field, level, out);
  if (out.without_max_crush > kNotable)
    out.reasons.push_back(fmt::format("{:.0f} % of the replicates do not come to rest by {:.4g} s",
                                      100.0 * out.without_max_crush, runs.time_s.back()));
  if (!options.curves) return;
  set_curve_band(runs.accel_mps2, level, out.accel_mps2);
  set_curve_band(runs.velocity_mps, level, out.velocity_mps);
  set_curve_band(runs.displacement_m, level, out.displacement_m);
}

std::vector<double> only_row(const RowMatrix& rows) { return {rows.data(), rows.data() + rows.size()}; }

PredictedSpeed predict_speed(const PredictionBasis& basis, const PredictOptions& options, double level, double speed) {
  PredictedSpeed out;
  out.impact_speed_mps = speed;
  CrushModels own;
  own.common = basis.model;
  own.common.impact_speed_mps = speed;
  if (!std::isnan(options.mass_kg)) own.common.mass_kg = options.mass_kg;
  const CrushResponses run = simulate_many(own, many_options(options, options.curves));
  out.outcome = run.outcome.front();
  out.value = run.metrics.front();
  const std::vector<TestReport> tests = known_tests(basis);
  judge_speed(tests, out);
  judge_crush(basis, tests, out);
  if (out.outcome == CrushOutcome::no_max_crush)
    out.reasons.push_back(fmt::format("the model does not come to rest by {:.4g} s", run.time_s.back()));
  else if (out.outcome != CrushOutcome::completed)
    out.reasons.push_back(fmt::format("the simulation ended as {}", name_of(out.outcome)));
  if (options.curves) {
    out.time_s = run.time_s;
    out.accel_mps2.value = only_row(run.accel_mps2);
    out.velocity_mps.value = only_row(run.velocity_mps);
    out.displacement_m.value = only_row(run.displacement_m);
  }
  if (replicate_count(basis.replicates) > 0) add_bands(basis, options, level, out);
  return out;
}

std::string explain(const PredictionBasis& basis, std::size_t replicates, double level) {
  std::string text = replicates > 0
                         ? fmt::format(
                               "bands hold {:.4g} % of {} replicates of the fit: what the noise of its tests "
                               "allows, not what the model cannot follow",
                               100.0 * level, replicates)
                         : "no bands: the model carries no ensemble; identify writes one with the model";
  if (!basis.verdict.message.empty() && !basis.verdict.identifiable) {
    const std::vector<TestReport> tests = known_tests(basis);
    const bool one_speed = !tests.empty() && std::ranges::all_of(tests, [&](const TestReport& test) {
      return std::fabs(test.impact_speed_mps - tests[0].impact_speed_mps) <= kSameSpeed * tests[0].impact_speed_mps;
    });
    text += fmt::format(
        "; the identification{} did not determine the ordinates: at other speeds only the bands tell "
        "what is known ({})",
        one_speed ? " from one speed" : "", basis.verdict.message);
  }
  return text;
}

}  // namespace

PredictionBasis prediction_basis(const Identification& fit, const Uncertainty& uncertainty) {
  PredictionBasis basis{fit.model, fit.tests, fit.verdict, uncertainty.replicates, 0.95};
  if (!std::isnan(uncertainty.level)) basis.level = uncertainty.level;
  return basis;
}

bool SpeedPrediction::usable() const {
  return !speeds.empty() &&
         std::ranges::all_of(speeds, [](const PredictedSpeed& row) { return row.outcome == CrushOutcome::completed; });
}

std::string SpeedPrediction::brief_report() const {
  if (speeds.empty()) return "not run";
  const auto beyond = std::ranges::count_if(speeds, [](const PredictedSpeed& row) { return row.extrapolated(); });
  return fmt::format("{} speeds, {} of them extrapolated; {}", speeds.size(), beyond, message);
}

std::vector<double> speeds_of(const PredictOptions& options, const PredictionBasis& basis) {
  std::vector<std::string> texts = options.speeds;
  for (std::string& text : texts)
    if (text.find("..") != std::string::npos && text.rfind(':') == std::string::npos)
      text += fmt::format(":{}", kSpeedsOfRange);
  std::vector<double> speeds = listed_numbers(texts, "m/s", "PredictOptions.speeds");
  if (speeds.empty())
    for (const TestReport& test : known_tests(basis)) speeds.push_back(test.impact_speed_mps);
  if (speeds.empty())
    throw InvalidInput(
        "PredictOptions.speeds: none given, and the model does not say at which it was identified: give the speeds to "
        "predict");
  for (std::size_t i = 0; i < speeds.size(); ++i)
    if (!detail::in_range(speeds[i], positive()))
      detail::throw_out_of_range(fmt::format("PredictOptions.speeds[{}]", i), speeds[i], "m/s", positive());
  return speeds;
}

SpeedPrediction predict(const PredictionBasis& basis, const PredictOptions& options) {
  validate_options(options, "PredictOptions");
  SpeedPrediction out;
  out.mass_kg = std::isnan(options.mass_kg) ? basis.model.mass_kg : options.mass_kg;
  out.replicates = replicate_count(basis.replicates);
  const double level = std::isnan(options.level) ? basis.level : options.level;
  if (out.replicates > 0) out.level = level;
  for (const double speed : speeds_of(options, basis))
    out.speeds.push_back(predict_speed(basis, options, level, speed));
  out.message = explain(basis, out.replicates, level);
  return out;
}

}  // namespace crashsim
