#include <crashsim/case.hpp>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/outputs.hpp>

#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

const std::string kData = std::string(test::source_dir()) + "/data";
constexpr const char* kPulseOnly = "[pulse]\nfile = \"t.csv\"\n";

constexpr const char* kFullCase = R"(title = "a study"
[vehicle]
mass = "1.2 t"
[impact]
speed = "56 km/h"
[pulse]
file = "t.csv"
channels = [13, "RIGHT*"]
cfc = 180
bias = [0.0, 0.001]
t0 = "5ms"
[crush]
law = "force"
knots = [0, 0.2, 0.7]
unloading = "plastic"
unloading_stiffness = "20 kN/mm"
bilateral = true
[identify]
starts = 3
seed = 4611686018427387905
loss = "huber"
weights = "1, 2, 0.5"
pulses = ["u.csv", "../v.csv"]
[simulate]
dt = "1ms"
integrator = "taylor"
[compare]
channel = "accel*"
end = 0.1
[predict]
speeds = ["40 km/h", 12]
)";

/// Some value of the kind that a key's default has, other than the default.
std::pair<std::string, OptionValue> other_value(const ConfigEntry& entry, const FieldDescription& about) {
  if (about.choices.ends_with("or numbers")) return {"[0.25, 0.5]", std::vector<double>{0.25, 0.5}};
  if (!about.choices.empty()) {
    const std::size_t comma = about.choices.rfind(' ');
    const std::string last = comma == std::string::npos ? about.choices : about.choices.substr(comma + 1);
    return {"\"" + last + "\"", last};
  }
  if (std::holds_alternative<bool>(entry.value)) return {"true", true};
  if (std::holds_alternative<std::int64_t>(entry.value)) return {"3", std::int64_t{3}};
  if (std::holds_alternative<std::string>(entry.value)) return {"\"some.csv\"", std::string("some.csv")};
  if (std::holds_alternative<std::vector<double>>(entry.value)) return {"[1.5, 2.5]", std::vector<double>{1.5, 2.5}};
  if (std::holds_alternative<std::vector<std::string>>(entry.value))
    return {"[\"a\", \"b\"]", std::vector<std::string>{"a", "b"}};
  return {"0.005", 0.005};
}

const ConfigEntry& entry_of(const std::vector<ConfigEntry>& entries, const FileKey& key) {
  for (const ConfigEntry& entry : entries)
    if (entry.section == key.section && entry.key == key.key) return entry;
  throw std::runtime_error("no entry " + key.section + "." + key.key);
}

/// What a case that speaks of pitch must say of its vehicle, but for one key.
std::string vehicle_without(const std::string& key) {
  std::string text;
  for (const char* line : {"pitch_inertia = 2000", "front_axle = 1.2", "rear_axle = 1.4", "front_stiffness = 6e4",
                           "rear_stiffness = 4e4", "front_damping = 3e3", "rear_damping = 6e3"})
    if (!std::string_view(line).starts_with(key + " =")) text += std::string(line) + "\n";
  return text;
}

TEST(Case, EveryKeyCanBeSetAndIsRecorded) {
  const test::TempDir dir;
  const std::vector<ConfigEntry> defaults = entries_of(Case());
  std::vector<FileKey> keys = case_keys();
  std::erase_if(keys, [](const FileKey& key) { return key.key == "<section>.<key>"; });  // of sweep_test.cpp
  EXPECT_EQ(keys.size(), defaults.size());
  for (const FileKey& key : keys) {
    const auto [text, value] = other_value(entry_of(defaults, key), key.about);
    const std::string line = key.key + " = " + text + "\n";
    std::string toml = key.section.empty() ? line : fmt::format("[{}]\n{}", key.section, line);
    if (key.section == "pulse" && key.key != "file") toml += "file = \"t.csv\"\n";
    if (key.key == "unloading_stiffness" || key.key == "restitution") toml += "unloading = \"plastic\"\n";
    if (key.section == "vehicle") toml += vehicle_without(key.key);
    if (key.key == "motion") toml += "front_position = 1\nrear_position = 0\ncg_position = 0\n";
    if (key.section == "pitch" || key.key == "motion") toml += "[vehicle]\n" + vehicle_without("");
    if (key.section == "monte_carlo") toml += "vehicle.mass = {uniform = [1, 2]}\n";
    if (key.section != "pulse") toml += kPulseOnly;
    const Case study = read_case(dir.file("case.toml", toml));
    EXPECT_EQ(entry_of(entries_of(study), key).value, value) << toml;
  }
}

