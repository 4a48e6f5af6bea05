#include "json.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

/// Text that is not UTF-8 (a Latin-1 file name or comment) must not make an output fail.
std::string plain_text(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

void write(const Json& value, std::size_t indent, std::string& out) {
  const auto is_plain = [](const Json& item) { return item.is_primitive(); };
  if (!value.is_structured() || value.empty() ||
      (value.is_array() && std::all_of(value.begin(), value.end(), is_plain))) {
    if (!value.is_array()) {
      out += plain_text(value);
      return;
    }
    for (std::size_t i = 0; i < value.size(); ++i) out += (i == 0 ? "[" : ", ") + plain_text(value[i]);
    out += value.empty() ? "[]" : "]";
    return;
  }
  const std::string blanks(indent + 2, ' ');
  std::string separator = value.is_object() ? "{" : "[";
  for (const auto& [key, item] : value.items()) {
    out += separator + "\n" + blanks;
    if (value.is_object()) out += plain_text(Json(key)) + ": ";
    write(item, indent + 2, out);
    separator = ",";
  }
  out += "\n" + std::string(indent, ' ') + (value.is_object() ? "}" : "]");
}

/// What went wrong, without the library's own code in brackets.
std::string reason_of(const Json::exception& error) {
  const std::string text = error.what();
  return text.substr(std::min(text.find("] ") + 2, text.size()));
}

/// Refuses nesting that would exhaust the stack of who walks through the value.
void check_depth(std::string_view text, const std::string& path) {
  constexpr int kDeepest = 100;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest)
        throw InvalidInput(
            fmt::format("{}: is nested more than {} levels deep: no file of crashsim is", path, kDeepest));
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

std::vector<double> numbers_of(const Json& list, std::string_view what) {
  std::vector<double> numbers;
  for (const Json& item : list) {
    if (!item.is_number()) throw InvalidInput(fmt::format("{}: a list must hold numbers or texts", what));
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

}  // namespace

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_number(value));
  return list;
}

Json json_option(const OptionValue& value) {
  return std::visit(
      [](const auto& held) -> Json {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::monostate>)
          return nullptr;
        else if constexpr (std::is_same_v<T, double>)
          return json_number(held);
        else
          return held;
      },
      value);
}

OptionValue option_from_json(const Json& value, std::string_view what) {
  if (value.is_null()) return std::monostate{};
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) throw InvalidInput(fmt::format("{}: must be a number, a text, or a list of them", what));
  const auto is_text = [](const Json& item) { return item.is_string(); };
  if (std::all_of(value.begin(), value.end(), is_text)) return value.get<std::vector<std::string>>();
  return numbers_of(value, what);
}

std::string format_json_line(const Json& value) { return plain_text(value); }

std::string format_json(const Json& value) {
  std::string text;
  write(value, 0, text);
  return text + "\n";
}

Json parse_json(std::string_view text, const std::string& path) {
  check_depth(text, path);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InvalidInput(fmt::format("{}:{}: is not JSON: {}", path, line, reason_of(error)));
  } catch (const Json::exception& error) {  // a number beyond what a double holds
    throw InvalidInput(fmt::format("{}: is not JSON: {}", path, reason_of(error)));
  }
}

}  // namespace crashsim
