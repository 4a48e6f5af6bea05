#include <crashsim/sweep.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/error.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/outputs.hpp>

#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

const std::string kData = std::string(test::source_dir()) + "/data";
/// Relative, of samples by Taylor series against a case by CVODE, both with rtol 1e-8: measured 3e-9 and less.
constexpr double kSolver = 3e-8;
constexpr double kRounding = 1e-12;

std::string crush_case(const std::string& more) {
  return fmt::format(
      "[impact]\nspeed = 14\n[crush]\nmodel = \"{}/neon-kw400/model.json\"\nunloading = \"plastic\"\n"
      "restitution = 0.15\n{}",
      kData, more);
}
std::string pitch_case(const std::string& more) {
  return crush_case(
      "[vehicle]\npitch_inertia = 2000\nfront_axle = 1.1\nrear_axle = 1.5\nfront_stiffness = 4e4\n"
      "rear_stiffness = 4e4\nfront_damping = 3e3\nrear_damping = 3e3\ncg_height = 0.54\n"
      "force_height = 0.48\nforce_arm = 1.3\n[pitch]\nangle = 0.02\nend = 0.25\n" +
      more);
}

class Sweep : public testing::Test {
 protected:
  Case read(const std::string& text) { return read_case(dir.file("case.toml", text)); }
  /// All samples of a case.
  SampleTable run(const std::string& text) { return *run_case(read(text)).samples; }
  test::TempDir dir;
};

/// A row's numbers and outcome against the summary of a case.
void expect_same(const SampleTable& table, std::size_t row, const CaseResult& result) {
  const Summary summary = summarize(result);
  EXPECT_EQ(table.outcomes[row], std::get<std::string>(summary.front().value));
  for (std::size_t i = 0; i < table.outputs.size(); ++i) {
    const auto item = std::find_if(summary.begin(), summary.end(),
                                   [&](const SummaryItem& one) { return one.name == table.outputs[i]; });
    ASSERT_NE(item, summary.end()) << table.outputs[i];
    const double expected = std::get<double>(item->value), found = table.at(row, table.inputs.size() + i);
    if (std::isnan(expected))
      EXPECT_TRUE(std::isnan(found)) << table.outputs[i];
    else
      EXPECT_NEAR(found, expected, kSolver * std::fmax(std::fabs(expected), 1e-3)) << table.outputs[i];
  }
}

TEST_F(Sweep, AGridIsEveryCombination) {
  const SampleTable table =
      run(crush_case("[sweep]\nmass = \"1000 kg .. 1400 kg : 3\"\nimpact.speed = [\"36 km/h\", 12]\n"));
  ASSERT_THAT(table.inputs, SizeIs(2));
  EXPECT_EQ(table.inputs[0].name, "vehicle.mass_kg");
  EXPECT_EQ(table.inputs[1].name, "impact.speed_mps");
  EXPECT_EQ(table.planned, 6U);
  EXPECT_THAT(table.samples, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(table.outcomes, Each("completed"));
  std::vector<double> masses, speeds;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    masses.push_back(table.at(row, 0));
    speeds.push_back(table.at(row, 1));
  }
  EXPECT_THAT(masses, ElementsAre(1000, 1000, 1200, 1200, 1400, 1400));
  EXPECT_THAT(speeds, ElementsAre(10, 12, 10, 12, 10, 12));
}

TEST_F(Sweep, SamplesOfTheCrushAreThoseOfCasesThatSayTheSame) {
  const SampleTable table =
      run(crush_case("[sweep]\nmass = [\"1.2 t\", 1500]\nspeed = [10, 16]\nrestitution = [0, 0.3]\n"
                     "crush.k2 = {values = [0.9, 1.2], relative = true}\n"));
  ASSERT_EQ(table.rows(), 16U);
  for (std::size_t row = 0; row < table.rows(); row += 3) {
    Case study = read(crush_case(""));
    study.what.mass_kg = table.at(row, 0);
    study.what.impact_speed_mps = table.at(row, 1);
    study.what.restitution = table.at(row, 2);
    CrushModel model = read_model(kData + "/neon-kw400/model.json");
    const double k2 = model.spring.ordinates[1] * (row % 2 == 0 ? 0.9 : 1.2);
    EXPECT_NEAR(table.at(row, 3), k2, kRounding * k2);
    model.spring.ordinates[1] = k2;
    study.what.model_file = dir.file("model.json", format_model(model));
    expect_same(table, row, run_case(study));
  }
}

