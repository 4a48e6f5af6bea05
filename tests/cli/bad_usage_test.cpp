/// Command lines that cannot be meant, and options out of range: exit code 2, the value, the rule and the remedy.

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "support/refusal.hpp"

namespace crashsim {
namespace {

using test::Refusal;

/// A command on the half-sine trace `t.csv` or the model `m.json` that is refused before any output.
Refusal with_options(const char* what, const char* command, const std::vector<std::string>& options,
                     std::vector<std::string> message) {
  const bool of_a_model = std::string(command) == "simulate";
  Refusal refusal{what,
                  {{"t.csv", test::half_sine_trace()}, {"m.json", test::kModelText}},
                  {command, of_a_model ? "m.json" : "t.csv", "-o", "out"},
                  std::move(message)};
  refusal.arguments.insert(refusal.arguments.end(), options.begin(), options.end());
  return refusal;
}

class BadUsage : public testing::TestWithParam<Refusal> {};

TEST_P(BadUsage, IsRefused) { test::expect_refused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Words, BadUsage,
    testing::Values(
        Refusal{"unknown_subcommand",
                {},
                {"simulte", "m.json"},
                {"unknown subcommand 'simulte', did you mean 'simulate'? (see crashsim --help)"}},
        Refusal{"unknown_option_of_the_program",
                {},
                {"--versoin"},
                {"unknown option '--versoin', did you mean '--version'?"}},
        with_options("unknown_option", "identify", {"--start", "3"},
                     {"identify: unknown option '--start', did you mean '--starts'? (see crashsim identify --help)"}),
        with_options("unknown_option_with_equals", "identify", {"--mas=3"},
                     {"unknown option '--mas', did you mean '--mass'?"}),
        with_options("unknown_short_option", "pulse", {"-z"}, {"pulse: unknown option '-z'"}),
        with_options("too_many_files", "pulse", {"u.csv"}, {"pulse: unknown argument 'u.csv'"}),
        with_options("missing_value", "pulse", {"--cfc"},
                     {"pulse: --cfc: needs a value", "(see crashsim pulse --help)"}),
        Refusal{"missing_file", {}, {"pulse", "-o", "out"}, {"pulse: file is required (see crashsim pulse --help)"}},
        Refusal{"missing_second_file", {}, {"compare", "a.csv"}, {"compare: candidate is required"}},
        Refusal{"missing_kind", {}, {"schema"}, {"schema: kind is required"}},
        Refusal{"export_to_nothing",
                {{"m.json", test::kModelText}},
                {"export", "m.json", "-o", "out"},
                {"export: to what? give --to lsdyna, radioss, csv or iso-mme"}},
        Refusal{"export_to_something_else",
                {{"m.json", test::kModelText}},
                {"export", "m.json", "--to", "radios", "-o", "out"},
                {"--to: unknown name 'radios', did you mean 'radioss'?"}},
        Refusal{"export_id",
                {{"m.json", test::kModelText}},
                {"export", "m.json", "--to", "lsdyna", "--id", "0", "-o", "out"},
                {"--id = 0", ">= 1"}},
        Refusal{"unknown_kind",
                {},
                {"schema", "modle"},
                {"schema: unknown name 'modle', did you mean 'model'? (known: case, model, vehicle)"}},
        Refusal{"two_subcommands",
                {},
                {"schema", "case", "simulate", "data/syn-a/model.json"},
                {"schema: unknown argument 'simulate'"}}));

INSTANTIATE_TEST_SUITE_P(
    Outputs, BadUsage,
    testing::Values(Refusal{"nowhere_to_write",
                            {{"t.csv", test::half_sine_trace()}},
                            {"pulse", "t.csv"},
                            {"pulse: where to? Name the output with -o FILE ('-' for standard output), or ask for the "
                             "summary alone with --json"}},
                    Refusal{"nowhere_to_run", {}, {"run", "data/fe-car/case.toml"}, {"run: where to?"}},
                    Refusal{"dash_and_json",
                            {{"t.csv", test::half_sine_trace()}},
                            {"pulse", "t.csv", "-o", "-", "--json"},
                            {"-o - and --json both write to standard output: choose one of them"}},
                    Refusal{"dash_for_a_case",
                            {},
                            {"run", "data/fe-car/case.toml", "-o", "-"},
                            {"-o -: a case writes several files: name a folder"}},
                    Refusal{"file_for_a_case",
                            {{"out", "mine"}},
                            {"run", "data/fe-car/case.toml", "-o", "out"},
                            {"out: is a file: name a folder for the outputs of the case"}},
                    Refusal{"exists",
                            {{"t.csv", test::half_sine_trace()}, {"out", "mine"}},
                            {"pulse", "t.csv", "-o", "out"},
                            {"out: exists already; choose another name, or --force to replace it"}},
                    Refusal{"exists_for_pitch",
                            {{"out", "mine"}},
                            {"pitch", "data/paper/table1.json", "--force", "data/fe-car/C56.csv", "-o", "out"},
                            {"out: exists already; choose another name, or --overwrite to replace it"}},
                    Refusal{"no_force",
                            {},
                            {"pitch", "data/paper/table1.json", "-o", "out"},
                            {"pitch: --force is required: the trace with the barrier's force"}},
                    Refusal{"no_force_channel",
                            {},
                            {"pitch", "data/paper/table1.json", "--force", "data/fe-car/C56.csv", "-o", "out"},
                            {"data/fe-car/C56.csv: say which channels are the vertical force"}},
                    Refusal{
                        "no_force_arm",
                        {},
                        {"pitch", "data/paper/table1.json", "--force", "data/fe-car/C56.csv", "--channel",
                         "barrier_impulse_FTZ", "-o", "out"},
                        {"HeavePitchModel.force_arm_m is not set but there is a vertical force: give the lever arm"}},
                    Refusal{"no_time_of_maximum_crush",
                            {},
                            {"pitch", "data/paper/table1.json", "--force", "data/fe-car/C56.csv", "--channel",
                             "barrier_impulse_FTZ", "--force-arm", "1.7", "-o", "out"},
                            {"the time of maximum crush, is not set: give it, or start = impact"}},
                    Refusal{"is_the_input",
                            {{"t.csv", test::half_sine_trace()}},
                            {"pulse", "t.csv", "-o", "t.csv", "--force"},
                            {"t.csv: is an input: choose another name for the output"}},
                    Refusal{"no_folder",
                            {{"t.csv", test::half_sine_trace()}},
                            {"pulse", "t.csv", "-o", "a/b/out"},
                            {"a/b/out: there is no folder a/b: make it first"}},
                    Refusal{"a_folder",
                            {{"t.csv", test::half_sine_trace()}},
                            {"pulse", "t.csv", "-o", "."},
                            {".: is a folder: name a file to write"}}));

const std::vector<std::string> kVerticalForce = {
    "identify-vertical", "data/fe-car/C56.csv", "--channel", "barrier_impulse_FTZ",
    "--longitudinal",    "barrier_impulse_FNX", "-o",        "out"};

std::vector<std::string> vertical_force_with(const std::vector<std::string>& options) {
  std::vector<std::string> arguments = kVerticalForce;
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

INSTANTIATE_TEST_SUITE_P(
    NamedNumbers, BadUsage,
    testing::Values(Refusal{"no_force_for_identify_pitch",
                            {},
                            {"identify-pitch", "data/paper/table1.json", "-o", "out"},
                            {"identify-pitch: --force is required: the trace with the barrier's force"}},
                    Refusal{"no_motion",
                            {},
                            {"identify-pitch", "data/paper/table1.json", "--force", "data/fe-car/C56.csv", "-o", "out"},
                            {"identify-pitch: --motion is required: the trace with the body's vertical motion"}},
                    Refusal{"no_crush", {}, vertical_force_with({}), {"data/fe-car/C56.csv: ", "displacement_m"}},
                    Refusal{"unknown_number",
                            {},
                            vertical_force_with({"--crush", "LEFT_REAR_DX", "--free", "angle,frction"}),
                            {"IdentifyVerticalOptions.free: unknown name 'frction', did you mean 'friction'?"}}));

INSTANTIATE_TEST_SUITE_P(
    Values, BadUsage,
    testing::Values(
        with_options("unit_of_another_quantity", "pulse", {"--mass", "5m"},
                     {"--mass = '5m': 'm' measures length, not mass"}),
        with_options("unknown_unit", "pulse", {"--speed", "5furlongs"},
                     {"--speed = '5furlongs': unknown unit 'furlongs'"}),
        with_options("no_number", "pulse", {"--speed", "fast"}, {"--speed = 'fast': is not a finite number"}),
        with_options("decimal_comma", "pulse", {"--speed", "15,5"}, {"--speed = '15,5': ", "the decimal mark is '.'"}),
        with_options("not_finite", "pulse", {"--mass", "inf"}, {"--mass = 'inf': is not a finite number"}),
        with_options("negative_mass", "pulse", {"--mass", "-3"}, {"--mass = -3 kg: must be > 0"}),
        with_options("zero_mass", "identify", {"--mass", "0"}, {"--mass = 0 kg: must be > 0"}),
        with_options("zero_speed", "simulate", {"--speed", "0"}, {"--speed = 0 m/s: must be > 0"}),
        with_options("negative_filter", "pulse", {"--cfc", "-60"}, {"--cfc = -60 Hz: must be >= 0"}),
        with_options("no_start", "identify", {"--starts", "0"}, {"--starts = 0: must be >= 1 and <= 1"}),
        with_options("part_of_a_start", "identify", {"--starts", "2.5"}, {"--starts = 2.5: must be a whole number"}),
        with_options("negative_seed", "identify", {"--seed", "-1"}, {"--seed = -1: must be >= 0"}),
        with_options("seed_beyond_64_bits", "identify", {"--seed", "100000000000000000000"},
                     {"--seed = 1e+20: is too large for a whole number"}),
        with_options("too_many_knots", "identify", {"--spring-knots", "101"},
                     {"--spring-knots = 101: must be >= 0 and <= 100"}),
        with_options("tolerance_too_loose", "simulate", {"--rtol", "1"}, {"--rtol = 1: must be >= 1e-12 and <= 0.01"}),
        with_options("no_interval", "simulate", {"--dt", "0"}, {"--dt = 0 s: must be > 0"}),
        with_options("too_many_samples", "simulate", {"--dt", "1e-12"},
                     {"samples to 0.2 s are more than", "choose a larger interval"}),
        with_options("output_times_decrease", "simulate", {"--times", "0.1,0.05"},
                     {"times_s[1] = 0.05 s: times must be finite and increase from 0"}),
        with_options("unknown_loss", "identify", {"--loss", "l3"},
                     {"--loss: unknown name 'l3', did you mean 'l1'? (known: l1, l2, huber)"}),
        with_options("unknown_algorithm", "identify", {"--algorithm", "simplex"},
                     {"--algorithm: unknown name 'simplex' (known: lbfgs, slsqp, tnewton, var2)"}),
        with_options("unknown_rule", "identify", {"--knots", "even"},
                     {"--knots = 'even': must be uniform, quantile, free or numbers"}),
        with_options("knots_decrease", "identify", {"--knots", "0,0.2,0.1"},
                     {"knots[2] = 0.1 m: knots must start at 0 and increase strictly"}),
        with_options("knots_do_not_start_at_0", "identify", {"--knots", "0.1,0.2"},
                     {"knots[0] = 0.1 m: knots must start at 0 and increase strictly"}),
        with_options("two_weights", "identify", {"--weights", "1,2"},
                     {"weights = 1,2: three numbers >= 0, not all 0, are needed"}),
        with_options("no_knots_at_all", "identify", {"--spring-knots", "0", "--damper-knots", "0"},
                     {"there is nothing to identify"}),
        Refusal{"no_mass",
                {{"t.csv", test::half_sine_trace().substr(test::half_sine_trace().find("# impact"))}},
                {"identify", "t.csv", "-o", "out"},
                {"mass_kg: not given, and the pulse does not say it: give the test mass"}}));

}  // namespace
}  // namespace crashsim
