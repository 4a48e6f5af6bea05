/// Input made to do harm: a clear error, soon, and nothing written.

#include <chrono>
#include <ostream>
#include <string>

#include <gmock/gmock.h>

#include <sys/stat.h>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using namespace std::chrono_literals;
using test::Finished;
using test::kUserCanFix;
using testing::HasSubstr;

/// A text many times over.
std::string times(std::size_t count, const std::string& text) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

constexpr std::size_t kMany = 300'000, kMegabyte = 1'000'000;
constexpr const char* kSimulated = "[impact]\nspeed = 15\n[crush]\nmodel = \"model.json\"\n";
constexpr const char* kIdentified = "[pulse]\nfile = \"trace.csv\"\n";
constexpr const char* kVehicle =
    "[vehicle]\npitch_inertia = 3000\nfront_axle = 1.2\nrear_axle = 1.4\nfront_stiffness = 50000\n"
    "rear_stiffness = 50000\nfront_damping = 3000\nrear_damping = 3000\nforce_arm = 0.3\ncg_height = "
    "0.55\nforce_height = 0.3\n";

struct Attack {
  const char* name;
  std::string text;
  const char* expected;
  const char* file = "case.toml";  ///< What the text is; the case names it when it is a model.

  friend void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }
};

std::string record_with(const std::string& options) {
  return R"({"format": "crashsim.record", "version": "0.1.0", "command": "run", "arguments": ["x"], "options": )" +
         options + R"(, "inputs": []})";
}

const Attack kAttacks[] = {
    {"starts", std::string(kIdentified) + "[identify]\nstarts = 1000000000\n", "must be >= 1 and <= 1e+06"},
    {"jobs", std::string(kIdentified) + "[identify]\njobs = 1000000000\n", "must be >= 0 and <= 1024"},
    {"spring_knots", std::string(kIdentified) + "[crush]\nspring_knots = 1000000000\n", "must be >= 0 and <= 100"},
    {"damper_knots", std::string(kIdentified) + "[crush]\ndamper_knots = 1000000000\n", "must be >= 0 and <= 100"},
    {"cfc", std::string(kIdentified) + "cfc = 1000000000\n", "is too low for CFC1e+09"},
    {"design_starts", std::string(kSimulated) + "[design]\nstarts = 1000000000\n", "must be >= 1 and <= 10000"},
    {"dt", std::string(kSimulated) + "[simulate]\ndt = 1e-12\n", "are more than 10000000: choose a larger interval"},
    {"end", std::string(kSimulated) + "[simulate]\nend = 1000000000\ndt = 1000\n", "must be > 0 and <= 100"},
    {"pitch_dt", std::string(kSimulated) + kVehicle + "[pitch]\ndt = 1e-12\n", "more than 1e+07"},
    {"pitch_end", std::string(kSimulated) + kVehicle + "[pitch]\nend = 1000000000\n", "must be > 0 and <= 100"},
    {"speeds", std::string(kSimulated) + "[predict]\nspeeds = [" + times(2000, "20, ") + "]\n", "at most 1000 fit"},
    {"arrays_in_arrays", "title = " + times(kMany, "["), "exceeded maximum nested value depth"},
    {"inline_tables", "a = " + times(kMany, "{a="), "exceeded maximum nested value depth"},
    {"table_of_many_parts", "[" + times(kMany, "a.") + "a]\n", "case.toml:1: is a key of more than 100 parts"},
    {"key_of_many_parts", "\n" + times(kMany, "a.") + "a = 1\n", "case.toml:2: is a key of more than 100 parts"},
    {"quoted_parts", "# '\nt = '''''\"''''\nu = \"\\\"\"\n" + times(kMany, "',#'.") + "a = 1\n",
     "case.toml:4: is a key of"},
    {"long_key", std::string(kMegabyte, 'k') + " = 1\n", "case.toml:1: unknown name 'kkk"},
    {"long_section", "[" + std::string(kMegabyte, 'k') + "]\na = 1\n", "unknown name '[kkk"},
    {"long_value", "[impact]\nspeed = \"" + std::string(kMegabyte, '9') + "\"\n", "[impact] speed"},
    {"long_choice", std::string("[crush]\nlaw = \"") + std::string(kMegabyte, 'x') + "\"\n", "law: unknown name 'xxx"},
    {"long_channel", std::string(kIdentified) + "channels = [\"" + std::string(kMegabyte, 'x') + "\"]\n",
     "no channel 'xxx"},
    {"long_file", "[pulse]\nfile = \"" + std::string(kMegabyte, 'x') + "\"\n", "File name too long"},
    {"zeros", std::string(kMegabyte, '\0'), "is not TOML"},
    {"nested_json", R"({"a": )" + times(kMany, "["), "case.json: is nested more than 100 levels deep", "case.json"},
    {"nested_record", record_with(times(kMany, R"({"a": )") + "1" + times(kMany, "}")), "more than 100 levels",
     "case.json"},
    {"long_json_key", record_with(R"({")" + std::string(kMegabyte, 'k') + R"(": 1})"), "unknown name 'kkk",
     "case.json"},
    {"nested_model", R"({"spring": )" + times(kMany, "[") + times(kMany, "]") + "}", "model.json: is nested",
     "model.json"},
};

