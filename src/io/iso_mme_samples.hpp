#pragma once
/// Samples of an ISO-MME channel file: one value a line after the header; and the times that its header means.

#include <string>
#include <string_view>
#include <vector>

#include "io/iso_mme_header.hpp"

namespace crashsim::io {

struct IsoMmeSamples {
  std::vector<double> values;  ///< In the file's unit; NaN for NOVALUE.
  std::string problem;         ///< Why they must not be used: truncated, or no numbers.
  std::string warning;         ///< What a careful reader should know.
};

/// A last line without end counts as a number only where it is known to be whole, for it may have been cut short.
IsoMmeSamples parse_iso_mme_samples(std::string_view text, const IsoMmeHeader& header, const std::string& path);

/// Times first + i interval [s]; where both are multiples of a whole rate's interval, as i / rate, which is what their
/// decimals say.
std::vector<double> iso_mme_times(double first_s, double interval_s, std::size_t count);

}  // namespace crashsim::io
