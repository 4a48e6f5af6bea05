/// Models and cases that cannot be used: path, line or key, value, rule, and the nearest known name.

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "support/refusal.hpp"

namespace crashsim {
namespace {

using test::Refusal;

/// `simulate` of a model whose text is kModelText with one piece replaced.
Refusal model_with(const char* what, const std::string& old, const std::string& replacement,
                   std::vector<std::string> message) {
  std::string text = test::kModelText;
  text.replace(text.find(old), old.size(), replacement);
  return {what, {{"m.json", text}}, {"simulate", "m.json", "-o", "out"}, std::move(message)};
}

Refusal model_text(const char* what, std::string text, std::vector<std::string> message) {
  return {what, {{"m.json", std::move(text)}}, {"simulate", "m.json", "-o", "out"}, std::move(message)};
}

/// `run` of a case beside a trace `t.csv` and a model `m.json`.
Refusal case_text(const char* what, std::string text, std::vector<std::string> message) {
  return {what,
          {{"c.toml", std::move(text)}, {"t.csv", test::half_sine_trace()}, {"m.json", test::kModelText}},
          {"run", "c.toml", "-o", "out"},
          std::move(message)};
}

class BadModel : public testing::TestWithParam<Refusal> {};

TEST_P(BadModel, IsRefused) { test::expect_refused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Files, BadModel,
    testing::Values(Refusal{"missing", {}, {"simulate", "none.json", "-o", "out"}, {"none.json: no such file"}},
                    Refusal{"folder", {}, {"simulate", "data", "-o", "out"}, {"data: is a folder, not a file"}},
                    model_text("empty", "", {"m.json:1: is not JSON: "}),
                    model_with("cut", "[1000, 2000]}}\n", "[1000,\n", {"m.json:4: is not JSON: "}),
                    model_with("comma_too_many", "\"version\": 1,", "\"version\": 1,,", {"m.json:1: is not JSON: "}),
                    model_with("number_too_large", "\"mass_kg\": 1500", "\"mass_kg\": 1e999",
                               {"m.json", "is not JSON: "}),
                    model_text("list", "[1, 2]", {"m.json: must be a JSON object"}),
                    Refusal{"pulse_as_model",
                            {{"t.csv", test::half_sine_trace()}},
                            {"simulate", "t.csv", "-o", "out"},
                            {"t.csv:1: is not JSON"}}));

INSTANTIATE_TEST_SUITE_P(
    Keys, BadModel,
    testing::Values(
        model_with("of_another_format", "crush_model", "pitch_model",
                   {"m.json: format = \"crashsim.pitch_model\": must be \"crashsim.crush_model\""}),
        model_with("of_another_version", "\"version\": 1", "\"version\": 2",
                   {"m.json: version = 2: this program reads version 1"}),
        model_with("format_missing", "\"format\": \"crashsim.crush_model\", ", "", {"m.json: has no 'format'"}),
        model_with("mass_missing", "\"mass_kg\": 1500, ", "", {"m.json: has no 'mass_kg'"}),
        model_with("unknown_key", "\"mass_kg\": 1500", "\"mass\": 1500",
                   {"m.json: unknown name 'mass', did you mean 'mass_kg'?"}),
        model_with("unknown_key_of_the_spring", "\"knots_m\"", "\"knot_m\"",
                   {"m.json: spring: unknown name 'knot_m', did you mean 'knots_m'?"}),
        model_with("ordinates_of_the_other_law", "\"impact_speed_mps\": 15", "\"law\": \"force\"",
                   {"m.json: spring: unknown name 'ordinates_n_per_m', did you mean 'ordinates_n'?"}),
        model_with("unknown_law", "\"impact_speed_mps\": 15", "\"law\": \"stifness\"",
                   {"m.json: law: unknown name 'stifness', did you mean 'stiffness'? (known: stiffness, force, "
                    "crush_damping, rate)"}),
        model_with(
            "unknown_unloading", "\"impact_speed_mps\": 15", "\"unloading\": {\"kind\": \"plastik\"}",
            {"m.json: unloading: kind: unknown name 'plastik', did you mean 'plastic'? (known: elastic, plastic)"}),
        model_with("unknown_key_of_unloading", "\"impact_speed_mps\": 15", "\"unloading\": {\"restitutions\": 0.1}",
                   {"m.json: unloading: unknown name 'restitutions', did you mean 'restitution'?"}),
        model_with(
            "plastic_without_a_number", "\"impact_speed_mps\": 15", "\"unloading\": {\"kind\": \"plastic\"}",
            {"m.json: CrushModel.unloading: kind plastic has neither unloading_stiffness_n_per_m nor restitution: "
             "give one"}),
        model_with("spring_is_a_number", R"({"knots_m": [0, 1], "ordinates_n_per_m": [1e6, 1e6]})", "5",
                   {"m.json: spring: must be a JSON object"}),
        model_with("no_speed_at_all", ", \"impact_speed_mps\": 15", "",
                   {"impact_speed_mps: not given, and the model has none: give a speed"})));

INSTANTIATE_TEST_SUITE_P(
    Values, BadModel,
    testing::Values(
        model_with("negative_mass", "1500", "-3", {"m.json: CrushModel.mass_kg = -3 kg: must be > 0"}),
        model_with("mass_is_text", "1500", "\"heavy\"", {"m.json: mass_kg = 'heavy': is not a finite number"}),
        model_with("zero_speed", "\"impact_speed_mps\": 15", "\"impact_speed_mps\": 0",
                   {"m.json: CrushModel.impact_speed_mps = 0 m/s: must be > 0"}),
        model_with("knots_not_increasing", "\"knots_m\": [0, 1]", "\"knots_m\": [0, 0]",
                   {"m.json: CrushModel.spring.knots[1] = 0: must be greater than the knot before it, 0"}),
        model_with("first_knot_is_not_0", "\"knots_m\": [0, 1]", "\"knots_m\": [0.1, 1]",
                   {"m.json: CrushModel.spring", "knots[0] = 0.1"}),
        model_with("unequal_lengths", "\"knots_m\": [0, 1]", "\"knots_m\": [0, 1, 2]",
                   {"m.json: CrushModel.spring", "3 knots", "2 ordinates"}),
        model_with("negative_ordinate", "[1e6, 1e6]", "[1e6, -1]", {"m.json: CrushModel.spring", "= -1", ">= 0"}),
        model_with("restitution_above_1", "\"impact_speed_mps\": 15",
                   R"("unloading": {"kind": "plastic", "restitution": 1.5})",
                   {"m.json: CrushModel.unloading.restitution = 1.5: must be >= 0 and <= 1"}),
        model_with("unloading_stiffness_is_text", "\"impact_speed_mps\": 15",
                   R"("unloading": {"kind": "plastic", "unloading_stiffness_n_per_m": "hard"})",
                   {"m.json: unloading: unloading_stiffness_n_per_m = 'hard': is not a finite number"}),
        model_with("ordinate_is_null", "[1e6, 1e6]", "[1e6, null]",
                   {"m.json: spring: ordinates_n_per_m: a list must hold numbers"}),
        model_text("neither_spring_nor_damper", R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1500})",
                   {"m.json: CrushModel", "spring", "damper"})));

