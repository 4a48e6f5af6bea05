#include "uncertainty_json.hpp"

#include <cmath>

#include <fmt/format.h>

namespace crashsim {
namespace {

using Eigen::Index;

constexpr int kReplicateDigits = 9;  // of 17: replicates only scatter

struct TestKey {
  std::string_view key;
  double TestReport::*member;
};
constexpr TestKey kTestKeys[] = {{"impact_speed_mps", &TestReport::impact_speed_mps},
                                 {"mass_kg", &TestReport::mass_kg},
                                 {"max_crush_m", &TestReport::max_crush_m},
                                 {"t_m_s", &TestReport::t_m_s}};

/// What a fit varies: a row each replicate.
struct ReplicateRows {
  std::string_view key;
  RowMatrix CrushModels::*rows;
  std::size_t (*columns)(const CrushModel& model);
};
constexpr ReplicateRows kReplicateRows[] = {
    {"spring_ordinates", &CrushModels::spring_ordinates,
     [](const CrushModel& model) { return model.spring.knots.size(); }},
    {"damper_ordinates", &CrushModels::damper_ordinates,
     [](const CrushModel& model) { return model.damper.knots.size(); }},
    {"spring_knots", &CrushModels::spring_knots, [](const CrushModel& model) { return model.spring.knots.size(); }},
    {"damper_knots", &CrushModels::damper_knots, [](const CrushModel& model) { return model.damper.knots.size(); }},
};

constexpr std::string_view kRateCoefficient = "rate_coefficient";  // of law `rate`: a number each

double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  return std::stod(fmt::format("{:.{}g}", value, kReplicateDigits));
}

Json rows_json(const RowMatrix& rows) {
  Json list = Json::array();
  for (Index i = 0; i < rows.rows(); ++i) {
    Json row = Json::array();
    for (Index j = 0; j < rows.cols(); ++j) row.push_back(rounded(rows(i, j)));
    list.push_back(std::move(row));
  }
  return list;
}

Json replicates_json(const CrushModels& replicates) {
  Json json = Json::object();
  for (const ReplicateRows& array : kReplicateRows)
    if ((replicates.*array.rows).rows() > 0) json[std::string(array.key)] = rows_json(replicates.*array.rows);
  for (const double r : replicates.rate_coefficient) json[std::string(kRateCoefficient)].push_back(rounded(r));
  return json;
}

Json ordinate_json(const OrdinateUncertainty& ordinate) {
  Json json = {{"name", ordinate.name},
               {"state", name_of(ordinate.state)},
               {"standard_error", json_number(ordinate.standard_error)},
               {"low", json_number(ordinate.low)},
               {"high", json_number(ordinate.high)}};
  if (ordinate.profile_at.empty()) return json;
  json["profile_low"] = json_number(ordinate.profile_low);
  json["profile_high"] = json_number(ordinate.profile_high);
  json["profile_open"] = {{"low", ordinate.profile_low_open}, {"high", ordinate.profile_high_open}};
  return json;
}

Json spectrum_json(const std::vector<FisherDirection>& spectrum) {
  Json list = Json::array();
  for (const FisherDirection& direction : spectrum)
    list.push_back({{"singular_value", json_number(direction.singular_value)},
                    {"relative_error", json_number(direction.relative_error)},
                    {"words", direction.words}});
  return list;
}

const Json& list_in(const JsonObject& object, std::string_view key) {
  const Json& list = object.get(key);
  if (!list.is_array()) throw InvalidInput(fmt::format("{}: must be a list [..]", object.name(key)));
  return list;
}

std::vector<TestReport> read_tests(const JsonObject& identification) {
  std::vector<TestReport> tests;
  for (const Json& item : list_in(identification, "tests")) {
    const JsonObject object(item, fmt::format("{}[{}]", identification.name("tests"), tests.size()));
    TestReport& test = tests.emplace_back();
    for (const TestKey& number : kTestKeys)
      if (object.has(number.key)) test.*number.member = object.number(number.key);
    if (!(test.impact_speed_mps > 0.0))
      throw InvalidInput(
          fmt::format("{} = {} m/s: must be > 0", object.name("impact_speed_mps"), test.impact_speed_mps));
  }
  return tests;
}

RowMatrix read_rows(const JsonObject& object, std::string_view key, std::size_t columns) {
  const Json& list = list_in(object, key);
  RowMatrix rows(static_cast<Index>(list.size()), static_cast<Index>(columns));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string what = fmt::format("{}[{}]", object.name(key), i);
    const std::vector<double> row = detail::to_numbers(option_from_json(list[i], what), "", what);
    if (row.size() != columns)
      throw InvalidInput(fmt::format("{}: has {} numbers: the model's curve has {} knots", what, row.size(), columns));
    std::copy(row.begin(), row.end(), rows.row(static_cast<Index>(i)).begin());
  }
  return rows;
}