TEST_F(Sweep, SamplesOfEveryLawAreThoseOfCasesThatSayTheSame) {
  CrushModel rate = read_model(kData + "/neon-kw400/model.json");
  rate.law = CrushLaw::rate;
  rate.rate_coefficient = 0.1;
  rate.reference_speed_mps = 0.5;
  CrushModel damping = read_model(kData + "/neon-kw400/model.json");
  damping.law = CrushLaw::crush_damping;
  damping.damper = {{0.0, 0.3}, {4e3, 1e3}};
  const std::string numbers[] = {"crush.rate_coefficient = {values = [0.5, 2.0], relative = true}\nk1 = [1e5]\n",
                                 "crush.c2 = [\"2 kN s/m\"]\nk1 = [1e5]\n"};
  for (const CrushModel& model : {rate, damping}) {
    const std::string file = dir.file(std::string(name_of(model.law)) + ".json", format_model(model));
    const std::string text = fmt::format("[impact]\nspeed = 14\n[crush]\nmodel = \"{}\"\n", file);
    const bool has_rate = model.law == CrushLaw::rate;
    const SampleTable table = run(text + "[sweep]\n" + numbers[has_rate ? 0 : 1]);
    EXPECT_EQ(table.inputs[0].name, has_rate ? "crush.rate_coefficient" : "crush.c2_ns_per_m");
    EXPECT_EQ(table.inputs[1].name, "crush.k1_n");
    ASSERT_EQ(table.rows(), has_rate ? 2U : 1U);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      CrushModel varied = model;
      varied.spring.ordinates[0] = 1e5;
      if (has_rate)
        varied.rate_coefficient = table.at(row, 0);
      else
        varied.damper.ordinates[1] = 2e3;
      Case study = read(text);
      study.what.model_file = dir.file("model.json", format_model(varied));
      expect_same(table, row, run_case(study));
    }
  }
}

TEST_F(Sweep, SamplesOfHeaveAndPitchAreThoseOfCasesThatSayTheSame) {
  const SampleTable table =
      run(pitch_case("coupled = true\n[sweep]\nforce_height = [\"450 mm\", 0.5]\n"
                     "pitch.angle = [0, 0.03]\nimpact.speed = [12]\nk1 = [1e5]\n"));
  ASSERT_EQ(table.rows(), 4U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Case study = read(pitch_case("coupled = true\n"));
    study.vehicle.force_height_m = table.at(row, 0);
    study.vertical.angle_rad = table.at(row, 1);
    study.what.impact_speed_mps = 12.0;
    CrushModel model = read_model(kData + "/neon-kw400/model.json");
    model.spring.ordinates[0] = 1e5;
    study.what.model_file = dir.file("model.json", format_model(model));
    const CaseResult result = run_case(study);
    const auto column = std::find(table.outputs.begin(), table.outputs.end(), "coupled_pitch_max_rad");
    ASSERT_NE(column, table.outputs.end());
    const auto at = table.inputs.size() + static_cast<std::size_t>(column - table.outputs.begin());
    EXPECT_NEAR(table.at(row, at), result.coupled->pitch_max_rad, kSolver);
    SampleTable phases = table;
    phases.outputs.resize(kMetricFields.size() + kPitchNumbers.size());
    phases.numbers.assign(table.numbers.begin() + static_cast<std::ptrdiff_t>(row * table.columns()),
                          table.numbers.begin() + static_cast<std::ptrdiff_t>((row + 1) * table.columns()));
    phases.outcomes = {table.outcomes[row]};
    expect_same(phases, 0, result);
  }
}

std::string pulse_case(const std::string& more) {
  return fmt::format(
      "[pulse]\nfile = \"{}/fe-car/C56.csv\"\nchannels = [\"LEFT_REAR_VX\"]\n[crush]\nspring_knots = 3\n"
      "damper_knots = 1\n[identify]\nstarts = 1\n{}",
      kData, more);
}

TEST_F(Sweep, MassAndSpeedAreOfTheVehicleNotOfTheTest) {
  const Case study = read(pulse_case("[sweep]\nmass = {values = [1.1], relative = true}\nspeed = [12]\n"));
  const CaseResult result = run_case(study);
  CrushModel model = result.model;  // identified once, from the test as it was
  model.mass_kg *= 1.1;
  SimulateOptions options;
  options.impact_speed_mps = 12.0;
  options.end_time_s = result.pulse->time_s.back();
  CaseResult expected;
  expected.model = model;
  expected.response = simulate(model, options);
  expect_same(*result.samples, 0, expected);
}

