#include "io/nhtsa_compartment.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include <crashsim/units.hpp>

#include "text.hpp"

namespace crashsim::io {
namespace {

using Words = std::span<const std::string_view>;

bool has_any(std::string_view text, Words words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

bool starts_with_any(std::string_view text, Words words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return text.starts_with(word); });
}

constexpr std::string_view kRearFloorCodes[] = {"FLLR", "FLRR", "FLCR", "SLLR", "SLRR"};
constexpr std::string_view kCentreCodes[] = {"VECG", "VHCG", "VCG", "CGVH", "FLTN", "TUNN"};
constexpr std::string_view kFloorCodes[] = {"FL", "SL", "SILL"};
constexpr std::string_view kStructures[] = {"floor", "sill", "crossmember", "cross member", "cross-member", "x-member"};
constexpr std::string_view kCentreWords[] = {"center of gravity", "c.g.", " cg", "cg ", "tunnel"};
constexpr std::string_view kElsewhere[] = {"engine", "brake",     "caliper", "dash",  "panel", "steering", "axle",
                                           "bumper", "radiator",  "wheel",   "door",  "roof",  "pillar",   "strut",
                                           "frame",  "seat back", "barrier", "trunk", "deck"};

/// 1 is the best place, 0 is none in the compartment.
int rank_of_place(const NhtsaChannel& c) {
  const std::string_view code = c.attachment;
  const std::string words = to_lower(c.comment);
  if (starts_with_any(code, kRearFloorCodes)) return 1;
  if (starts_with_any(code, kCentreCodes)) return 2;
  if (starts_with_any(code, kFloorCodes)) return 3;
  if (has_any(words, kElsewhere)) return 0;
  if (has_any(words, kStructures)) return words.find("rear") != std::string::npos ? 1 : 3;
  return has_any(words, kCentreWords) ? 2 : 0;
}

bool measures_longitudinal_acceleration(const NhtsaChannel& c) {
  const auto unit = find_unit(c.y_unit);
  return c.sensor == "AC" && c.axis.starts_with('X') && unit && unit->dimension == Dimension::acceleration;
}

/// Dummies have a seating position ("01"), the vehicle itself has none.
bool is_on_the_vehicle(const NhtsaChannel& c) {
  return c.occupant.empty() || c.occupant == "NA" || c.occupant == "00" || c.occupant == "0";
}

}  // namespace

std::vector<std::size_t> compartment_channels(const NhtsaHeader& header, const std::vector<bool>& usable) {
  const int vehicle = header.vehicles.empty() ? 1 : header.vehicles.front().number;
  std::vector<std::size_t> best;
  std::pair<int, bool> best_rank{4, true};  // place, redundant
  for (std::size_t i = 0; i < header.channels.size(); ++i) {
    const NhtsaChannel& c = header.channels[i];
    if (!usable[i] || c.vehicle != vehicle || !is_on_the_vehicle(c) || !measures_longitudinal_acceleration(c)) continue;
    const std::pair rank{rank_of_place(c), c.channel_status == "R"};
    if (rank.first == 0 || rank > best_rank) continue;
    if (rank < best_rank) best.clear();
    best_rank = rank;
    best.push_back(i);
  }
  return best;
}

}  // namespace crashsim::io
