#pragma once
/// What help, schema and documentation say of an option, from its field table.

#include <string>
#include <string_view>
#include <variant>

#include <crashsim/option_values.hpp>

namespace crashsim {

/// One option in words.
struct FieldDescription {
  std::string unit;           ///< SI symbol, "" for none.
  std::string doc;            ///< What it does.
  std::string default_value;  ///< "" when it has none.
  std::string range;          ///< "> 0", ">= 0 and <= 100", "" for any.
  std::string choices;        ///< "l1, l2, huber"; "pre_impact, none, or numbers"; "" when free.
};

/// One key of a file that people write.
struct FileKey {
  std::string section, key;  ///< "pulse", "cfc"; section "" before any table.
  FieldDescription about;
};

/// An option's value as text that reads back as the same value; "" when unset.
std::string text_of(const OptionValue& value);

/// A range in words; "" for any number.
std::string text_of(const Range& range);

/// Describes a field, with the value it has in `defaults`.
template <class S>
FieldDescription describe_field(const Field<S>& field, const S& defaults = {}) {
  FieldDescription out{std::string(field.unit), std::string(field.doc), text_of(get_option(defaults, field)),
                       text_of(field.range), ""};
  const auto list = [&](std::span<const std::string_view> names) {
    for (const std::string_view name : names) out.choices += (out.choices.empty() ? "" : ", ") + std::string(name);
  };
  if (const auto* choice = std::get_if<ChoiceMember<S>>(&field.member)) list(choice->names);
  if (const auto* setting = std::get_if<SettingMember<S>>(&field.member)) {
    list(setting->names.first(setting->names.size() - 1));
    out.choices += ", or numbers";
  }
  return out;
}

}  // namespace crashsim