class Malicious : public testing::TestWithParam<Attack> {
 protected:
  /// The files of an attack.
  void put(const Attack& attack) const {
    workspace.file("trace.csv", test::half_sine_trace());
    workspace.file("model.json", workspace.text_of("data/syn-a/model.json"));
    workspace.file("case.toml", kSimulated);
    workspace.file(attack.file, attack.text);
  }
  /// The same error, and nothing else, from a command.
  void expect_refusal(const std::vector<std::string>& command) const {
    constexpr std::size_t kLongest = 6000;
    test::Launch launch;
    launch.time_limit = 20s;
    const Finished finished = workspace.run(command, launch);
    EXPECT_EQ(finished.exit_code, kUserCanFix) << finished.err.substr(0, kLongest);
    EXPECT_THAT(finished.err.substr(0, kLongest), HasSubstr(GetParam().expected));
    EXPECT_LT(finished.err.size(), kLongest);
  }
  test::Workspace workspace;
};

TEST_P(Malicious, IsRefused) {
  put(GetParam());
  const std::string file = std::string(GetParam().file) == "case.json" ? "case.json" : "case.toml";
  expect_refusal({"run", file, "-o", "out"});
  EXPECT_FALSE(workspace.has("out"));
  expect_refusal({"batch", file, "-o", "batch"});
  EXPECT_THAT(workspace.names("batch/cases"), testing::IsEmpty());
}

std::string name_of_attack(const testing::TestParamInfo<Attack>& attack) { return attack.param.name; }

INSTANTIATE_TEST_SUITE_P(Cases, Malicious, testing::ValuesIn(kAttacks), name_of_attack);

TEST(MaliciousFiles, DevicesAndPipesEnd) {
  const test::Workspace workspace;
  ASSERT_EQ(::mkfifo(workspace.path("pipe.toml").c_str(), 0600), 0);
  const Finished pipe = workspace.run({"batch", "pipe.toml", "-o", "out"});
  EXPECT_EQ(pipe.exit_code, kUserCanFix);
  EXPECT_THAT(pipe.err, HasSubstr("pipe.toml: is no regular file"));
}

TEST(MaliciousFiles, TracesOfYearsEnd) {
  const test::Workspace workspace;
  workspace.file("years.csv", "# mass_kg = 1500\n# impact_speed_mps = 15\ntime_s,accel_g\n0,-1\n1e9,-2\n2e9,0\n");
  test::Launch launch;
  launch.time_limit = 20s;
  const Finished finished = workspace.run({"pulse", "years.csv", "--cfc", "0", "-o", "pulse.csv"}, launch);
  EXPECT_LT(finished.exit_code, 128) << finished.err;
}

}  // namespace
}  // namespace crashsim