TEST(Case, KeysAreNamedByFlagOrField) {
  const test::TempDir dir;
  const Case study =
      read_case(dir.file("case.toml", std::string(kPulseOnly) + "channels = [\"a\"]\n[crush]\nspring_knots = 3\n"
                                                                "[simulate]\nend_time_s = 0.3\n"));
  EXPECT_THAT(study.pulse.channels, ElementsAre("a"));
  EXPECT_EQ(study.identify.spring_knots, 3);
  EXPECT_EQ(study.simulation.end_time_s, 0.3);
}

TEST(Case, OptionsGoWhereTheyBelong) {
  const test::TempDir dir;
  const Case study = read_case(dir.file("case.toml", kFullCase));
  EXPECT_EQ(study.what.title, "a study");
  EXPECT_EQ(study.what.mass_kg, 1200.0);
  EXPECT_DOUBLE_EQ(study.what.impact_speed_mps, 56.0 / 3.6);
  EXPECT_THAT(study.pulse.channels, ElementsAre("13", "RIGHT*"));
  EXPECT_EQ(study.pulse.t0, (Setting<TimeZero>{TimeZero::given, {0.005}}));
  EXPECT_EQ(study.identify.law, CrushLaw::force);
  EXPECT_EQ(study.identify.seed, 4611686018427387905u);
  EXPECT_EQ(study.identify.weights, (Setting<Weights>{Weights::given, {1.0, 2.0, 0.5}}));
  EXPECT_THAT(study.what.further_pulses, ElementsAre("u.csv", "../v.csv"));
  EXPECT_TRUE(study.what.bilateral);
  EXPECT_EQ(study.what.unloading, UnloadingKind::plastic);
  EXPECT_EQ(study.what.unloading_stiffness_n_per_m, 2e7);
  EXPECT_THAT(study.what.restitution, testing::IsNan());
  EXPECT_EQ(study.simulation.dt_s, 0.001);
  EXPECT_EQ(study.comparison.end_s, 0.1);
  EXPECT_THAT(study.what.speeds_mps, ElementsAre(testing::DoubleEq(40.0 / 3.6), 12.0));
}

TEST(Case, ComesBackFromItsRecord) {
  const test::TempDir dir;
  const Case study = read_case(dir.file("case.toml", kFullCase));
  const std::vector<ConfigEntry> entries = entries_of(study);
  const Case back = read_case(dir.file("case.lock.json", format_record(make_record("run", {study.path}, entries, {}))));
  EXPECT_EQ(back.path, study.path);
  const std::vector<ConfigEntry> again = entries_of(back);
  ASSERT_EQ(again.size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) EXPECT_EQ(again[i].value, entries[i].value) << entries[i].key;
}

TEST(Case, TheRecordOfAnotherCommandIsNoCase) {
  const test::TempDir dir;
  const std::string path = dir.file("r.json", format_record(make_record("pulse", {"t.csv"}, {}, {})));
  EXPECT_THAT([&] { static_cast<void>(read_case(path)); },
              ThrowsMessage<InvalidInput>(HasSubstr("r.json: is the record of 'crashsim pulse', not of a case")));
}

TEST(Case, NamesItsInputsAndFiles) {
  const test::TempDir dir;
  const Case fit = read_case(dir.file("case.toml", kFullCase));
  EXPECT_THAT(case_inputs(fit), ElementsAre(dir.path("case.toml"), dir.path("t.csv"), dir.path("u.csv"),
                                            std::filesystem::path(dir.path("../v.csv")).lexically_normal().string()));
  EXPECT_THAT(case_file_names(fit),
              ElementsAre("pulse.csv", "model.json", "response.csv", "prediction_40kmh.csv", "prediction_43.2kmh.csv",
                          "comparison.json", "summary.json", "case.lock.json"));
  const Case given = read_case(dir.file("given.toml", "[crush]\nmodel = \"m.json\"\n"));
  EXPECT_THAT(case_inputs(given), ElementsAre(dir.path("given.toml"), dir.path("m.json")));
  EXPECT_THAT(case_file_names(given), ElementsAre("model.json", "response.csv", "summary.json", "case.lock.json"));
}

