#include <crashsim/model_io.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/error.hpp>

#include "support/random.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

PiecewiseLinear random_curve(test::Random& random, double step, double ordinate) {
  PiecewiseLinear curve{{0.0}, {random.between(0.0, ordinate)}};
  for (int i = random.whole(0, 9); i > 0; --i) {
    curve.knots.push_back(curve.knots.back() + random.between(0.01, 1.0) * step);
    curve.ordinates.push_back(random.whole(0, 4) == 0 ? 0.0 : random.between(0.0, ordinate));
  }
  return curve;
}

CrushModel random_model(test::Random& random) {
  CrushModel model;
  model.mass_kg = random.between(1.0, 5000.0);
  if (random.whole(0, 1) == 1) model.impact_speed_mps = random.between(0.1, 50.0);
  model.law = static_cast<CrushLaw>(random.whole(0, 3));
  model.extrapolation = static_cast<Extrapolation>(random.whole(0, 2));
  model.unloading.bilateral = random.whole(0, 1) == 1;
  const int unloading = random.whole(0, 2);
  if (unloading > 0) model.unloading.kind = UnloadingKind::plastic;
  if (unloading == 1) model.unloading.restitution = random.between(0.0, 1.0);
  if (unloading == 2) model.unloading.unloading_stiffness_n_per_m = random.between(1.0, 1e9);
  const int curves = model.law == CrushLaw::rate ? 2 : random.whole(0, 2);
  if (model.law == CrushLaw::rate) {
    model.rate_coefficient = random.between(0.0, 1.0);
    model.reference_speed_mps = random.between(1e-6, 10.0);
  }
  if (curves != 1) model.spring = random_curve(random, 0.2, 1e7);
  if (curves != 2) model.damper = random_curve(random, 4.0, 1e5);
  return model;
}

void expect_same(const CrushModel& a, const CrushModel& b) {
  EXPECT_EQ(a.mass_kg, b.mass_kg);
  EXPECT_EQ(std::isnan(a.impact_speed_mps), std::isnan(b.impact_speed_mps));
  if (!std::isnan(a.impact_speed_mps)) {
    EXPECT_EQ(a.impact_speed_mps, b.impact_speed_mps);
  }
  EXPECT_EQ(a.law, b.law);
  EXPECT_EQ(a.extrapolation, b.extrapolation);
  EXPECT_EQ(a.unloading, b.unloading);
  EXPECT_EQ(a.spring, b.spring);
  EXPECT_EQ(a.damper, b.damper);
  EXPECT_EQ(std::isnan(a.rate_coefficient), std::isnan(b.rate_coefficient));
  if (a.law == CrushLaw::rate) {
    EXPECT_EQ(a.rate_coefficient, b.rate_coefficient);
    EXPECT_EQ(a.reference_speed_mps, b.reference_speed_mps);
  }
}

TEST(ModelFile, ComesBackBitForBit) {
  constexpr int kModels = 200;
  const test::TempDir dir;
  test::Random random(20);
  for (int i = 0; i < kModels; ++i) {
    const CrushModel model = random_model(random);
    const std::string text = format_model(model);
    const CrushModel back = read_model(dir.file("m.json", text));
    expect_same(back, model);
    EXPECT_EQ(format_model(back), text);
  }
}

TEST(ModelFile, KeepsVerySmallAndVeryLargeNumbers) {
  const test::TempDir dir;
  CrushModel model;
  model.mass_kg = 1e-300;
  model.spring = {{0.0, 5e-324, 1.0 / 3.0, 1e300}, {0.0, 5e-324, 0.1, 1e300}};
  expect_same(read_model(dir.file("m.json", format_model(model))), model);
}

TEST(ModelFile, NeedsLittleWhenWrittenByHand) {
  const test::TempDir dir;
  const CrushModel model = read_model(
      dir.file("m.json", R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1500, "title": "mine",
                             "source": null, "damper": {"knots_mps": [0], "ordinates_ns_per_m": [5]}})"));
  EXPECT_EQ(model.mass_kg, 1500.0);
  EXPECT_THAT(model.impact_speed_mps, testing::IsNan());
  EXPECT_EQ(model.law, CrushLaw::stiffness);
  EXPECT_EQ(model.extrapolation, Extrapolation::constant);
  EXPECT_EQ(model.unloading, Unloading());
  EXPECT_TRUE(model.spring.knots.empty());
}

TEST(ModelFile, SaysHowPlasticUnloadingGoes) {
  const test::TempDir dir;
  const auto unloading = [&](const std::string& keys) {
    return read_model(dir.file("m.json", R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1500,
        "spring": {"knots_m": [0], "ordinates_n_per_m": [1e6]}, "unloading": {"kind": "plastic", )" +
                                             keys + "}}"))
        .unloading;
  };
  EXPECT_EQ(unloading("\"restitution\": 0.15"), (Unloading{UnloadingKind::plastic, false, kUnset, 0.15}));
  EXPECT_EQ(unloading("\"unloading_stiffness_n_per_m\": 1e7, \"restitution\": null, \"bilateral\": true"),
            (Unloading{UnloadingKind::plastic, true, 1e7, kUnset}));
}

