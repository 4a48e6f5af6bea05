/// Who may include whom: the layers of CONTRIBUTING.md, read from the sources.
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "support/source_tree.hpp"

namespace crashsim::test {
namespace {

using testing::IsEmpty;
using testing::Not;

/// Each layer uses only itself and those before it.
enum Layer { base, signals, models, simulation, judgement, identification, pipeline, everything };
constexpr const char* kLayerNames[] = {"base",      "signals",        "models",   "simulation",
                                       "judgement", "identification", "pipeline", "everything"};

/// Layer of a file by its name without extension in include/crashsim or src; a folder's name stands for its files.
/// A new file of src/ or include/crashsim/ must be listed here, or lie in a listed folder.
const std::map<std::string, Layer> kLayers = {
    {"config", base},
    {"distribution", base},
    {"error", base},
    {"files", base},
    {"io/input_file", base},
    {"json", base},
    {"json_object", base},
    {"messages", base},
    {"named_number", base},
    {"nearest", base},
    {"number", base},
    {"number_list", base},
    {"option_docs", base},
    {"option_values", base},
    {"options", base},
    {"parallel", base},
    {"instruction_set", base},
    {"vector_types", base},
    {"piecewise_linear", base},
    {"random", base},
    {"record", base},
    {"record_json", base},
    {"root", base},
    {"sha256", base},
    {"sample_statistics", base},
    {"sampling", base},
    {"sobol_table", base},
    {"solver_statistics", base},
    {"table_io", base},
    {"stage_clock", base},
    {"text", base},
    {"time_series", base},
    {"unit_suffix", base},
    {"units", base},
    {"version", base},

    {"body_motion", signals},
    {"channel_choice", signals},
    {"channel_fields", signals},
    {"force_rows", signals},
    {"measured_motion", signals},
    {"io/", signals},
    {"iso_mme", signals},
    {"plausibility", signals},
    {"pulse", signals},
    {"pulse_channels", signals},
    {"pulse_steps", signals},
    {"redundancy", signals},
    {"signal", signals},
    {"trace", signals},
    {"trace_io", signals},

    {"crush_model", models},
    {"heave_pitch_model", models},
    {"solver/crush_force", models},

    {"forcing", simulation},
    {"output_times", simulation},
    {"crush_outcome", simulation},
    {"pitch_input", simulation},
    {"coupled_columns", simulation},
    {"coupled_model", simulation},
    {"simulate", simulation},
    {"simulate_coupled", simulation},
    {"simulate_pitch", simulation},
    {"solver/", simulation},
    {"vertical_force", simulation},

    {"bands", judgement},
    {"comparison", judgement},
    {"crush_stiffness", judgement},
    {"dtw", judgement},
    {"load_cell_wall", judgement},
    {"metrics", judgement},
    {"event_metrics", judgement},
    {"simulate_many", judgement},
    {"olc", judgement},
    {"rating", judgement},
    {"severity", judgement},
    {"vpi", judgement},
    {"wall_cells", judgement},

    {"design", identification},
    {"design_options", identification},
    {"identify", identification},
    {"identify_options", identification},
    {"identify_pitch", identification},
    {"identify_vertical", identification},
    {"measured_vertical", identification},
    {"optimize/", identification},
    {"select_candidates", identification},
    {"select_model", identification},
    {"select_options", identification},
    {"select_verdict", identification},
    {"selection_outputs", identification},
    {"predict", identification},
    {"uncertainty", identification},
    {"uncertainty_words", identification},
    {"sensor_correction", identification},
    {"sensor_correction_options", identification},
    {"sensor_equations", identification},
    {"sensor_signals", identification},
    {"sensor_verdict", identification},

    {"batch", pipeline},
    {"batch/", pipeline},
    {"batch_folder", pipeline},
    {"batch_options", pipeline},
    {"case", pipeline},
    {"case_file", pipeline},
    {"case_outputs", pipeline},
    {"case_pitch", pipeline},
    {"case_traces", pipeline},
    {"case_sections", pipeline},
    {"case_steps", pipeline},
    {"design_case", pipeline},
    {"design_outputs", pipeline},
    {"fit_json", pipeline},
    {"export", pipeline},
    {"export_cards", pipeline},
    {"export_curves", pipeline},
    {"export_lsdyna", pipeline},
    {"export_radioss", pipeline},
    {"model_io", pipeline},
    {"outputs", pipeline},
    {"stage_times", pipeline},
    {"prediction_outputs", pipeline},
    {"read_samples", pipeline},
    {"run_samples", pipeline},
    {"sample_runner", pipeline},
    {"sample_table", pipeline},
    {"summary", pipeline},
    {"sweep", pipeline},
    {"sweep_keys", pipeline},
    {"sweep_options", pipeline},
    {"sweep_outputs", pipeline},
    {"uncertainty_json", pipeline},
    {"vehicle_io", pipeline},
    {"vertical_io", pipeline},

    {"crashsim", everything},
};

/// Layer of "include/crashsim/x.hpp", "src/x.cpp", "<crashsim/x.hpp>" or "\"x.hpp\""; -1 when not listed.
int layer_of(const std::string& name) {
  static const std::regex decoration(R"x(^(include/crashsim/|src/|<crashsim/|")|\.[ch]pp(\.in)?[>"]?$)x");
  const std::string key = std::regex_replace(name, decoration, "");
  const auto exact = kLayers.find(key);
  const auto listed = exact != kLayers.end() ? exact : kLayers.find(key.substr(0, key.find('/') + 1));
  return listed != kLayers.end() ? static_cast<int>(listed->second) : -1;
}

bool matches(const std::string& text, const std::string& pattern) {
  return std::regex_match(text, std::regex(pattern));
}

/// "who includes what" of the includes in a folder that match, by a file that does not.
std::vector<std::string> includes_outside(const std::string& folder, const std::string& header,
                                          const std::string& allowed_files) {
  std::vector<std::string> wrong;
  for (const Include& include : includes_in(folder))
    if (matches(include.name, header) && !matches(include.file, allowed_files))
      wrong.push_back(include.file + " includes " + include.name);
  return wrong;
}

/// "who includes what" of the includes in a folder other than those allowed.
std::vector<std::string> includes_other_than(const std::string& folder, const std::string& allowed) {
  return includes_outside(folder, "(?!" + allowed + "$).*", "");
}

constexpr const char* kStandard = "<[a-z_0-9]+>";

TEST(Layers, SourcesAreFound) {
  EXPECT_THAT(includes_in("src"), Not(IsEmpty()));
  EXPECT_THAT(includes_in("include"), Not(IsEmpty()));
}

TEST(Layers, PublicHeadersIncludeOnlyStdEigenAndCrashsim) {
  EXPECT_THAT(includes_other_than("include", std::string("(") + kStandard + "|<Eigen/.*>|<crashsim/.*>)"), IsEmpty());
}

TEST(Layers, OnlyTheSolverIncludesSundials) {
  const std::string sundials = "<(sundials|cvodes?|nvector|sunmatrix|sunlinsol|sunnonlinsol|sunadaptcontroller)/.*>";
  EXPECT_THAT(includes_outside("src", sundials, "src/solver/.*"), IsEmpty());
}

TEST(Layers, OnlyItsWrapperIncludesNlopt) {
  EXPECT_THAT(includes_outside("src", "<nlopt.*>", "src/optimize/nlopt.*"), IsEmpty());
}

TEST(Layers, EdgesIncludeNoPrivateHeader) {
  const std::string libraries =
      std::string(kStandard) + "|<crashsim/.*>|<fmt/.*>|<nlohmann/.*>|<(fnmatch|unistd|sys/[a-z]+)\\.h>";
  EXPECT_THAT(includes_other_than("apps", "(" + libraries + "|<CLI/.*>|\"[a-z_]+\\.hpp\")"), IsEmpty());
  EXPECT_THAT(includes_other_than("bindings", "(" + libraries + "|<pybind11/.*>|\"[a-z_]+\\.hpp\")"), IsEmpty());
}

TEST(Layers, EveryFileHasALayer) {
  std::vector<std::string> unlisted;
  for (const std::string folder : {"include", "src"})
    for (const std::string& path : sources_in(folder))
      if (layer_of(path) < 0) unlisted.push_back(path);
  EXPECT_THAT(unlisted, IsEmpty()) << "give each a layer in kLayers of tests/unit/layers_test.cpp";
}

TEST(Layers, NoFileUsesAHigherLayer) {
  std::vector<std::string> wrong;
  for (const std::string folder : {"include", "src"})
    for (const Include& include : includes_in(folder)) {
      if (!matches(include.name, "<crashsim/.*>|\".*\"")) continue;
      const int user = layer_of(include.file), used = layer_of(include.name);
      if (user < 0 || used <= user) continue;
      wrong.push_back(include.file + " (" + kLayerNames[user] + ") includes " + include.name + " (" +
                      kLayerNames[used] + ")");
    }
  EXPECT_THAT(wrong, IsEmpty());
}

}  // namespace
}  // namespace crashsim::test
