#pragma once
/// A case: one study from trace to judged model, described by a file.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crashsim/comparison.hpp>
#include <crashsim/config.hpp>
#include <crashsim/design_options.hpp>
#include <crashsim/files.hpp>
#include <crashsim/forcing.hpp>
#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/measured_motion.hpp>
#include <crashsim/option_docs.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/record.hpp>
#include <crashsim/sample_table.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/simulate_coupled.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/stage_times.hpp>
#include <crashsim/summary.hpp>
#include <crashsim/sweep_options.hpp>
#include <crashsim/vertical_force.hpp>

namespace crashsim {

/// What a case says of vehicle, impact, pulse file and model beside the options of the steps.
struct CaseOptions {
  std::string title;                                      ///< Of the study, for people.
  double mass_kg = kUnset;                                ///< [vehicle] mass; unset: the pulse file's.
  double impact_speed_mps = kUnset;                       ///< [impact] speed; unset: the pulse file's.
  std::string pulse_file;                                 ///< [pulse] file; "" when a model is only simulated.
  std::string model_file;                                 ///< [crush] model: used, nothing is identified.
  Extrapolation extrapolation = Extrapolation::constant;  ///< [crush] extrapolation, of a model identified here
  UnloadingKind unloading = UnloadingKind::elastic;       ///< [crush] unloading; plastic: of a model that was read, too
  double unloading_stiffness_n_per_m = kUnset;            ///< [crush] unloading_stiffness
  double restitution = kUnset;                            ///< [crush] restitution
  bool bilateral = false;                                 ///< [crush] bilateral
  std::vector<std::string> further_pulses;                ///< [identify] pulses: further tests of the same structure.
  bool coupled = false;            ///< [pitch] coupled: crush, heave and pitch as one model, beside the two phases.
  std::vector<double> speeds_mps;  ///< [predict] speeds

  bool operator==(const CaseOptions&) const = default;
};
inline constexpr std::array<Field<CaseOptions>, 13> kCaseFields = {{
    {"title", "title", "", "what the study is about", &CaseOptions::title},
    {"mass_kg", "vehicle.mass", "kg", "test mass; default: the pulse file's or the model's", &CaseOptions::mass_kg,
     positive()},
    {"impact_speed_mps", "impact.speed", "m/s", "impact speed; default: the pulse file's or the model's",
     &CaseOptions::impact_speed_mps, positive()},
    {"pulse_file", "pulse.file", "", "trace or pulse.csv of the test", &CaseOptions::pulse_file},
    {"model_file", "crush.model", "", "model.json to use instead of identifying one", &CaseOptions::model_file},
    {"extrapolation", "crush.extrapolation", "",
     "what a curve does beyond its last knot; while it is identified the last ordinate is held",
     choice<&CaseOptions::extrapolation>()},
    {"unloading", "crush.unloading", "", "behaviour after maximum crush; plastic overrules that of a model",
     choice<&CaseOptions::unloading>()},
    {"unloading_stiffness_n_per_m", "crush.unloading-stiffness", "N/m", "plastic: slope of the line back",
     &CaseOptions::unloading_stiffness_n_per_m, positive()},
    {"restitution", "crush.restitution", "",
     "plastic: rebound velocity / impact speed; default, without unloading_stiffness: the pulse's",
     &CaseOptions::restitution, between(0.0, 1.0)},
    {"bilateral", "crush.bilateral", "", "the barrier pulls, too: contact is never lost", &CaseOptions::bilateral},
    {"further_pulses", "identify.pulses", "", "further tests of the same structure, fitted together",
     &CaseOptions::further_pulses},
    {"coupled", "pitch.coupled", "", "also simulate crush, heave and pitch as one model", &CaseOptions::coupled},
    {"speeds_mps", "predict.speeds", "m/s", "speeds to predict", &CaseOptions::speeds_mps},
}};
template <>
inline constexpr std::span<const Field<CaseOptions>> fields<CaseOptions>{kCaseFields};

/// One study. Paths inside are relative to the folder of the case file.
struct Case {
  std::string path;  ///< As given.
  CaseOptions what;
  PulseOptions pulse;             ///< [pulse]
  IdentifyOptions identify;       ///< [identify]; law and knots stand in [crush]
  SimulateOptions simulation;     ///< [simulate]
  HeavePitchModel vehicle;        ///< [vehicle], its formulation in [pitch]; the mass is that of the crush.
  ForcingOptions forcing;         ///< [pitch] force = {file, channel, ..}; without a file: the simulated crush force.
  PitchOptions motion;            ///< [pitch]
  VerticalForceLaw vertical;      ///< [pitch] angle, friction, ..: vertical force of the simulated crush.
  GroundContact ground;           ///< [vehicle], of the coupled model.
  MotionOptions measured;         ///< [compare] motion = {file, front, rear, ..}: measured heave and pitch.
  CompareOptions comparison;      ///< [compare]
  DesignOptions design;           ///< [design]
  SweepOptions sweep;             ///< [sweep]; not together with
  MonteCarloOptions monte_carlo;  ///< [monte_carlo]
};

/// Every key of a case file, section by section.
std::vector<FileKey> case_keys();

/// Reads a case: TOML, or the record of a case that was run (case.lock.json), whose inputs are checked.
/// @throws InvalidInput with path, line, key and rule, or the nearest known key.
Case read_case(const std::string& path);

/// The case as entries of a record: every option, set or default.
std::vector<ConfigEntry> entries_of(const Case& study);

struct Prediction {
  std::string name;  ///< Simulation at another speed: "40kmh".
  CrushResponse response;
};

/// What a case gives.
struct CaseResult {
  std::optional<Pulse> pulse;
  std::optional<Identification> identification;
  CrushModel model;
  CrushResponse response;
  std::optional<MeasuredForcing> forcing;  ///< Where [pitch] names a file.
  std::optional<PitchResponse> pitch;
  std::optional<CoupledResponse> coupled;
  std::vector<Prediction> predictions;
  std::vector<NamedComparison> comparisons;  ///< "to_max_crush", "whole_record", "heave_and_pitch", ..
  std::optional<SampleTable> samples;        ///< Of [sweep] or [monte_carlo].
  std::vector<std::string> input_files;
  std::vector<std::string> notes;  ///< What the case did not say and was taken from elsewhere.
  StageTimes stages;               ///< Of run_case(): neither reading the case nor writing.

  /// True when every step gave a result to rely on.
  [[nodiscard]] bool usable() const;
};

/// Runs a case. @throws InvalidInput on bad options, files or values.
CaseResult run_case(const Case& study, const Progress& progress = {});

/// Summary of a result: of the model's response and its heave and pitch; and parts "pulse", "identification",
/// "coupled", "rating_..", "prediction_..".
Summary summarize(const CaseResult& result);
std::vector<std::pair<std::string, Summary>> summary_parts(const CaseResult& result);

inline constexpr std::string_view kCaseSummary = "summary.json";  ///< The file that holds the summary.
/// The files that a case names, and its own: what it reads.
std::vector<std::string> case_inputs(const Case& study);

/// Names of the files that a case will write, in the order of case_files().
std::vector<std::string> case_file_names(const Case& study);

/// The files of a case directory: pulse.csv, model.json, response.csv, pitch.csv, coupled.csv, prediction_*.csv,
/// comparison.json, samples.csv, sweep.json, summary.json and, last, case.lock.json, the record.
std::vector<FileText> case_files(const Case& study, const CaseResult& result);

}  // namespace crashsim