INSTANTIATE_TEST_SUITE_P(
    Cases, BadModel,
    testing::Values(
        Refusal{"case_missing", {}, {"run", "none.toml", "-o", "out"}, {"none.toml: no such file"}},
        case_text("case_not_toml", "[pulse\nfile = 1\n", {"c.toml:1: is not TOML: "}),
        case_text("case_without_anything", "", {"c.toml: has neither [pulse] file nor [crush] model: name a trace"}),
        case_text("case_unknown_key", "[pulse]\nfile = \"t.csv\"\ncfx = 60\n",
                  {"c.toml:3: [pulse]: unknown name 'cfx', did you mean 'cfc'? (known: "}),
        case_text("case_unknown_section", "[puls]\nfile = \"t.csv\"\n",
                  {"c.toml:2: unknown name '[puls]', did you mean 'pulse'? (known: vehicle, impact, pulse, "}),
        case_text("case_key_before_any_section", "file = \"t.csv\"\n",
                  {"c.toml:1: unknown name 'file', did you mean 'title'?"}),
        case_text("case_value_out_of_range", "[pulse]\nfile = \"t.csv\"\n[vehicle]\nmass = -3\n",
                  {"c.toml:4: [vehicle] mass = -3 kg: must be > 0"}),
        case_text("case_value_of_another_unit", "[impact]\nspeed = \"5 kg\"\n",
                  {"c.toml:2: [impact] speed = '5 kg': 'kg' measures mass, not speed"}),
        case_text("case_value_of_another_kind", "[pulse]\nfile = 5\n",
                  {"c.toml:2: [pulse] file: must be text, not a whole number"}),
        case_text("case_unknown_choice", "[crush]\nlaw = \"plastic\"\n",
                  {"c.toml:2: [crush] law: unknown name 'plastic' (known: stiffness, force, crush_damping, rate)"}),
        case_text("case_restitution_of_elastic", "[crush]\nmodel = \"m.json\"\nrestitution = 0.1\n",
                  {"c.toml: [crush] restitution goes with unloading = \"plastic\", this is \"elastic\""}),
        case_text("case_restitution_out_of_range", "[crush]\nrestitution = 1.1\n",
                  {"c.toml:2: [crush] restitution = 1.1: must be >= 0 and <= 1"}),
        case_text("case_unloading_given_twice",
                  "[crush]\nmodel = \"m.json\"\nunloading = \"plastic\"\nrestitution = 0.1\n"
                  "unloading_stiffness = \"20 kN/mm\"\n",
                  {"c.toml: [crush] has both unloading_stiffness and restitution: give one of them"}),
        case_text("case_plastic_without_a_number", "[crush]\nmodel = \"m.json\"\nunloading = \"plastic\"\n",
                  {"c.toml: [crush] unloading = \"plastic\": there is no pulse to take a restitution from: give "
                   "restitution or unloading_stiffness"}),
        case_text("case_trace_missing", "[pulse]\nfile = \"none.csv\"\n", {"none.csv: no such file"}),
        case_text("case_model_missing", "[crush]\nmodel = \"none.json\"\n", {"none.json: no such file"}),
        case_text("case_model_and_further_pulses", "[crush]\nmodel = \"m.json\"\n[identify]\npulses = [\"t.csv\"]\n",
                  {"c.toml: [identify] pulses do not go with [crush] model"}),
        case_text("case_speed_not_positive", "[crush]\nmodel = \"m.json\"\n[predict]\nspeeds = [10, -5]\n",
                  {"c.toml: [predict] speeds[1] = -5 m/s: must be > 0"}),
        case_text("case_speeds_of_one_name",
                  "[crush]\nmodel = \"m.json\"\n[predict]\nspeeds = [\"48 km/h\", \"48.001 km/h\"]\n",
                  {"c.toml: [predict] speeds[1] = ", "prediction_48kmh"}),
        Refusal{"case_is_a_trace",
                {{"t.csv", test::half_sine_trace()}},
                {"run", "t.csv", "-o", "out"},
                {"t.csv: holds no record of what made it: give a case (.toml)"}}));

}  // namespace
}  // namespace crashsim