TEST(RunCase, TheFiniteElementCarGivesAUsableModel) {
  Case study = read_case(kData + "/fe-car/case.toml");
  study.identify.starts = 2;
  study.what.speeds_mps = {16.0};
  const CaseResult result = run_case(study);
  EXPECT_TRUE(result.usable());
  ASSERT_TRUE(result.pulse && result.identification);
  EXPECT_EQ(result.response.impact_speed_mps, 15.64);
  EXPECT_EQ(result.response.time_s.back(), result.pulse->time_s.back());
  EXPECT_THAT(result.predictions, SizeIs(1));
  EXPECT_THAT(result.comparisons, SizeIs(2));
  EXPECT_EQ(result.comparisons[0].name, "to_max_crush");
  EXPECT_LE(result.comparisons[0].result.end_s, result.pulse->t_m_s);
  EXPECT_THAT(result.input_files, ElementsAre(kData + "/fe-car/C56.csv"));
  std::vector<std::string> names;
  for (const FileText& file : case_files(study, result)) names.push_back(file.name);
  EXPECT_EQ(names, case_file_names(study));
}

TEST(RunCase, AModelAloneIsSimulated) {
  const test::TempDir dir;
  std::filesystem::create_directory(dir.path("sub"));
  dir.file("m.json", read_file(kData + "/syn-a/model.json"));
  const Case study =
      read_case(dir.file("sub/case.toml", "[impact]\nspeed = 10\n[crush]\nmodel = \"../m.json\"\nbilateral = true\n"));
  const CaseResult result = run_case(study);
  EXPECT_TRUE(result.usable());
  EXPECT_FALSE(result.pulse || result.identification);
  EXPECT_THAT(result.comparisons, IsEmpty());
  EXPECT_EQ(result.response.impact_speed_mps, 10.0);
  EXPECT_TRUE(result.model.unloading.bilateral);
  EXPECT_THAT(result.input_files, ElementsAre(dir.path("m.json")));
  const auto summary = nlohmann::json::parse(format_summary(summarize(result), summary_parts(result)));
  EXPECT_EQ(summary["outcome"], "completed");
  EXPECT_EQ(summary["impact_speed_mps"], 10.0);
}

TEST(RunCase, AModelKeepsWhatTheCaseDoesNotSay) {
  const test::TempDir dir;
  CrushModel model;
  model.mass_kg = 1500.0;
  model.impact_speed_mps = 15.0;
  model.spring = {{0.0}, {1e6}};
  model.unloading.bilateral = true;
  dir.file("m.json", format_model(model));
  const std::string crush = "[crush]\nmodel = \"m.json\"\n";
  const CaseResult as_it_is = run_case(read_case(dir.file("a.toml", crush)));
  EXPECT_TRUE(as_it_is.model.unloading.bilateral);
  EXPECT_EQ(as_it_is.model.mass_kg, 1500.0);
  EXPECT_EQ(as_it_is.response.impact_speed_mps, 15.0);
  const CaseResult heavier = run_case(read_case(dir.file("b.toml", crush + "[vehicle]\nmass = \"2 t\"\n")));
  EXPECT_EQ(heavier.model.mass_kg, 2000.0);
  EXPECT_GT(heavier.response.max_crush_m, as_it_is.response.max_crush_m);
}

TEST(RunCase, AModelIsComparedWithATest) {
  const test::TempDir dir;
  const Case study = read_case(dir.file(
      "case.toml", fmt::format("[pulse]\nfile = \"{0}/fe-car/C56.csv\"\nchannels = [\"LEFT_REAR_VX\"]\n"
                               "[crush]\nmodel = \"{0}/syn-a/model.json\"\n[compare]\nchannel = [\"velocity*\"]\n",
                               kData)));
  const CaseResult result = run_case(study);
  EXPECT_FALSE(result.identification.has_value());
  ASSERT_THAT(result.comparisons, SizeIs(2));
  ASSERT_THAT(result.comparisons[1].result.channels, SizeIs(1));
  EXPECT_EQ(result.comparisons[1].result.channels[0].name, "velocity_mps");
}

constexpr const char* kVehicle =
    "[vehicle]\npitch_inertia = 2000\nfront_axle = 1.2\nrear_axle = 1.4\nfront_stiffness = 6e4\n"
    "rear_stiffness = 4e4\nfront_damping = 3e3\nrear_damping = 6e3\nforce_arm = 1.7\n";

