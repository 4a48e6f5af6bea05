#include "select_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/option_values.hpp>

namespace crashsim {
namespace {

constexpr double kMostKnots = 100.0;

/// Values of an enum by their names. @throws InvalidInput naming those that exist.
template <class E>
std::vector<E> values_of(const std::vector<std::string>& names, const char* field) {
  if (names.empty())
    throw InvalidInput(
        fmt::format("SelectOptions.{}: none given: name at least one of {}", field, fmt::join(enum_names<E>, ", ")));
  std::vector<E> values;
  for (const std::string& name : names)
    values.push_back(static_cast<E>(
        detail::to_choice(name, enum_names<E>, enum_aliases<E>, fmt::format("SelectOptions.{}", field))));
  return values;
}

std::vector<int> counts_of(const std::vector<double>& numbers, const char* field) {
  if (numbers.empty()) throw InvalidInput(fmt::format("SelectOptions.{}: none given: give numbers of knots", field));
  std::vector<int> counts;
  for (const double number : numbers) {
    if (!(number >= 0.0 && number <= kMostKnots && number == std::floor(number)))
      throw InvalidInput(
          fmt::format("SelectOptions.{} = {}: must be whole numbers of 0..{}", field, number, kMostKnots));
    counts.push_back(static_cast<int>(number));
  }
  return counts;
}

/// The same model under the name of the simplest law that says it; false when it is none.
bool simplify(SelectionRow& row) {
  if (row.law == CrushLaw::rate) row.damper_knots = 0;
  if (row.law == CrushLaw::crush_damping && row.damper_knots < 2) row.law = CrushLaw::force;  // one constant
  if (row.law == CrushLaw::force && row.spring_knots == 0) row.law = CrushLaw::stiffness;
  if (std::max(row.spring_knots, row.damper_knots) < 3) {  // nothing to place, nothing to bend
    row.placement = KnotPlacement::uniform;
    row.curve = Curve::linear;
  }
  return row.spring_knots > 0 || (row.damper_knots > 0 && row.law != CrushLaw::rate);
}

bool is_same(const SelectionRow& a, const SelectionRow& b) {
  return a.law == b.law && a.spring_knots == b.spring_knots && a.damper_knots == b.damper_knots &&
         a.placement == b.placement && a.curve == b.curve;
}

std::string name_of_candidate(const SelectionRow& row) {
  std::string name = fmt::format("{} {}+{}", name_of(row.law), row.spring_knots, row.damper_knots);
  if (row.placement != KnotPlacement::uniform) name += fmt::format(" {}", name_of(row.placement));
  if (row.curve != Curve::linear) name += fmt::format(" {}", name_of(row.curve));
  return name;
}

void add(SelectionRow row, std::vector<SelectionRow>& rows) {
  if (!simplify(row)) return;
  if (std::any_of(rows.begin(), rows.end(), [&row](const SelectionRow& known) { return is_same(known, row); })) return;
  row.name = name_of_candidate(row);
  rows.push_back(std::move(row));
}

}  // namespace

std::vector<SelectionRow> candidates_of(const SelectOptions& options) {
  const auto laws = values_of<CrushLaw>(options.laws, "laws");
  const auto placements = values_of<KnotPlacement>(options.placements, "placements");
  const auto curves = values_of<Curve>(options.curves, "curves");
  const std::vector<int> springs = counts_of(options.spring_knots, "spring_knots");
  const std::vector<int> dampers = counts_of(options.damper_knots, "damper_knots");
  if (std::find(placements.begin(), placements.end(), KnotPlacement::given) != placements.end())
    throw InvalidInput(
        "SelectOptions.placements = given: numbers of knots are compared: use uniform, quantile or free");
  std::vector<SelectionRow> rows;
  for (const CrushLaw law : laws)
    for (const int spring : springs)
      for (const int damper : dampers)
        for (const KnotPlacement placement : placements)
          for (const Curve curve : curves) {
            SelectionRow row;
            row.law = law;
            row.spring_knots = spring;
            row.damper_knots = damper;
            row.placement = placement;
            row.curve = curve;
            add(std::move(row), rows);
          }
  if (rows.empty())
    throw InvalidInput(
        "SelectOptions.spring_knots and damper_knots: no candidate has a force: give a number of knots above 0");
  return rows;
}

IdentifyOptions identify_options_of(const SelectionRow& candidate, const SelectOptions& options) {
  IdentifyOptions how;
  how.law = candidate.law;
  how.spring_knots = candidate.spring_knots;
  how.damper_knots = candidate.damper_knots;
  how.knots = {candidate.placement, {}};
  how.curve = candidate.curve;
  how.mass_kg = options.mass_kg;
  how.starts = options.starts;
  how.seed = options.seed;
  how.loss = options.loss;
  how.weights = options.weights;
  how.method = options.method;
  how.smooth = options.smooth;
  how.reference_speed_mps = options.reference_speed_mps;
  how.jobs = 1;
  return how;
}

}  // namespace crashsim
