#pragma once
/// Decks that were exported, read back by their columns.

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/export.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/units.hpp>

#include "support/random.hpp"
#include "support/source_dir.hpp"

namespace crashsim::test {

inline constexpr double kPrinted = 1e-9;  // rounding: numbers have twelve digits

inline const Record kRecord = {"0.0.0", "export", {"model.json"}, {}, {}};

struct System {
  const char* name;
  double mass_kg, length_m, time_s;
  [[nodiscard]] double force_n() const { return mass_kg * length_m / (time_s * time_s); }
  [[nodiscard]] double speed_mps() const { return length_m / time_s; }
};
inline constexpr System kSystems[] = {
    {"kg-m-s", 1, 1, 1}, {"t-mm-s", 1e3, 1e-3, 1}, {"kg-mm-ms", 1, 1e-3, 1e-3}, {"g-mm-ms", 1e-3, 1e-3, 1e-3}};

/// Fields of a line by their widths.
inline std::vector<std::string> fields_of(const std::string& line, const std::vector<std::size_t>& widths) {
  std::vector<std::string> fields;
  std::size_t at = 0;
  for (const std::size_t width : widths) {
    const std::string field = at < line.size() ? line.substr(at, width) : "";
    const std::size_t first = field.find_first_not_of(' '), last = field.find_last_not_of(' ');
    fields.push_back(first == std::string::npos ? "" : field.substr(first, last - first + 1));
    at += width;
  }
  EXPECT_LE(line.size(), at) << line;
  return fields;
}

inline double number(const std::string& field) {
  const auto value = parse_number(field);
  EXPECT_TRUE(value.has_value()) << "'" << field << "'";
  return value.value_or(std::nan(""));
}

/// Data lines below each keyword, without comments; "*PART" may come twice.
class Deck {
 public:
  Deck(const std::string& text, char comment, char keyword) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with(comment)) continue;
      if (line.starts_with(keyword))
        blocks_.push_back({line, {}});
      else if (!blocks_.empty())
        blocks_.back().second.push_back(line);
      else
        ADD_FAILURE() << "before any keyword: " << line;
    }
  }
  [[nodiscard]] std::vector<std::vector<std::string>> all(const std::string& keyword) const {
    std::vector<std::vector<std::string>> found;
    for (const auto& [name, lines] : blocks_)
      if (name == keyword) found.push_back(lines);
    return found;
  }
  [[nodiscard]] std::vector<std::string> one(const std::string& keyword) const {
    const auto found = all(keyword);
    EXPECT_THAT(found, testing::SizeIs(1)) << keyword;
    return found.empty() ? std::vector<std::string>{"", "", "", ""} : found.front();
  }

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> blocks_;
};

struct Curve {
  std::vector<double> x, y;
  [[nodiscard]] double at(double s) const {
    const auto above = std::clamp(std::upper_bound(x.begin(), x.end(), s), x.begin() + 1, x.end() - 1) - x.begin();
    const auto i = static_cast<std::size_t>(above);
    return y[i - 1] + (y[i] - y[i - 1]) * (s - x[i - 1]) / (x[i] - x[i - 1]);
  }
};

inline Curve curve_of(const std::vector<std::string>& lines, std::size_t first) {
  Curve curve;
  for (std::size_t i = first; i < lines.size(); ++i) {
    const auto fields = fields_of(lines[i], {20, 20});
    curve.x.push_back(number(fields[0]));
    curve.y.push_back(number(fields[1]));
  }
  EXPECT_TRUE(std::is_sorted(curve.x.begin(), curve.x.end(), std::less_equal<>())) << "increasing strictly";
  return curve;
}

/// The curve of LS-DYNA with this number.
inline Curve lsdyna_curve(const Deck& deck, int id) {
  for (const auto& lines : deck.all("*DEFINE_CURVE_TITLE")) {
    const auto fields = fields_of(lines.at(1), {10, 10, 10, 10, 10, 10, 10, 10});
    if (fields[0] == std::to_string(id)) return curve_of(lines, 2);
  }
  ADD_FAILURE() << "no curve " << id;
  return {{0, 1}, {0, 0}};
}

/// Compares a curve of the deck with a force of the model at random places on both sides.
template <class Force>
void expect_force(const Curve& curve, double unit, double force_unit, double reach, const Force& force) {
  Random random(11);
  double peak = 0.0;
  for (int i = 0; i <= 1000; ++i) peak = std::max(peak, std::abs(force(reach * i / 1000.0)));
  for (int i = 0; i < 1000; ++i) {
    const double s = random.between(-reach, reach);
    ASSERT_NEAR(curve.at(s / unit) * force_unit, force(s), kCurveAccuracy * peak) << s;
  }
  EXPECT_NEAR(curve.at(0.0), 0.0, kPrinted * peak / force_unit);
  EXPECT_NEAR(curve.x.front(), -curve.x.back(), kPrinted * curve.x.back()) << "both quadrants";
}

inline CrushModel syn_a() { return read_model(std::string(source_dir()) + "/data/syn-a/model.json"); }

inline double reach_of(const PiecewiseLinear& law) { return 1.5 * (law.knots.size() == 1 ? 1.0 : law.knots.back()); }

inline ExportOptions to(const std::string& target, const std::string& units = "kg-m-s", int id = 1) {
  return {.to = target, .units = units, .first_id = id};
}

}  // namespace crashsim::test
