#include "fit_json.hpp"

namespace crashsim {

Json parameters_json(const std::vector<ParameterReport>& parameters) {
  Json list = Json::array();
  for (const ParameterReport& parameter : parameters)
    list.push_back({{"name", parameter.name},
                    {"unit", parameter.unit},
                    {"value", json_number(parameter.value)},
                    {"standard_error", json_number(parameter.standard_error)},
                    {"lower_bound", json_number(parameter.lower_bound)},
                    {"upper_bound", json_number(parameter.upper_bound)},
                    {"at_bound", parameter.at_bound},
                    {"untouched", parameter.untouched}});
  return list;
}

Json correlation_json(const std::vector<std::vector<double>>& correlation) {
  Json rows = Json::array();
  for (const std::vector<double>& row : correlation) rows.push_back(json_numbers(row));
  return rows;
}

Json start_errors_json(const std::vector<StartReport>& starts) {
  Json errors = Json::array();
  for (const StartReport& start : starts) errors.push_back(json_number(start.error));
  return errors;
}

}  // namespace crashsim