TEST(ModelFile, OfEachLawHasItsKeys) {
  const test::TempDir dir;
  const auto read = [&](const std::string& keys) {
    return read_model(
        dir.file("m.json", R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1500, )" + keys + "}"));
  };
  const auto refuses = [&](const std::string& keys, const std::string& message) {
    EXPECT_THAT([&] { read(keys); }, ThrowsMessage<InvalidInput>(HasSubstr(message))) << keys;
  };
  const std::string spring = R"("spring": {"knots_m": [0], "ordinates_n": [1e5]})";
  const CrushModel damping = read(R"("law": "crush_damping", "damper": {"knots_m": [0, 0.5],
      "ordinates_ns_per_m": [1, 2]}, )" +
                                  spring);
  EXPECT_EQ(damping.damper, (PiecewiseLinear{{0.0, 0.5}, {1.0, 2.0}}));
  EXPECT_EQ(damping.spring, (PiecewiseLinear{{0.0}, {1e5}}));
  const CrushModel rate = read(R"("law": "rate", "rate": {"coefficient": 0.1, "reference_speed_mps": 2}, )" + spring);
  EXPECT_EQ(rate.rate_coefficient, 0.1);
  EXPECT_EQ(rate.reference_speed_mps, 2.0);

  refuses(R"("law": "crush_damping", "damper": {"knots_mps": [0], "ordinates_ns_per_m": [1]})",
          "m.json: damper: unknown name 'knots_mps'");
  refuses(R"("law": "force", "damper": {"knots_m": [0], "ordinates_ns_per_m": [1]})",
          "m.json: damper: unknown name 'knots_m'");
  refuses(R"("law": "rate", "spring": {"knots_m": [0], "ordinates_n_per_m": [1]})",
          "m.json: spring: unknown name 'ordinates_n_per_m'");
  refuses(R"("law": "rate", )" + spring, "m.json: CrushModel.rate_coefficient = nan: must be >= 0 with law rate");
  refuses(R"("law": "rate", "rate": {"coefficient": 0.1}, )" + spring, "m.json: rate: has no 'reference_speed_mps'");
  refuses(R"("law": "rate", "rate": {"coefficient": -1, "reference_speed_mps": 2}, )" + spring,
          "m.json: CrushModel.rate_coefficient = -1: must be >= 0 with law rate");
  refuses(R"("law": "rate", "rate": {"coefficient": 1, "reference_speed_mps": 2, "r": 3}, )" + spring,
          "m.json: rate: unknown name 'r'");
  refuses(R"("law": "force", "rate": {"coefficient": 0.1, "reference_speed_mps": 2}, )" + spring,
          "m.json: CrushModel.rate_coefficient: goes with law rate, this is force");
  refuses(R"("law": "rate", "rate": {"coefficient": 0.1, "reference_speed_mps": 2}, "damper": {"knots_mps": [0],
          "ordinates_ns_per_m": [1]}, )" +
              spring,
          "m.json: CrushModel.damper: law rate has none");
  refuses(R"("law": "ratio", )" + spring, "m.json: law: unknown name 'ratio', did you mean 'rate'?");
}

TEST(ModelFile, CarriesIdentificationAndRecordThatAreNotRead) {
  const test::TempDir dir;
  CrushModel model;
  model.mass_kg = 1.0;
  model.spring = {{0.0, 1.0}, {1.0, 2.0}};
  Identification fit;
  fit.model = model;
  fit.outcome = IdentifyOutcome::completed;
  fit.error.total = 0.25;
  fit.seed = 7;
  fit.ordinates = {{"k1", FittedPart::spring, 1.0, kUnset, 4.0, true, false},
                   {"k2", FittedPart::spring, 2.0, 0.5, 4.0, false, true}};
  const Record record = make_record("identify", {"p.csv"}, {}, {});
  const std::string text = format_model(model, &fit, &record);
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json["identification"]["error"], 0.25);
  EXPECT_EQ(json["identification"]["standard_error"], nlohmann::json::parse(R"({"spring": [null, 0.5]})"));
  EXPECT_EQ(json["identification"]["untouched"], nlohmann::json({"k1"}));
  EXPECT_EQ(json["identification"]["at_bound"], nlohmann::json({"k2"}));
  EXPECT_EQ(json["record"], nlohmann::json::parse(to_json(record)));
  expect_same(read_model(dir.file("m.json", text)), model);
}

TEST(ModelFile, OfABadModelIsNotWritten) {
  CrushModel model;
  model.mass_kg = -3.0;
  model.spring = {{0.0, 1.0}, {1.0, 2.0}};
  EXPECT_THAT([&] { static_cast<void>(format_model(model)); },
              ThrowsMessage<InvalidInput>(HasSubstr("CrushModel.mass_kg = -3 kg: must be > 0")));
}

TEST(ModelFile, WithANumberThatNoDoubleHoldsIsRefused) {
  const test::TempDir dir;
  const std::string path = dir.file("m.json", R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1e999})");
  EXPECT_THAT([&] { static_cast<void>(read_model(path)); },
              ThrowsMessage<InvalidInput>(HasSubstr("m.json: is not JSON: number overflow parsing '1e999'")));
}

TEST(ModelKeys, AreThoseThatAreWritten) {
  std::vector<std::string> known;
  for (const FileKey& key : model_keys()) known.push_back(key.section.empty() ? key.key : key.section + "." + key.key);
  test::Random random(3);
  for (int i = 0; i < 40; ++i) {
    const nlohmann::json json = nlohmann::json::parse(format_model(random_model(random)));
    for (const auto& [key, value] : json.items()) {
      EXPECT_THAT(known, testing::Contains(key));
      if (!value.is_object()) continue;
      for (const auto& [inner, item] : value.items()) EXPECT_THAT(known, testing::Contains(key + "." + inner));
    }
  }
}

}  // namespace
}  // namespace crashsim
