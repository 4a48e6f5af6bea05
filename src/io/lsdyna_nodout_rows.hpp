#pragma once
/// The blocks of an LS-DYNA nodout: a head with the time, a row of column names, and a row of fixed columns a node.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crashsim::io {

/// What every block starts with.
inline constexpr std::string_view kNodoutMark = "n o d a l   p r i n t   o u t";

/// The head of a block.
struct NodoutHead {
  std::size_t time_at = 0;     ///< Where the time stands in the text.
  std::string_view time_text;  ///< "4.8730101E-03".
  std::string_view names;      ///< The row of column names; empty when there is none.
  std::size_t rows = 0;        ///< Where the rows start.
};

/// The head of the block at a mark; empty when the text ends in it.
std::optional<NodoutHead> parse_nodout_head(std::string_view text, std::size_t at);

/// The variables of a row of column names, as binout calls them: "x_displacement" for "x-disp".
std::vector<std::string> nodout_variables(std::string_view names);

/// One row. Its columns end with it and have one width; the node's number fills what is before them.
struct NodoutRow {
  std::size_t at = 0;      ///< Where it starts.
  std::size_t length = 0;  ///< Without blanks at its end.
  std::size_t end = 0;     ///< Where its line ends: the position of the newline.
};

/// The row at a position; empty when there is none or the text ends in it.
std::optional<NodoutRow> parse_nodout_row(std::string_view text, std::size_t at);

/// Width of the columns of a row, by their decimal points. LS-DYNA's is 12.
std::size_t nodout_width(std::string_view row, std::size_t columns);

/// The node of a row by its number; empty when it has none.
std::string_view nodout_node(std::string_view row, std::size_t width, std::size_t columns);

/// Any number that fills a field, but for blanks; NaN for one that overflowed it. False when it is none.
bool scan_nodout_field(std::string_view field, double& value);

/// The same, quick for the format of all versions, E12.5.
inline bool scan_nodout_field(const char* p, std::size_t width, double& value) {
  constexpr std::size_t kWidth = 12;
  constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr int kDecimals = 5, kLargestPower = 22;
  if (width != kWidth) return scan_nodout_field({p, width}, value);
  const auto digit = [p](int i) { return static_cast<unsigned>(p[i] - '0'); };
  const unsigned d1 = digit(1), d3 = digit(3), d4 = digit(4), d5 = digit(5), d6 = digit(6), d7 = digit(7);
  const unsigned e1 = digit(10), e2 = digit(11);
  const bool has_digits = (d1 <= 9) & (d3 <= 9) & (d4 <= 9) & (d5 <= 9) & (d6 <= 9) & (d7 <= 9) & (e1 <= 9) & (e2 <= 9);
  const bool has_marks =
      ((p[0] == ' ') | (p[0] == '-')) & (p[2] == '.') & (p[8] == 'E') & ((p[9] == '-') | (p[9] == '+'));
  const int exponent = static_cast<int>(10 * e1 + e2);
  const int power = (p[9] == '-' ? -exponent : exponent) - kDecimals;
  if (!(has_digits & has_marks) || power < -kLargestPower || power > kLargestPower)
    return scan_nodout_field({p, width}, value);
  // Exact numbers and one operation: correctly rounded.
  const auto mantissa = static_cast<double>(((((d1 * 10 + d3) * 10 + d4) * 10 + d5) * 10 + d6) * 10 + d7);
  const double size = power < 0 ? mantissa / kPowers[-power] : mantissa * kPowers[power];
  value = p[0] == '-' ? -size : size;
  return true;
}

}  // namespace crashsim::io