TEST_F(Sweep, WhatTheIdentificationDependsOnMakesASampleTheWholeChain) {
  const SampleTable table =
      run(pulse_case("[sweep]\npulse.cfc = [60, 180]\ncrush.spring_knots = [2, 4]\nmass = [1500]\n"));
  ASSERT_EQ(table.rows(), 4U);
  Case study = read(pulse_case(""));
  study.pulse.cfc = 180.0;
  study.identify.spring_knots = 4;
  const CaseResult other = run_case(study);
  CaseResult expected;
  expected.model = other.model;
  expected.model.mass_kg = 1500.0;
  SimulateOptions options;
  options.impact_speed_mps = other.response.impact_speed_mps;
  options.end_time_s = other.pulse->time_s.back();
  expected.response = simulate(expected.model, options);
  expect_same(table, 3, expected);
}

TEST_F(Sweep, DoesNotDependOnJobsOrParts) {
  for (const std::string& text : {crush_case("[monte_carlo]\nsamples = 700\nmass = {normal = [1354, 30]}\n"
                                             "k2 = {uniform = [0.8, 1.2], relative = true}\n"),
                                  pitch_case("[monte_carlo]\nsamples = 20\nmethod = \"latin_hypercube\"\n"
                                             "force_height = {triangular = [0.45, 0.48, 0.5]}\n")}) {
    Case study = read(text);
    study.identify.jobs = 1;
    const CaseResult result = run_case(study);
    const Record record{"0", "run", {}, {}, {}};
    const std::string whole = format_samples(*result.samples, record);
    study.identify.jobs = 3;
    const SamplePlan plan = plan_samples(study, result);
    EXPECT_EQ(format_samples(run_samples(plan, 0, plan.table.planned), record), whole);
    std::vector<SampleTable> parts = {run_samples(plan, 13, 1000), run_samples(plan, 0, 5), run_samples(plan, 5, 8)};
    for (SampleTable& part : parts)  // by way of files, as from several machines
      part = read_samples(dir.file("part.csv", format_samples(part, record)), plan.table);
    EXPECT_EQ(format_samples(join_samples(parts), record), whole);
    EXPECT_THAT(
        [&] {
          join_samples({parts[0], parts[1], parts[1]});
        },
        ThrowsMessage<InvalidInput>(HasSubstr("parts of samples overlap: sample 0 follows sample 4")));
    EXPECT_THAT(run_samples(plan, plan.table.planned, 5).samples, IsEmpty());
  }
}

