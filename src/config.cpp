#include <crashsim/config.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>

namespace crashsim {
namespace {

std::string place(const std::string& path, const toml::source_region& source) {
  return fmt::format("{}:{}", path, source.begin.line);
}

std::string text_of(const toml::node& node, const std::string& what) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (node.is_integer() || node.is_floating_point()) return format_number(node.value_or(kUnset));
  throw InvalidInput(fmt::format("{}: a list must hold numbers or texts", what));
}

OptionValue list_of(const toml::array& array, const std::string& what) {
  const auto is_number = [](const toml::node& node) { return node.is_integer() || node.is_floating_point(); };
  if (!array.empty() && std::all_of(array.begin(), array.end(), is_number)) {
    std::vector<double> numbers;
    for (const toml::node& node : array) numbers.push_back(node.value_or(kUnset));
    return numbers;
  }
  std::vector<std::string> texts;
  for (const toml::node& node : array) texts.push_back(text_of(node, what));
  return texts;
}

OptionValue value_of(const toml::node& node, const std::string& what) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto flag = node.value_exact<bool>()) return *flag;
  if (const auto integer = node.value_exact<std::int64_t>()) return *integer;
  if (const auto number = node.value_exact<double>()) return *number;
  if (const toml::array* array = node.as_array()) return list_of(*array, what);
  throw InvalidInput(fmt::format("{}: must be a number, a text, true or false, or a list of them", what));
}

void collect(const toml::table& table, const std::string& section, const std::string& prefix, const std::string& path,
             std::vector<ConfigEntry>& entries) {
  std::vector<std::pair<std::string, const toml::node*>> nodes;
  for (const auto& [key, node] : table) nodes.emplace_back(std::string(key.str()), &node);
  std::stable_sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) {  // toml++ orders them by name
    const auto &x = a.second->source().begin, &y = b.second->source().begin;
    return std::pair(x.line, x.column) < std::pair(y.line, y.column);
  });
  for (const auto& [key, node] : nodes) {
    const std::string where = place(path, node->source());
    const toml::table* inner = node->as_table();
    if (inner == nullptr) {
      entries.push_back({section, prefix + key, value_of(*node, fmt::format("{}: {}{}", where, prefix, key)), where});
    } else if (section.empty() && !inner->is_inline()) {
      collect(*inner, key, "", path, entries);
    } else {
      collect(*inner, section, prefix + key + ".", path, entries);
    }
  }
}

/// Where the string that begins at `at` ends in TOML, one behind its last quote: "..", '..', or three quotes each.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool is_long = text.substr(at).starts_with(three);
  for (std::size_t i = at + (is_long ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (is_long ? text.substr(i).starts_with(three) : text[i] == quote || text[i] == '\n') {
      return is_long ? std::max(i + 3, std::min(text.find_first_not_of(quote, i), text.size())) : i + 1;
    }
  }
  return text.size();
}

/// Refuses a key of so many parts that its tables in tables would exhaust the stack; the parser itself looks after
/// nested values.
void check_depth(std::string_view text, const std::string& path) {
  constexpr int kMostParts = 100;
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') i = std::min(text.find('\n', i), text.size() - 1);
    if (c == '#' || c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') parts = 1;
    if (c == '.' && ++parts > kMostParts)
      throw InvalidInput(fmt::format("{}:{}: is a key of more than {} parts: no option has as many", path,
                                     1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n'),
                                     kMostParts));
    ++i;
  }
}

}  // namespace

std::vector<ConfigEntry> read_config(const std::string& path) {
  const std::string text = read_file(path);
  check_depth(text, path);
  const toml::parse_result result = toml::parse(text, path);
  if (!result)
    throw InvalidInput(
        fmt::format("{}: is not TOML: {}", place(path, result.error().source()), result.error().description()));
  std::vector<ConfigEntry> entries;
  collect(result.table(), "", "", path, entries);
  return entries;
}

}  // namespace crashsim