CrushModels read_replicates(const JsonObject& object, const CrushModel& model) {
  CrushModels replicates;
  replicates.common = model;
  std::vector<std::string_view> known;
  for (const ReplicateRows& array : kReplicateRows) {
    known.push_back(array.key);
    if (object.has(array.key)) replicates.*array.rows = read_rows(object, array.key, array.columns(model));
  }
  known.push_back(kRateCoefficient);
  if (object.has(kRateCoefficient)) replicates.rate_coefficient = object.numbers(kRateCoefficient);
  object.allow_only(known);
  static_cast<void>(replicates.count());  // throws when the arrays' lengths differ
  return replicates;
}

Verdict read_verdict(const JsonObject& identification) {
  Verdict verdict;
  if (!identification.has("verdict")) return verdict;
  const JsonObject object(identification.get("verdict"), identification.name("verdict"));
  if (object.has("identifiable"))
    verdict.identifiable = detail::to_bool(object.option("identifiable"), object.name("identifiable"));
  if (object.has("message")) verdict.message = detail::to_text(object.option("message"), object.name("message"));
  return verdict;
}

}  // namespace

// Wall time is left out: a record run again gives the same bytes.
Json uncertainty_json(const Uncertainty& uncertainty) {
  Json ordinates = Json::array();
  for (const OrdinateUncertainty& ordinate : uncertainty.ordinates) ordinates.push_back(ordinate_json(ordinate));
  return {{"outcome", name_of(uncertainty.outcome)},
          {"message", uncertainty.message},
          {"level", uncertainty.level},
          {"kind", name_of(uncertainty.resample)},
          {"noise_mps2", json_numbers(uncertainty.noise_mps2)},
          {"correlation_time_s", json_numbers(uncertainty.correlation_time_s)},
          {"ordinates", ordinates},
          {"spectrum", spectrum_json(uncertainty.spectrum)},
          {"combinations", uncertainty.combinations},
          {"failed_replicates", uncertainty.failed_replicates},
          {"replicates", replicates_json(uncertainty.replicates)}};
}

void read_basis(const JsonObject& file, PredictionBasis& basis) {
  if (file.has("identification")) {
    const JsonObject identification(file.get("identification"), file.name("identification"));
    if (identification.has("tests")) basis.tests = read_tests(identification);
    basis.verdict = read_verdict(identification);
  }
  if (!file.has("uncertainty")) return;
  const JsonObject object(file.get("uncertainty"), file.name("uncertainty"));
  if (object.has("level")) basis.level = object.number("level");
  if (!(basis.level > 0.0 && basis.level < 1.0))
    throw InvalidInput(fmt::format("{} = {}: must be > 0 and < 1", object.name("level"), basis.level));
  if (object.has("replicates"))
    basis.replicates = read_replicates(JsonObject(object.get("replicates"), object.name("replicates")), basis.model);
}

}  // namespace crashsim
