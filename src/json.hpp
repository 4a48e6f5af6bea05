#pragma once
/// JSON as crashsim writes and reads it. NaN and infinity, which JSON does not know, are null.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <crashsim/options.hpp>

namespace crashsim {

using Json = nlohmann::ordered_json;

/// A number, or null when it is not finite.
Json json_number(double value);

/// A list of such numbers.
Json json_numbers(const std::vector<double>& values);

Json json_option(const OptionValue& value);

/// @throws InvalidInput naming `what` when the value is no option.
OptionValue option_from_json(const Json& value, std::string_view what);

/// Text with an indent of two; lists of plain values stay on one line. Ends with a newline.
std::string format_json(const Json& value);

/// Text on one line, without a newline.
std::string format_json_line(const Json& value);

/// Parses a file's text. @throws InvalidInput with path, line and reason.
Json parse_json(std::string_view text, const std::string& path);

}  // namespace crashsim
