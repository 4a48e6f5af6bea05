#pragma once
/// Command-line options made from field tables.

#include <algorithm>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include <crashsim/config.hpp>
#include <crashsim/option_docs.hpp>

namespace crashsim::cli {

/// The flags of an options struct on a subcommand: `--speed 56km/h` sets the field of that flag.
template <class S>
class Flags {
 public:
  /// @param only flags that this subcommand offers; empty: all.
  void add_to(CLI::App& app, const std::string& group, std::initializer_list<std::string_view> only = {}) {
    for (const Field<S>& field : fields<S>) {
      if (only.size() > 0 && std::find(only.begin(), only.end(), field.flag) == only.end()) continue;
      offered_.push_back(&field);
      CLI::Option* option = nullptr;
      const std::string flag = "--" + std::string(field.flag);
      const bool is_list = std::holds_alternative<std::vector<std::string> S::*>(field.member);
      if (std::holds_alternative<bool S::*>(field.member)) {
        const std::string description = described(field);
        option = app.add_flag(flag, description)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
      } else {
        option = app.add_option(flag, given_[&field], described(field));
        option->expected(1)->allow_extra_args(false)->type_name(value_name(field));  // files follow, not more values
        option->multi_option_policy(is_list ? CLI::MultiOptionPolicy::TakeAll : CLI::MultiOptionPolicy::TakeLast);
      }
      option->group(group);
      options_[&field] = option;
    }
  }

  /// Sets what a configuration gives; false when the key is none of this struct's.
  bool set_from_config(S& values, const ConfigEntry& entry) const {
    for (const Field<S>* field : offered_) {
      if (!is_key_of(entry.key, *field)) continue;
      set_from(values, entry);
      return true;
    }
    return false;
  }

  /// Sets what the command line gives.
  void set_from_command_line(S& values) const {
    for (const auto& [field, option] : options_) {
      if (option->count() == 0) continue;
      const std::string what = "--" + std::string(field->flag);
      const auto given = given_.find(field);
      if (given == given_.end())
        set_option(values, *field, option->template as<bool>(), what);  // --flag, --flag=false
      else if (std::holds_alternative<std::vector<std::string> S::*>(field->member))
        set_option(values, *field, given->second, what);
      else
        set_option(values, *field, given->second.back(), what);
    }
  }

  /// Flags offered, for suggestions.
  [[nodiscard]] std::vector<std::string_view> names() const {
    std::vector<std::string_view> names;
    names.reserve(offered_.size());
    for (const Field<S>* field : offered_) names.push_back(field->flag);
    return names;
  }

 private:
  static std::string described(const Field<S>& field) {
    const FieldDescription note = describe_field(field);
    std::string text(field.doc);
    if (!note.choices.empty()) text += " {" + note.choices + "}";
    const bool is_flag = std::holds_alternative<bool S::*>(field.member);
    if (!note.default_value.empty() && !is_flag) text += " [" + note.default_value + "]";
    return text;
  }
  static std::string value_name(const Field<S>& field) {
    if (!field.unit.empty()) return std::string(field.unit);
    if (std::holds_alternative<int S::*>(field.member) || std::holds_alternative<std::uint64_t S::*>(field.member))
      return "N";
    return std::holds_alternative<double S::*>(field.member) ? "X" : "TEXT";
  }

  std::vector<const Field<S>*> offered_;
  std::map<const Field<S>*, CLI::Option*> options_;
  std::map<const Field<S>*, std::vector<std::string>> given_;
};

}  // namespace crashsim::cli