TEST(RunCase, ThePitchOfAVehicleComesFromTheForceThatItNames) {
  const test::TempDir dir;
  const Case study = read_case(dir.file(
      "case.toml", fmt::format("[crush]\nmodel = \"{0}/syn-a/model.json\"\n{1}[pitch]\nend = \"200 ms\"\nforce = "
                               "{{file = \"{0}/fe-car/C56.csv\", channel = \"barrier_impulse_FTZ\"}}\n",
                               kData, kVehicle)));
  const CaseResult result = run_case(study);
  ASSERT_TRUE(result.pitch.has_value());
  EXPECT_EQ(result.pitch->start_time_s, result.response.t_m_s);
  ForcingOptions forcing;
  forcing.file = kData + "/fe-car/C56.csv";
  forcing.vertical_channels = {"barrier_impulse_FTZ"};
  forcing.t_m_s = result.response.t_m_s;
  HeavePitchModel vehicle = study.vehicle;
  vehicle.mass_kg = result.model.mass_kg;
  const PitchResponse alone = simulate_pitch(vehicle, read_forcing(forcing).forcing, study.motion);
  EXPECT_EQ(result.pitch->pitch_rad, alone.pitch_rad);
  EXPECT_THAT(result.input_files, testing::Contains(testing::EndsWith("C56.csv")));
  const auto summary = nlohmann::json::parse(format_summary(summarize(result), summary_parts(result)));
  EXPECT_EQ(summary["pitch_max_rad"], alone.pitch_max_rad);
  EXPECT_THAT(case_file_names(study), testing::Contains("pitch.csv"));
}

TEST(RunCase, TheSimulatedCrushForcePitchesAVehicleThatSaysItsHeights) {
  const test::TempDir dir;
  const std::string text =
      fmt::format("[crush]\nmodel = \"{}/syn-a/model.json\"\n{}cg_height = 0.6\n", kData, kVehicle);
  const Case study = read_case(dir.file("a.toml", text + "force_height = 0.4\n[pitch]\nstart = \"impact\"\n"));
  const CaseResult result = run_case(study);
  ASSERT_TRUE(result.pitch.has_value());
  EXPECT_GT(result.pitch->pitch_max_rad, 0.0);
  EXPECT_FALSE(result.forcing.has_value());
  EXPECT_THAT(result.notes, IsEmpty());
  EXPECT_THAT([&] { static_cast<void>(run_case(read_case(dir.file("b.toml", text)))); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("force_height_m is not set")));
}

/// SYN_A unloaded plastically, beside the pulse of the finite-element car.
std::string plastic_case(const std::string& crush) {
  return fmt::format(
      "[pulse]\nfile = \"{0}/fe-car/C56.csv\"\nchannels = [\"LEFT_REAR_VX\"]\n"
      "[crush]\nmodel = \"{0}/syn-a/model.json\"\nunloading = \"plastic\"\n{1}",
      kData, crush);
}

TEST(RunCase, PlasticUnloadingTakesTheRestitutionOfThePulse) {
  const test::TempDir dir;
  const CaseResult result = run_case(read_case(dir.file("case.toml", plastic_case(""))));
  const double e = metrics_of(*result.pulse).restitution;
  EXPECT_EQ(result.model.unloading, (Unloading{UnloadingKind::plastic, false, kUnset, e}));
  EXPECT_NEAR(-result.response.rebound_velocity_mps, e * result.response.impact_speed_mps, 1e-6);
  EXPECT_THAT(result.notes, ElementsAre(HasSubstr("restitution 0.0")));

  const CaseResult given = run_case(read_case(dir.file("given.toml", plastic_case("restitution = 0.25\n"))));
  EXPECT_EQ(given.model.unloading, (Unloading{UnloadingKind::plastic, false, kUnset, 0.25}));
  EXPECT_THAT(given.notes, IsEmpty());
}

TEST(RunCase, PlasticUnloadingWithoutARestitutionIsRefused) {
  const test::TempDir dir;
  Case study = read_case(dir.file("case.toml", plastic_case("")));
  std::string until_max_crush = "# mass_kg = 1000\n# impact_speed_mps = 10\ntime_s,accel_mps2\n";
  for (int i = 0; i <= 100; ++i) until_max_crush += fmt::format("{:.4f},{}\n", 1e-3 * i, i == 0 ? 0 : -105);
  study.what.pulse_file = dir.file("short.csv", until_max_crush);
  study.pulse.channels.clear();
  EXPECT_THAT(
      [&] { run_case(study); },
      ThrowsMessage<InvalidInput>(HasSubstr(
          "case.toml: [crush] unloading = \"plastic\": the pulse has no restitution, it ends before the rebound "
          "does: give restitution or unloading_stiffness")));
  study.what.pulse_file.clear();
  EXPECT_THAT([&] { run_case(study); },
              ThrowsMessage<InvalidInput>(HasSubstr("there is no pulse to take a restitution from: give restitution")));
}

