#pragma once
/// What the identifications of named numbers share on the command line.

#include <string>
#include <vector>

#include <fmt/format.h>

#include <crashsim/identify.hpp>
#include <crashsim/option_values.hpp>
#include <crashsim/summary.hpp>

namespace crashsim::cli {

/// Takes `--free a,b` for `--free a --free b`: names hold no comma.
template <class Options>
void split_free(Options& options) {
  const std::string all = fmt::format("{}", fmt::join(options.free, ","));
  set_option(options, find_field<Options>("free", "--free"), all, "--free");
}

/// A summary without the numbers identified, which the table shows.
Summary without_numbers(Summary summary, const std::vector<ParameterReport>& parameters);

/// A heading, and a line for each number.
std::vector<std::string> table_of(const std::vector<ParameterReport>& parameters);

}  // namespace crashsim::cli
