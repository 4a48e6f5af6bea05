#pragma once
/// What an identified model says of other speeds, with bands where it carries an ensemble, and how far that reaches.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/metrics.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/uncertainty.hpp>

namespace crashsim {

/// How to predict.
struct PredictOptions {
  std::vector<std::string> speeds;  ///< "40km/h", "40km/h..72km/h:9" (9 of them) or, 9 too, "40km/h..72km/h"; SI
                                    ///< without a unit. Empty: those that the model was identified at.
  double mass_kg = kUnset;          ///< Unset: the model's.
  double level = kUnset;            ///< Of the bands; unset: that of the model's uncertainty.
  bool curves = false;              ///< Give the motions, too.
  double end_time_s = kUnset;       ///< Unset: 0.2 s.
  double dt_s = 1e-4;               ///< Sampling of the motions and of the metrics made from them.
  double rtol = 1e-8;
  int jobs = 0;  ///< Threads; 0: all cores. The result does not depend on it.

  bool operator==(const PredictOptions&) const = default;
};
inline constexpr std::array<Field<PredictOptions>, 8> kPredictFields = {{
    {"speeds", "speed", "", "speeds to predict: 48km/h, 40km/h..72km/h:9; several with commas",
     &PredictOptions::speeds},
    {"mass_kg", "mass", "kg", "test mass; default: the model's", &PredictOptions::mass_kg, positive()},
    {"level", "level", "", "probability that the bands stand for; default: the model's", &PredictOptions::level,
     between(0.5, 0.9999)},
    {"curves", "curves", "", "give the motions, too", &PredictOptions::curves},
    {"end_time_s", "end", "s", "time to simulate to; default 0.2 s", &PredictOptions::end_time_s,
     positive_up_to(kLongestMotion_s)},
    {"dt_s", "dt", "s", "sampling of the motions", &PredictOptions::dt_s, positive()},
    {"rtol", "rtol", "", "relative accuracy", &PredictOptions::rtol, between(1e-12, 1e-2)},
    {"jobs", "jobs", "", "threads; 0: all cores", &PredictOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<PredictOptions>> fields<PredictOptions>{kPredictFields};

/// What predictions rest on: a model, the tests it was identified from, and other models that these tests allow.
struct PredictionBasis {
  CrushModel model;
  std::vector<TestReport> tests;  ///< Empty where the model does not say: its speed, if any, stands for one.
  Verdict verdict;                ///< Of the identification; without a message where the model does not say.
  CrushModels replicates;         ///< A row each; none: no bands.
  double level = 0.95;            ///< That the bands stand for.
};

/// The basis of an identification. @param uncertainty of it; not_run: predictions have no bands.
PredictionBasis prediction_basis(const Identification& fit, const Uncertainty& uncertainty);

/// A channel of the motion with its band, empty without an ensemble.
struct PredictedCurve {
  std::vector<double> value, low, high;
};

/// What is said of one speed.
struct PredictedSpeed {
  double impact_speed_mps = kUnset;
  CrushOutcome outcome = CrushOutcome::not_run;  ///< Of the model itself.
  Metrics value;                                 ///< Of the model itself.
  Metrics low, high;  ///< Band of each; unset where there is none, or where it has no end (see without_max_crush).
  double without_max_crush = kUnset;  ///< Share of the replicates that never come to rest; unset without an ensemble.
  bool outside_speeds = false;        ///< Slower or faster than every test, or nothing is known of tests.
  bool beyond_crush = false;          ///< Crushes deeper than any test; where none is known, than the last knot.
  std::vector<std::string> reasons;   ///< Why it is to be taken with care, in words.
  std::vector<double> time_s;         ///< Of the curves.
  PredictedCurve accel_mps2, velocity_mps, displacement_m;

  [[nodiscard]] bool extrapolated() const { return outside_speeds || beyond_crush; }
};

/// Predictions at several speeds, in the order asked.
struct SpeedPrediction {
  std::vector<PredictedSpeed> speeds;
  std::size_t replicates = 0;  ///< Behind the bands; 0: there are none.
  double level = kUnset;       ///< That the bands stand for; unset without.
  double mass_kg = kUnset;
  std::string message;  ///< What the predictions rest on, in words.

  /// True when the model comes to rest at every speed.
  [[nodiscard]] bool usable() const;
  [[nodiscard]] std::string brief_report() const;
};

/// Predicts. Bands are pointwise quantiles of the ensemble, simulated at each speed.
/// @throws InvalidInput on a bad option or speed, or when no speed is known.
SpeedPrediction predict(const PredictionBasis& basis, const PredictOptions& options = {});

/// The speeds that the options ask for [m/s].
std::vector<double> speeds_of(const PredictOptions& options, const PredictionBasis& basis);

}  // namespace crashsim