TEST(RunCase, AModelKeepsItsPlasticUnloadingUntilTheCaseSaysOther) {
  const test::TempDir dir;
  CrushModel model;
  model.mass_kg = 1500.0;
  model.impact_speed_mps = 15.0;
  model.spring = {{0.0}, {1e6}};
  model.unloading = {UnloadingKind::plastic, false, kUnset, 0.3};
  dir.file("m.json", format_model(model));
  const std::string crush = "[crush]\nmodel = \"m.json\"\n";
  EXPECT_EQ(run_case(read_case(dir.file("a.toml", crush))).model.unloading, model.unloading);
  const std::string stiffer = "unloading = \"plastic\"\nunloading_stiffness = 1e8\n";
  EXPECT_EQ(run_case(read_case(dir.file("b.toml", crush + stiffer))).model.unloading,
            (Unloading{UnloadingKind::plastic, false, 1e8, kUnset}));
}

TEST(RunCase, TheCoupledMotionStandsBesideTheTwoPhases) {
  const test::TempDir dir;
  const std::string text = fmt::format(
      "[crush]\nmodel = \"{}/syn-a/model.json\"\n{}cg_height = 0.6\nforce_height = 0.4\nlift_off = true\n"
      "[pitch]\ncoupled = true\nangle = 0.1\nfriction = 0.3\n",
      kData, kVehicle);
  const Case study = read_case(dir.file("case.toml", text));
  const CaseResult result = run_case(study);
  ASSERT_TRUE(result.pitch && result.coupled);
  EXPECT_GT(result.coupled->pitch_max_rad, 0.0);
  CoupledModel model{result.model, study.vehicle, study.vertical, study.ground};
  CoupledOptions options;
  options.dt_s = study.motion.dt_s;
  options.rtol = study.motion.rtol;
  EXPECT_EQ(result.coupled->pitch_rad, simulate_coupled(model, options).pitch_rad);
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("coupled it has pitched")));
  EXPECT_THAT(case_file_names(study), testing::IsSupersetOf({"pitch.csv", "coupled.csv"}));
  EXPECT_THAT(
      [&] {
        static_cast<void>(run_case(read_case(dir.file(
            "b.toml",
            text +
                fmt::format("force = {{file = \"{}/fe-car/C56.csv\", channel = \"barrier_impulse_FTZ\"}}\n", kData)))));
      },
      testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("leave one out")));
}

TEST(RunCase, HeaveAndPitchAreComparedWithMeasuredNodes) {
  const test::TempDir dir;
  const Case study = read_case(dir.file(
      "case.toml",
      fmt::format("[crush]\nmodel = \"{0}/syn-a/model.json\"\n{1}cg_height = 0.6\nforce_height = 0.5\n[compare]\n"
                  "motion = {{file = \"{0}/fe-car/C56.csv\", front = [\"*_MID_DZ\", \"*_MID_VZ\"], rear = "
                  "[\"*_REAR_DZ\", \"*_REAR_VZ\"], front_position = \"846.7 mm\", rear_position = 0, "
                  "cg_position = 0.65}}\n",
                  kData, kVehicle)));
  const CaseResult result = run_case(study);
  ASSERT_THAT(result.comparisons, SizeIs(1));
  EXPECT_EQ(result.comparisons[0].name, "heave_and_pitch");
  ASSERT_THAT(result.comparisons[0].result.channels, SizeIs(4));
  EXPECT_GE(result.comparisons[0].result.start_s, result.pitch->start_time_s);
  // Left and right rear sills, 120.3 mm up at 0.12 s by the file, against 89.0 mm at the middle ones.
  const MeasuredMotion measured = read_motion([&] {
    MotionOptions options = study.measured;
    options.file = kData + "/fe-car/C56.csv";
    return options;
  }());
  const auto at = static_cast<std::size_t>(
      std::lower_bound(measured.pitch_rad.time_s.begin(), measured.pitch_rad.time_s.end(), 0.12) -
      measured.pitch_rad.time_s.begin());
  EXPECT_NEAR(measured.pitch_rad.values[at], (120.3 - 89.0) / 846.7, 5e-4);
}

TEST(RunCase, CanBeStopped) {
  Case study = read_case(kData + "/fe-car/case.toml");
  study.identify.starts = 100000;
  study.identify.jobs = 1;
  const CaseResult result = run_case(study, [](int done, int) { return done < 1; });
  ASSERT_TRUE(result.identification.has_value());
  EXPECT_EQ(result.identification->outcome, IdentifyOutcome::interrupted);
  EXPECT_FALSE(result.usable());
}

}  // namespace
}  // namespace crashsim
