#include <crashsim/vertical_io.hpp>

#include <variant>

#include <crashsim/option_values.hpp>

#include "fit_json.hpp"
#include "json.hpp"
#include "record_json.hpp"

namespace crashsim {

std::string format_vertical_law(const VerticalForceLaw& law, const VerticalIdentification* identification,
                                const Record* record) {
  validate(law);
  Json json = Json::object();
  for (const Field<VerticalForceLaw>& field : fields<VerticalForceLaw>)
    if (const OptionValue value = get_option(law, field); !std::holds_alternative<std::monostate>(value))
      json[std::string(field.name)] = json_option(value);
  if (identification != nullptr) {
    Json fit = named_fit_json(*identification);
    fit["error"] = json_number(identification->error);
    fit["samples"] = identification->samples;
    fit["limited_samples"] = identification->limited_samples;
    json["identification"] = std::move(fit);
  }
  if (record != nullptr) json["record"] = record_json(*record);
  return format_json(json);
}

}  // namespace crashsim
