#pragma once
/// A comparison as tables that can be pasted into a report.

#include <string>
#include <string_view>
#include <vector>

#include <crashsim/comparison.hpp>
#include <crashsim/options.hpp>

namespace crashsim {
namespace cli {

/// How a table is written: for the terminal, for documents, or for spreadsheets (SI units, all digits).
enum class TableFormat { plain, markdown, csv };

}  // namespace cli

inline constexpr std::string_view kTableFormatNames[] = {"plain", "markdown", "csv"};
template <>
inline constexpr std::span<const std::string_view> enum_names<cli::TableFormat>{kTableFormatNames};

namespace cli {

/// Channels with their errors and ratings: range, header, one line a channel, and why a channel has no rating.
std::vector<std::string> table_of(const Comparison& comparison, TableFormat format = TableFormat::plain);

/// Metrics side by side; no lines when there are none.
std::vector<std::string> table_of(const std::vector<MetricComparison>& metrics,
                                  TableFormat format = TableFormat::plain);

}  // namespace cli
}  // namespace crashsim
