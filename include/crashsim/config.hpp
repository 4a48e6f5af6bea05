#pragma once
/// Files that give options: TOML written by people, JSON written as a record.

#include <string>
#include <string_view>
#include <vector>

#include <crashsim/option_values.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// One `key = value` of such a file.
struct ConfigEntry {
  std::string section;  ///< Table it stands in: "pulse"; "" at the top.
  std::string key;      ///< "cfc"; keys of inline tables are joined: "force.file".
  OptionValue value;
  std::string where;  ///< For messages: "case.toml:12".
};

/// Entries of a TOML file in its order. @throws InvalidInput with path, line and reason when it cannot be read, is not
/// TOML, or holds a value that is no option (a date, a list of lists).
std::vector<ConfigEntry> read_config(const std::string& path);

/// Sets the option that `entry.key` names by its table's flag or name. @throws InvalidInput naming place, key, value
/// and rule, or the nearest known key.
template <class S>
void set_from(S& options, const ConfigEntry& entry) {
  const std::string what = entry.where + ": " + entry.key;
  set_option(options, find_field<S>(entry.key, what), entry.value, what);
}

/// Every option of a struct as entries of `section`.
template <class S>
std::vector<ConfigEntry> entries_of(const S& options, std::string_view section) {
  std::vector<ConfigEntry> entries;
  for (const Field<S>& field : fields<S>)
    entries.push_back({std::string(section), std::string(field.flag), get_option(options, field), ""});
  return entries;
}

}  // namespace crashsim
