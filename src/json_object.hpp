#pragma once
/// Reading the objects of a JSON file with messages that say where.

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>

#include "json.hpp"

namespace crashsim {

/// One JSON object of a file.
class JsonObject {
 public:
  JsonObject(const Json& json, std::string what) : json_(json), what_(std::move(what)) {
    if (!json.is_object()) throw InvalidInput(fmt::format("{}: must be a JSON object {{..}}", what_));
  }

  void allow_only(std::vector<std::string_view> known) const {
    for (const auto& [key, value] : json_.items())
      if (std::find(known.begin(), known.end(), key) == known.end()) detail::throw_unknown_name(what_, key, known);
  }
  [[nodiscard]] bool has(std::string_view key) const { return json_.contains(key) && !json_[key].is_null(); }
  [[nodiscard]] const Json& get(std::string_view key) const {
    if (!has(key)) throw InvalidInput(fmt::format("{}: has no '{}'", what_, key));
    return json_[key];
  }
  [[nodiscard]] OptionValue option(std::string_view key) const { return option_from_json(get(key), name(key)); }
  [[nodiscard]] double number(std::string_view key) const { return detail::to_number(option(key), "", name(key)); }
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const {
    return detail::to_numbers(option(key), "", name(key));
  }
  template <class E>
  void read_choice(std::string_view key, E& value) const {
    if (has(key)) value = static_cast<E>(detail::to_choice(option(key), enum_names<E>, enum_aliases<E>, name(key)));
  }
  [[nodiscard]] std::string name(std::string_view key) const { return fmt::format("{}: {}", what_, key); }

 private:
  const Json& json_;
  std::string what_;
};

}  // namespace crashsim
