/// Which of the candidates that are fitted to recommend, and why.

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/simulate.hpp>

#include "optimize/effective_samples.hpp"
#include "optimize/fit_target.hpp"
#include "select_candidates.hpp"

namespace crashsim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSameByAicc = 2.0;    // [Burnham2002] section 2.6
constexpr double kSameScore = 0.1;     // of two tests, relative
constexpr double kLeastError = 1e-12;  // E below which a fit is perfect
constexpr std::size_t kMostNamed = 4;

bool has_model(const SelectionRow& row) { return row.outcome == IdentifyOutcome::completed; }

/// Effective number of observations, by the acceleration residuals of a model.
double observations_by(const CrushModel& model, std::span<const Pulse> pulses, const SelectOptions& options) {
  double count = 0.0;
  for (const Pulse& pulse : pulses) {
    const FitTarget target = make_target(pulse, options.mass_kg, options.weights);
    CrushModel tested = model;
    tested.mass_kg = target.mass_kg;
    SimulateOptions how;
    how.impact_speed_mps = target.impact_speed_mps;
    how.times_s = target.time_s;
    std::vector<double> residuals = simulate(tested, how).accel_mps2;
    residuals.resize(std::min(residuals.size(), target.accel_mps2.size()));
    for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] -= target.accel_mps2[i];
    count += effective_samples(residuals);
  }
  return count;
}

void set_aicc(std::span<const Pulse> pulses, const SelectOptions& options, Selection& selection) {
  const SelectionRow* best_fit = nullptr;
  for (const SelectionRow& row : selection.rows)
    if (has_model(row) && (best_fit == nullptr || row.error.total < best_fit->error.total)) best_fit = &row;
  if (best_fit == nullptr) return;
  const double n = selection.observations = observations_by(best_fit->model, pulses, options);
  const double power = options.loss == Loss::l2 ? 1.0 : 2.0;
  double least = kInfinity, sum = 0.0;
  for (SelectionRow& row : selection.rows) {
    if (!has_model(row)) continue;
    const double k = row.parameters + 1.0, left = n - k - 1.0;
    row.aicc = left > 0.0
                   ? power * n * std::log(std::max(row.error.total, kLeastError)) + 2.0 * k + 2.0 * k * (k + 1.0) / left
                   : kInfinity;
    least = std::min(least, row.aicc);
  }
  if (!std::isfinite(least)) return;
  for (SelectionRow& row : selection.rows) {
    if (!has_model(row)) continue;
    row.aicc_difference = row.aicc - least;
    row.aicc_weight = std::exp(-0.5 * row.aicc_difference);
    sum += row.aicc_weight;
  }
  for (SelectionRow& row : selection.rows) row.aicc_weight /= sum;
}

void set_prediction(SelectionRow& row) {
  double sum = 0.0;
  row.failures = 0;
  row.largest_crush_error = row.largest_t_m_error = 0.0;
  for (const LeftOutTest& test : row.left_out) {
    sum += test.score();
    if (test.failed()) ++row.failures;
    row.largest_t_m_error = test.failed() ? kInfinity : std::max(row.largest_t_m_error, std::fabs(test.t_m_error));
    if (std::isfinite(test.max_crush_error))
      row.largest_crush_error = std::max(row.largest_crush_error, std::fabs(test.max_crush_error));
    else
      row.largest_crush_error = kInfinity;
  }
  row.prediction_error = sum / static_cast<double>(row.left_out.size());
}

/// Mean difference of two rows' scores of the same tests, and its standard error.
void set_difference(const SelectionRow& best, SelectionRow& row) {
  const auto count = static_cast<double>(row.left_out.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < row.left_out.size(); ++i) sum += row.left_out[i].score() - best.left_out[i].score();
  row.difference_to_best = sum / count;
  for (std::size_t i = 0; i < row.left_out.size(); ++i) {
    const double deviation = row.left_out[i].score() - best.left_out[i].score() - row.difference_to_best;
    squares += deviation * deviation;
  }
  row.difference_deviation = std::sqrt(squares / (count * (count - 1.0)));
  // The deviation of two differences rests on one number: what is close then is what differs by little.
  const double close = row.left_out.size() > 2 ? row.difference_deviation : kSameScore * best.prediction_error;
  row.as_good_as_best = row.difference_to_best <= close;
}

/// What a row is sorted by: those without a model last, then as the criterion says, ties by the number of parameters.
std::tuple<bool, int, double, int> rank_of(const SelectionRow& row, bool by_prediction) {
  const double criterion = by_prediction ? row.prediction_error : row.aicc;
  return {!has_model(row), by_prediction ? row.failures : 0, std::isnan(criterion) ? kInfinity : criterion,
          row.parameters};
}

