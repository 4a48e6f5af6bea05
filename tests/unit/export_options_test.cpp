/// Exporting as such: options, the record, models that cards cannot say. What the cards are, export_test.cpp judges.

#include <string>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/export.hpp>
#include <crashsim/model_io.hpp>

#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const Record kRecord = {"0.0.0", "export", {"model.json"}, {}, {}};

CrushModel syn_a() { return read_model(std::string(test::source_dir()) + "/data/syn-a/model.json"); }

ExportOptions to(const std::string& target, const std::string& units = "kg-m-s", int id = 1) {
  return {.to = target, .units = units, .first_id = id};
}

TEST(Export, TheRecordInTheCardsIsFound) {
  const test::TempDir dir;
  for (const char* target : {"lsdyna", "radioss", "csv"}) {
    const auto record = find_record(dir.file(target, export_model(syn_a(), to(target), kRecord).text));
    ASSERT_TRUE(record) << target;
    EXPECT_EQ(record->command, "export");
  }
}

TEST(Export, UnitsThatAreNotSaidAreSi) {
  EXPECT_EQ(ExportOptions().units, "") << "so that readers of FE traces get what the user said";
  EXPECT_EQ(export_model(syn_a(), to("lsdyna", ""), kRecord).text, export_model(syn_a(), to("lsdyna"), kRecord).text);
}

TEST(Export, ASpringThatBearsNothingAtMaximumCrushUnloadsTheWayItLoads) {
  CrushModel model = syn_a();
  model.mass_kg = 1000.0;
  model.impact_speed_mps = 15.0;
  model.law = CrushLaw::force;
  model.spring = {{0.0, 0.5, 0.7}, {0.0, 0.0, 1e6}};
  model.damper = {{0.0}, {5e6}};  // stops it within millimetres
  model.unloading = {.kind = UnloadingKind::plastic, .restitution = 0.2};
  const Exported exported = export_model(model, to("lsdyna"), kRecord);
  EXPECT_THAT(exported.notes, Contains(HasSubstr("the spring bears no force at maximum crush")));
  EXPECT_THAT(exported.text,
              AllOf(HasSubstr("*MAT_SPRING_NONLINEAR_ELASTIC"), Not(HasSubstr("*MAT_SPRING_GENERAL_NONLINEAR"))));
}

TEST(Export, BadOptionsAndModelsAreRefused) {
  const auto refusal = [](const CrushModel& model, const ExportOptions& options) {
    try {
      export_model(model, options, kRecord);
    } catch (const InvalidInput& problem) {
      return std::string(problem.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal(syn_a(), {}), HasSubstr("to what? give --to lsdyna, radioss, csv or iso-mme"));
  EXPECT_THAT(refusal(syn_a(), to("lsdina")),
              HasSubstr("did you mean 'lsdyna'? (known: lsdyna, radioss, csv, iso-mme)"));
  EXPECT_THAT(refusal(syn_a(), to("iso-mme")), HasSubstr("an ISO-MME test is made of traces"));
  EXPECT_THAT(refusal(syn_a(), to("lsdyna", "mm")), HasSubstr("units = 'mm': unknown system of units"));
  EXPECT_THAT(refusal(syn_a(), to("csv", "t-mm-s")), HasSubstr("a table is in SI"));
  EXPECT_THAT(refusal(syn_a(), to("radioss", "kg-m-s", 0)), HasSubstr("first_id"));
  EXPECT_THAT(refusal(syn_a(), to("radioss", "kg-m-s", 100000000)), HasSubstr("first_id"));
  CrushModel model = syn_a();
  model.spring.ordinates[1] = -1.0;
  EXPECT_THAT(refusal(model, to("lsdyna")), HasSubstr("CrushModel.spring.ordinates[1] = -1: must be >= 0"));
}

}  // namespace
}  // namespace crashsim
