#include "io/iso_mme_code.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <utility>

#include "text.hpp"

namespace crashsim::io {
namespace {

/// Positions in a code.
constexpr std::size_t kObject = 0, kMainLocation = 2, kFineLocation = 6, kDimension = 12, kDirection = 14, kFilter = 15;

struct Letters {
  std::string_view letters;
  Dimension dimension;
};
/// The first of a dimension is the one to write.
constexpr Letters kLetters[] = {{"TI", Dimension::time},         {"AC", Dimension::acceleration},
                                {"VE", Dimension::speed},        {"VA", Dimension::speed},
                                {"VD", Dimension::speed},        {"DS", Dimension::length},
                                {"DC", Dimension::length},       {"DV", Dimension::length},
                                {"LE", Dimension::length},       {"FO", Dimension::force},
                                {"MO", Dimension::moment},       {"AN", Dimension::angle},
                                {"AV", Dimension::angular_rate}, {"AA", Dimension::angular_acceleration},
                                {"EN", Dimension::energy},       {"IM", Dimension::impulse},
                                {"MA", Dimension::mass},         {"FR", Dimension::frequency},
                                {"00", Dimension::none},         {"EV", Dimension::none},
                                {"QU", Dimension::none},         {"ST", Dimension::none},
                                {"HU", Dimension::none}};

struct FilterClass {
  char letter;
  std::string_view text;
  double cfc;
};
/// Letters that stand for a filter. Those of older editions of the standards follow the current ones.
constexpr FilterClass kFilters[] = {{'A', "CFC 1000", 1000}, {'B', "CFC 600", 600},    {'C', "CFC 180", 180},
                                    {'D', "CFC 60", 60},     {'E', "CFC 1000", 0},     {'F', "CFC 600", 0},
                                    {'G', "CFC 180", 0},     {'H', "CFC 60", 0},       {'L', "CFC 20", 20},
                                    {'1', "FIR 100", 0},     {'Q', "below CFC 60", 0}, {'S', "a special filter", 0}};

constexpr std::string_view kStructures[] = {"SEAT", "SECM", "SERM", "SETR", "SILB", "SILL", "CRME", "FLOR", "FLOO"};
constexpr std::string_view kCentres[] = {"VEHC", "TUNN", "CEUN"};

bool is_any(std::string_view text, std::span<const std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

bool has_fine_location(std::string_view code, std::string_view fine) {
  for (std::size_t at = kFineLocation; at < kDimension; at += 2)
    if (code.substr(at, 2) == fine) return true;
  return false;
}

/// 1 is the best place, 0 is none in the compartment.
int rank_of_place(std::string_view code) {
  const std::string_view main = code.substr(kMainLocation, 4);
  if (is_any(main, kStructures)) return has_fine_location(code, "RE") ? 1 : 3;
  if (is_any(main, kCentres)) return has_fine_location(code, "FR") ? 0 : 2;
  if (main == "BPIL") return has_fine_location(code, "UP") ? 0 : 3;
  return main == "SLED" ? 2 : 0;
}

/// Vehicles in the order of their numbers, then a sled; 0 for barriers, dummies, pendulums and the like.
int rank_of_object(char object) {
  if (object >= '1' && object <= '9') return object - '0';
  return object == 'S' ? 10 : 0;
}

}  // namespace

bool is_iso_mme_code(std::string_view text) {
  return text.size() == kIsoMmeCodeLength && std::all_of(text.begin(), text.end(), [](char c) {
           return is_digit(c) || (lower(c) >= 'a' && lower(c) <= 'z') || c == '?';
         });
}

Dimension iso_mme_dimension(std::string_view code) {
  if (!is_iso_mme_code(code)) return Dimension::unknown;
  for (const Letters& known : kLetters)
    if (code.substr(kDimension, 2) == known.letters) return known.dimension;
  return Dimension::unknown;
}

std::string_view iso_mme_letters(Dimension dimension) {
  for (const Letters& known : kLetters)
    if (known.dimension == dimension) return known.letters;
  return "";
}

char iso_mme_axis(std::string_view code) {
  constexpr std::pair<char, char> kDirections[] = {{'X', 'X'}, {'Y', 'Y'}, {'Z', 'Z'},
                                                   {'1', 'X'}, {'2', 'Y'}, {'3', 'Z'}};
  if (!is_iso_mme_code(code)) return ' ';
  for (const auto& [direction, axis] : kDirections)
    if (code[kDirection] == direction) return axis;
  return ' ';
}

std::string iso_mme_location(std::string_view code) {
  if (!is_iso_mme_code(code)) return "";
  std::size_t end = kDimension;
  while (end > kFineLocation && (code.substr(end - 2, 2) == "00" || code.substr(end - 2, 2) == "??")) end -= 2;
  return std::string(code.substr(kMainLocation, end - kMainLocation));
}

std::string_view iso_mme_filter(std::string_view code) {
  if (!is_iso_mme_code(code)) return "";
  for (const FilterClass& known : kFilters)
    if (code[kFilter] == known.letter) return known.text;
  return "";
}

char iso_mme_filter_class(double cfc) {
  if (cfc == 0.0) return '0';
  for (const FilterClass& known : kFilters)
    if (known.cfc == cfc) return known.letter;
  return 'S';
}

std::vector<std::size_t> iso_mme_compartment(const TraceSet& set, const std::vector<bool>& usable) {
  using Rank = std::tuple<int, int, bool, bool>;  // object, place, filtered, redundant
  std::vector<std::size_t> best;
  Rank best_rank{11, 0, false, false};
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    const Trace& trace = set.traces[i];
    const std::string_view code = std::string_view(trace.id).substr(0, kIsoMmeCodeLength);
    const bool accelerates = iso_mme_dimension(code) == Dimension::acceleration && iso_mme_axis(code) == 'X' &&
                             trace.dimension == Dimension::acceleration && trace.axis == 'X';
    if (!usable[i] || !accelerates) continue;
    const Rank rank{rank_of_object(code[kObject]), rank_of_place(code), !iso_mme_filter(code).empty(),
                    has_fine_location(code, "RD")};
    if (std::get<0>(rank) == 0 || std::get<1>(rank) == 0 || rank > best_rank) continue;
    if (rank < best_rank) best.clear();
    best_rank = rank;
    best.push_back(i);
  }
  return best;
}

}  // namespace crashsim::io
