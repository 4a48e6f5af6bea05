/// Files of a selection.

#include <cmath>

#include <fmt/format.h>

#include <crashsim/select_model.hpp>
#include <crashsim/units.hpp>

#include "record_json.hpp"

namespace crashsim {
namespace {

/// Empty where a number does not exist; `inf` where t_m is not reached.
std::string cell(double value) { return std::isnan(value) ? "" : format_number(value); }

/// null where a number does not exist, "inf" where it is infinite.
Json number(double value) { return std::isinf(value) ? Json("inf") : json_number(value); }

Json test_json(const LeftOutTest& test) {
  return {{"impact_speed_mps", number(test.impact_speed_mps)},
          {"predicted", test.predicted},
          {"error", number(test.error)},
          {"max_crush_m", number(test.max_crush_m)},
          {"t_m_s", number(test.t_m_s)},
          {"max_crush_error", number(test.max_crush_error)},
          {"t_m_error", number(test.t_m_error)}};
}

Json row_json(const SelectionRow& row) {
  Json json = {{"name", row.name},
               {"law", std::string(name_of(row.law))},
               {"spring_knots", row.spring_knots},
               {"damper_knots", row.damper_knots},
               {"knots", std::string(name_of(row.placement))},
               {"curve", std::string(name_of(row.curve))},
               {"outcome", std::string(name_of(row.outcome))},
               {"message", row.message},
               {"recommended", row.recommended},
               {"as_good_as_best", row.as_good_as_best},
               {"parameters", row.parameters},
               {"identifiable", row.identifiable},
               {"error", number(row.error.total)},
               {"error_accel", number(row.error.accel)},
               {"error_velocity", number(row.error.velocity)},
               {"error_displacement", number(row.error.displacement)},
               {"failures", row.failures}};
  for (const auto& field : kSelectionNumbers) json[std::string(field.name)] = number(row.*field.member);
  Json tests = Json::array();
  for (const LeftOutTest& test : row.left_out) tests.push_back(test_json(test));
  json["left_out"] = std::move(tests);
  return json;
}

std::string row_csv(const SelectionRow& row) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", name_of(row.law), row.spring_knots, row.damper_knots,
                  name_of(row.placement), name_of(row.curve), name_of(row.outcome), row.recommended ? 1 : 0,
                  row.as_good_as_best ? 1 : 0, row.parameters, row.identifiable ? 1 : 0, cell(row.error.total),
                  cell(row.error.accel), cell(row.error.velocity), cell(row.error.displacement), row.failures);
  for (const auto& field : kSelectionNumbers) line += "," + cell(row.*field.member);
  for (const LeftOutTest& test : row.left_out)
    line += fmt::format(",{},{},{},{}", cell(test.impact_speed_mps), cell(test.error), cell(test.max_crush_error),
                        cell(test.t_m_error));
  return line + "\n";
}

}  // namespace

std::string format_selection_csv(const Selection& selection, const Record& record) {
  std::string text =
      fmt::format("# crashsim = {}\n# record = {}\n# outcome = {}\n# observations = {}\n", record.version,
                  to_json(record), name_of(selection.outcome), cell(selection.observations));
  text += fmt::format("# recommendation = {}\n",
                      selection.usable() ? selection.recommendation : "none: " + selection.message);
  text +=
      "law,spring_knots,damper_knots,knots,curve,outcome,recommended,as_good_as_best,parameters,identifiable,error,"
      "error_accel,error_velocity,error_displacement,failures";
  for (const auto& field : kSelectionNumbers) text += fmt::format(",{}", field.name);
  const std::size_t tests = selection.rows.empty() ? 0 : selection.rows.front().left_out.size();
  for (std::size_t i = 1; i <= tests; ++i)
    text += fmt::format(",test{0}_speed_mps,test{0}_error,test{0}_max_crush_error,test{0}_t_m_error", i);
  text += "\n";
  for (const SelectionRow& row : selection.rows) text += row_csv(row);
  return text;
}

std::string format_selection_json(const Selection& selection, const Record& record) {
  Json rows = Json::array();
  for (const SelectionRow& row : selection.rows) rows.push_back(row_json(row));
  return format_json({{"outcome", std::string(name_of(selection.outcome))},
                      {"message", selection.message},
                      {"recommendation", selection.recommendation},
                      {"tests", selection.tests},
                      {"observations", number(selection.observations)},
                      {"rows", std::move(rows)},
                      {"record", record_json(record)}});
}

}  // namespace crashsim
