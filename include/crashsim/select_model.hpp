#pragma once
/// Choice between crush models by what they predict.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/named_number.hpp>
#include <crashsim/record.hpp>
#include <crashsim/select_options.hpp>

namespace crashsim {

/// A test that was left out, and what the model fitted to the others says of it.
struct LeftOutTest {
  double impact_speed_mps = kUnset;  ///< Of the test [m/s].
  bool predicted = false;            ///< False: the fit to the others, or its simulation, failed.
  double error = kUnset;             ///< E on it.
  double max_crush_m = kUnset;       ///< Predicted [m]; unset when maximum crush is not reached.
  double t_m_s = kUnset;             ///< Predicted [s]; infinite when it is not reached.
  double max_crush_error = kUnset;   ///< Predicted / measured - 1; unset when it is not reached.
  double t_m_error = kUnset;         ///< Predicted / measured - 1; infinite when it is not reached.

  [[nodiscard]] bool failed() const;   ///< Not predicted, or without t_m.
  [[nodiscard]] double score() const;  ///< E + |error of maximum crush| + |error of t_m|; infinite when it failed.
};

/// One model that was tried.
struct SelectionRow {
  std::string name;  ///< "crush_damping 7+1", with the placement and the curve where these are not the default.
  CrushLaw law = CrushLaw::stiffness;
  int spring_knots = 0, damper_knots = 0;
  KnotPlacement placement = KnotPlacement::uniform;
  Curve curve = Curve::linear;
  IdentifyOutcome outcome = IdentifyOutcome::not_run;
  std::string message;  ///< Why it has no model, or empty.
  CrushModel model;     ///< Fitted to all tests.
  FitError error;       ///< Its E.
  int parameters = 0;   ///< Free ones: neither at a bound nor without any sample that depends on them.
  bool identifiable = false;
  double aicc = kUnset;             ///< Infinite when there are not enough observations for its parameters.
  double aicc_difference = kUnset;  ///< To the least of all.
  double aicc_weight = kUnset;      ///< Akaike weight, 0..1.
  std::vector<LeftOutTest> left_out;
  int failures = 0;                      ///< Of the tests left out.
  double prediction_error = kUnset;      ///< Mean score of the tests left out.
  double largest_crush_error = kUnset;   ///< Of the tests left out, absolute and relative.
  double largest_t_m_error = kUnset;     ///< Of the tests left out, absolute and relative.
  double difference_to_best = kUnset;    ///< Of prediction_error, to the least.
  double difference_deviation = kUnset;  ///< Standard error of this difference, from that of each test.
  bool as_good_as_best = false;          ///< Within one standard error, a tenth or 2 in AICc.
  bool recommended = false;
};
inline constexpr std::array<NamedNumber<SelectionRow>, 8> kSelectionNumbers = {{
    {"prediction_error", &SelectionRow::prediction_error, "mean score of the tests left out"},
    {"largest_crush_error", &SelectionRow::largest_crush_error, "largest relative error of maximum crush there"},
    {"largest_t_m_error", &SelectionRow::largest_t_m_error, "largest relative error of t_m there"},
    {"difference_to_best", &SelectionRow::difference_to_best, "of the prediction error, to the least"},
    {"difference_deviation", &SelectionRow::difference_deviation, "its standard error"},
    {"aicc", &SelectionRow::aicc, "corrected Akaike information criterion"},
    {"aicc_difference", &SelectionRow::aicc_difference, "to the least"},
    {"aicc_weight", &SelectionRow::aicc_weight, "Akaike weight"},
}};

enum class SelectOutcome {
  not_run,
  completed,
  no_max_crush,   ///< A pulse has no time of maximum crush.
  interrupted,    ///< Rows that are finished are kept; nothing is recommended.
  nothing_usable  ///< No candidate could be fitted, or none predicted every test left out.
};
inline constexpr std::string_view kSelectOutcomeNames[] = {"not_run", "completed", "no_max_crush", "interrupted",
                                                           "nothing_usable"};
template <>
inline constexpr std::span<const std::string_view> enum_names<SelectOutcome>{kSelectOutcomeNames};

/// What a selection gives.
struct Selection {
  SelectOutcome outcome = SelectOutcome::not_run;
  std::string message;             ///< Why it is not usable, or empty.
  std::string recommendation;      ///< In words.
  std::vector<SelectionRow> rows;  ///< Best first: fewest failures, then least prediction error; one test: least AICc.
  int tests = 0;
  double observations = kUnset;  ///< Effective number, over all tests.
  double seconds = kUnset;       ///< Wall time.

  [[nodiscard]] bool usable() const { return outcome == SelectOutcome::completed; }
  /// One line: the recommendation, or why there is none.
  [[nodiscard]] std::string brief_report() const;
  /// The row recommended; nullptr when there is none.
  [[nodiscard]] const SelectionRow* recommended() const;
};

/// Fits every candidate to all pulses, and to all but each in turn, whose motion is then predicted. Of several tests
/// the recommendation is the candidate with the fewest parameters among those whose prediction error is within one
/// standard error of the least (the rule of [Breiman1984], by the tests' paired differences; of two tests, whose
/// deviation says nothing, within a tenth of the least); of one test the least AICc, [Burnham2002] section 2.4:
///     AICc = 2 n ln E + 2 K + 2 K (K + 1) / (n - K - 1),   K = parameters + 1,   E of loss l2: n ln E
/// n is the effective number of observations: three channels integrated from one accelerometer, with correlated
/// residuals, are not 3 N data. n = sum over tests of N / (1 + 2 sum of autocorrelations) of the acceleration residuals
/// [Geyer1992] of the candidate with the least E, the same for all.
/// @throws InvalidInput on bad options, no candidate, or a pulse without mass.
Selection select_model(std::span<const Pulse> pulses, const SelectOptions& options = {}, const Progress& progress = {});

/// selection.csv: a row each; tests left out as further columns. selection.json: the same with the recommendation.
std::string format_selection_csv(const Selection& selection, const Record& record);
std::string format_selection_json(const Selection& selection, const Record& record);

}  // namespace crashsim