/// The simplest row that is as good as the best, the first one.
SelectionRow& choose(std::vector<SelectionRow>& rows) {
  SelectionRow* chosen = rows.data();
  for (SelectionRow& row : rows)
    if (row.as_good_as_best && row.parameters < chosen->parameters) chosen = &row;
  return *chosen;
}

std::string alternatives_to(const SelectionRow& chosen, const std::vector<SelectionRow>& rows, const char* by) {
  std::vector<std::string> names;
  std::size_t more = 0;
  for (const SelectionRow& row : rows) {
    if (!row.as_good_as_best || &row == &chosen) continue;
    if (names.size() < kMostNamed)
      names.push_back(row.name);
    else
      ++more;
  }
  if (names.empty()) return "";
  return fmt::format("; {} does not tell it apart from {}{}", by, fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

std::string why_by_prediction(const SelectionRow& chosen, const Selection& selection) {
  std::string why = fmt::format(
      "{}: tests left out are predicted with maximum crush within {:.1f} % and t_m within {:.1f} % (mean score {:.3f})",
      chosen.name, 100.0 * chosen.largest_crush_error, 100.0 * chosen.largest_t_m_error, chosen.prediction_error);
  if (&chosen != selection.rows.data())
    why += fmt::format("; fewer parameters ({}) than the best, {} ({}, score {:.3f}), within {}", chosen.parameters,
                       selection.rows.front().name, selection.rows.front().parameters,
                       selection.rows.front().prediction_error, selection.tests > 2 ? "one standard error" : "a tenth");
  why += alternatives_to(chosen, selection.rows, "prediction");
  if (selection.tests == 2)
    why += "; with two tests each is predicted from the other alone: a third test would say more";
  return why;
}

std::string why_by_aicc(const SelectionRow& chosen, const Selection& selection) {
  return fmt::format(
      "{}: least AICc of one test, {:.0f} effective observations for {} parameters{}; prediction was not "
      "tested: that needs a test at another speed",
      chosen.name, selection.observations, chosen.parameters, alternatives_to(chosen, selection.rows, "AICc"));
}

void recommend_by_prediction(Selection& selection) {
  const SelectionRow& best = selection.rows.front();
  if (!has_model(best) || best.failures > 0) {
    selection.outcome = SelectOutcome::nothing_usable;
    selection.message = has_model(best) ? fmt::format(
                                              "no candidate reaches maximum crush in every test that was left out; {} "
                                              "misses the fewest: {} of {}",
                                              best.name, best.failures, best.left_out.size())
                                        : fmt::format("no candidate could be fitted; {}: {}", best.name, best.message);
    return;
  }
  for (SelectionRow& row : selection.rows)
    if (has_model(row) && row.failures == 0) set_difference(best, row);
  SelectionRow& chosen = choose(selection.rows);
  chosen.recommended = true;
  selection.outcome = SelectOutcome::completed;
  selection.recommendation = why_by_prediction(chosen, selection);
}

void recommend_by_aicc(Selection& selection) {
  SelectionRow& best = selection.rows.front();
  if (!has_model(best) || !std::isfinite(best.aicc)) {
    selection.outcome = SelectOutcome::nothing_usable;
    selection.message =
        has_model(best) ? fmt::format("{:.0f} effective observations are too few for {} parameters: use fewer knots",
                                      selection.observations, best.parameters)
                        : fmt::format("no candidate could be fitted; {}: {}", best.name, best.message);
    return;
  }
  for (SelectionRow& row : selection.rows) row.as_good_as_best = row.aicc_difference <= kSameByAicc;
  best.recommended = true;
  selection.outcome = SelectOutcome::completed;
  selection.recommendation = why_by_aicc(best, selection);
}

}  // namespace

void judge_candidates(std::span<const Pulse> pulses, const SelectOptions& options, Selection& selection) {
  if (selection.rows.empty()) return;
  const bool by_prediction = pulses.size() > 1;
  set_aicc(pulses, options, selection);
  if (by_prediction)
    for (SelectionRow& row : selection.rows) set_prediction(row);
  std::stable_sort(selection.rows.begin(), selection.rows.end(), [&](const SelectionRow& a, const SelectionRow& b) {
    return rank_of(a, by_prediction) < rank_of(b, by_prediction);
  });
  if (by_prediction)
    recommend_by_prediction(selection);
  else
    recommend_by_aicc(selection);
}

}  // namespace crashsim