TEST_F(Sweep, OnlySamplesOfTheStudyAreReadAgain) {
  const SampleTable table = run(crush_case("[sweep]\nmass = [1000, 1200]\n"));
  const std::string text = format_samples(table, {});
  const auto refused = [&](std::string from, const std::string& to, const char* message) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    const std::string path = dir.file("samples.csv", changed);
    EXPECT_THAT([&] { read_samples(path, table); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  refused("vehicle.mass_kg", "mass", "samples.csv:5: has other columns than the samples of this study");
  refused("\n1,1200,", "\n2,1200,", "samples.csv:7: '2' is no sample of 2");
  refused("\n1,1200,", "\n1,heavy,", "samples.csv:7: 'heavy' is not a number");
  refused("\n1,1200,", "\n1,", "samples.csv:7: has 20 cells, there are 21 columns");
}

TEST_F(Sweep, AFailedSampleIsARowWithItsOutcome) {
  const SampleTable table =
      run(crush_case("[simulate]\nend = 0.05\n[monte_carlo]\nsamples = 64\n"
                     "mass = {normal = [1354, 1000]}\nspeed = {uniform = [1, 30]}\n"));
  EXPECT_THAT(table.outcomes, AllOf(Contains("completed"), Contains("no_max_crush"), Contains("invalid_input")));
  EXPECT_TRUE(table.usable());
  const SampleSummary summary = summarize_samples(table);
  std::size_t all = 0, completed = 0;
  for (const auto& [outcome, count] : summary.outcomes) {
    all += count;
    if (outcome == "completed") completed = count;
  }
  EXPECT_EQ(all, 64U);
  EXPECT_EQ(summary.outputs[0].statistics.count, completed);
  EXPECT_EQ(summary.outputs[0].left_out, 64U - completed);
  EXPECT_EQ(summary.inputs[0].count, completed);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    EXPECT_EQ(table.outcomes[row] == "invalid_input", table.at(row, 0) <= 0.0);
    EXPECT_EQ(std::isnan(table.at(row, 2)), table.outcomes[row] != "completed");
  }
  const SampleTable none = run(crush_case("[simulate]\nend = 0.01\n[sweep]\nmass = [1000, 2000]\n"));
  EXPECT_THAT(none.outcomes, Each("no_max_crush"));
  EXPECT_FALSE(none.usable());
}

TEST_F(Sweep, SobolIndicesOfTheEnergyAreTheAnalyticOnes) {
  const SampleTable table =
      run(crush_case("[monte_carlo]\nmethod = \"saltelli\"\nsamples = 512\n"
                     "mass = {uniform = [1000, 2000]}\nspeed = {uniform = [10, 20]}\n"));
  EXPECT_EQ(table.rows(), 4U * 512U);
  const SampleSummary summary = summarize_samples(table);
  const SampleOutput& energy = summary.outputs.back();
  ASSERT_EQ(energy.name, "energy_j");
  // of a product m v^2: the squared means and variances of both factors
  const double m = 1500.0 * 1500.0, var_m = 1e6 / 12.0;
  const double mean_v2 = 700.0 / 3.0, v = mean_v2 * mean_v2, var_v = 3.1e6 / 50.0 - v;
  const double variance = m * var_v + v * var_m + var_m * var_v;
  constexpr double kSampling = 0.005;  // of 512 groups of Sobol's sequence, measured 0.001
  EXPECT_NEAR(energy.effects[0].first_order.value, v * var_m / variance, kSampling);
  EXPECT_NEAR(energy.effects[1].first_order.value, m * var_v / variance, kSampling);
  EXPECT_NEAR(energy.effects[0].total.value, 1.0 - m * var_v / variance, kSampling);
  EXPECT_NEAR(energy.effects[1].total.value, 1.0 - v * var_m / variance, kSampling);
  EXPECT_GT(energy.effects[0].first_order.error, 0.0);
}

TEST_F(Sweep, StoppedItKeepsWhatIsDone) {
  Case study = read(pitch_case("[monte_carlo]\nsamples = 100000\nforce_height = {uniform = [0.45, 0.5]}\n"));
  const SamplePlan plan = plan_samples(study, run_case(without_samples(study)));
  const SampleTable table = run_samples(plan, 0, plan.table.planned, [](int done, int) { return done == 0; });
  EXPECT_GT(table.rows(), 0U);
  EXPECT_LT(table.rows(), 100000U);
  EXPECT_FALSE(table.usable());
  const auto json = nlohmann::json::parse(format_sample_summary(table, summarize_samples(table), {}));
  EXPECT_EQ(json["outcome"], "interrupted");
}

TEST_F(Sweep, ComesBackFromItsRecord) {
  const Case study = read(crush_case(
      "[monte_carlo]\nsamples = 9\nseed = 12\n[monte_carlo.vehicle]\nmass = {lognormal = [\"1.3 t\", 30], lower = \"1 "
      "t\", "
      "upper = 1500}\n[monte_carlo.crush]\nk1 = {table = [0.9, 1, 1.1], weights = [1, 2, 1], relative = true}\n"));
  ASSERT_THAT(study.monte_carlo.vary, SizeIs(2));
  EXPECT_EQ(study.monte_carlo.vary[0],
            (Variation{"vehicle.mass", DistributionKind::lognormal, {"1.3 t", "30"}, {}, "1 t", "1500", false}));
  const std::string record = format_record(make_record("run", {study.path}, entries_of(study), {}));
  EXPECT_EQ(read_case(dir.file("case.lock.json", record)).monte_carlo, study.monte_carlo);
  const Case grid =
      read(crush_case("[sweep]\nk1 = {values = [1, 1.1], relative = true}\n\"speed\" = \"40 km/h..50 km/h:3\"\n"));
  const std::string again = format_record(make_record("run", {grid.path}, entries_of(grid), {}));
  EXPECT_EQ(read_case(dir.file("grid.lock.json", again)).sweep, grid.sweep);
}

struct Bad {
  const char* text;
  const char* message;
};

TEST_F(Sweep, BadKeysAreRefusedWhenTheCaseIsRead) {
  const Bad bad[] = {
      {"[sweep]\nmas = [1]\n",
       "case.toml:8: [sweep]: unknown name 'mas', did you mean 'vehicle.mass'? (known: crush.c, "},
      {"[sweep]\nvehicle.force_hight = [1]\n", "did you mean 'vehicle.force_height'?"},
      {"[monte_carlo]\nsample = 10\n", "case.toml:8: [monte_carlo]: unknown name 'sample', did you mean 'samples'?"},
      {"[sweep]\ncfc = [60]\n", "[sweep]: 'cfc' may be pulse.cfc or pitch.cfc: write which"},
      {"[sweep]\ncompare.start = [0]\n", "unknown name 'compare.start'"},
      {"[sweep]\ncrush.knots = [1]\n", "unknown name 'crush.knots'"},
      {"[sweep]\ncrush.law = [\"force\"]\n", "unknown name 'crush.law'"},
      {"[sweep]\nmass = [\"3 m\"]\n", "case.toml: [sweep] vehicle.mass[0] = '3 m': 'm' measures length, not mass"},
      {"[sweep]\nmass = [1000, -3]\n", "case.toml: [sweep] vehicle.mass = -3 kg: must be > 0"},
      {"[sweep]\nmass = \"1 t..2 t\"\n", "a range needs a count"},
      {"[sweep]\nmass = []\n", "case.toml: [sweep] vehicle.mass: has no numbers to vary over"},
      {"[sweep]\nmass = {normal = [1, 2]}\n", "a sweep takes a list of values; distributions stand in [monte_carlo]"},
      {"[sweep]\nmass = [1]\nvehicle.mass_kg = [2]\n", "has a distribution already"},
      {"[sweep]\nmass = [1]\n[monte_carlo]\nspeed = {uniform = [1, 2]}\n", "has both [sweep] and [monte_carlo]"},
      {"[monte_carlo]\nmass = 3\n",
       "case.toml:8: [monte_carlo] mass: needs a distribution: {normal = [mean, deviation]}"},
      {"[monte_carlo]\nmass = {normal = [1000]}\n", "[monte_carlo] vehicle.mass: normal [1000]: needs a mean and"},
      {"[monte_carlo]\nmass = {normal = [1, 2], lower = [3, 4]}\n",
       "[monte_carlo] vehicle.mass lower = '3,4': is not a number"},
      {"[monte_carlo]\ncrush.spring_knots = {uniform = [3, 7]}\n", "must be a whole number: give a table of values"},
      {"[monte_carlo]\nsamples = 10\n", "case.toml: [monte_carlo] names nothing that varies"},
      {"[monte_carlo]\nsamples = 1000000000\n", "samples = 1e+09: must be >= 1 and <= 1e+06"},
      {"[monte_carlo]\nmethod = \"sobel\"\n", "did you mean 'sobol'?"},
  };
  for (const auto& [text, message] : bad)
    EXPECT_THAT([&] { read(crush_case(text)); }, ThrowsMessage<InvalidInput>(HasSubstr(message))) << text;
}

TEST_F(Sweep, WhatTheModelCannotVaryIsRefused) {
  const std::string plain = fmt::format("[impact]\nspeed = 14\n[crush]\nmodel = \"{}/neon-kw400/model.json\"\n", kData);
  const Bad bad[] = {
      {"[sweep]\nk9 = [1]\n", "case.toml: [sweep] crush.k9: the model has the ordinates k1 to k"},
      {"[sweep]\nk = [1]\n", "crush.k: is a whole curve: give factors, with relative = true"},
      {"[sweep]\nk1 = [\"3 kN/m\"]\n", "measures stiffness, not force"},
      {"[sweep]\nk1 = [1]\nk = {values = [1], relative = true}\n", "crush.k1: is part of crush.k, which varies, too"},
      {"[sweep]\nrate_coefficient = [0.1]\n", "crush.rate_coefficient: goes with law rate, the model's is force"},
      {"[sweep]\nrestitution = [0.1]\n", R"(crush.restitution: goes with unloading = "plastic")"},
      {"[sweep]\nrestitution = [0.1]\nunloading_stiffness = [1e6]\n", "vary both: vary one of them"},
      {"[sweep]\nforce_height = {values = [0.9], relative = true}\n", "the case has no such number to multiply"},
      {"[sweep]\nmass = \"1 t..2 t:1000\"\nspeed = \"1..2:1000\"\nk1 = [1, 2]\n",
       "asks for 2e+06 samples: there may be 1e+06"},
  };
  for (const auto& [text, message] : bad)
    EXPECT_THAT([&] { run(plain + text); }, ThrowsMessage<InvalidInput>(HasSubstr(message))) << text;
  EXPECT_THAT([&] { run(pulse_case("[sweep]\npulse.cfc = [60]\nk1 = {values = [1], relative = true}\n")); },
              ThrowsMessage<InvalidInput>(HasSubstr("crush.k1: something varies that it is identified from")));
  EXPECT_THAT([&] { plan_samples(read(plain), {}); },
              ThrowsMessage<InvalidInput>(HasSubstr("has neither [sweep] nor [monte_carlo]")));
}

}  // namespace
}  // namespace crashsim
