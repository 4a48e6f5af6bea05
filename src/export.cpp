#include <crashsim/export.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/table_io.hpp>

#include "export_cards.hpp"
#include "io/unit_system.hpp"

namespace crashsim {
namespace {

constexpr double kLeastRestitution = 0.05;  // a spring cannot end its force at once
constexpr int kCurveColumns = 20;
constexpr int kCurveDigits = 12;

CardCurve in_units(const ForceCurve& curve, double argument, double force) {
  CardCurve card;
  for (std::size_t i = curve.argument.size(); i-- > 1;) {
    card.argument.push_back(-curve.argument[i] / argument);
    card.force.push_back(-curve.force_n[i] / force);
  }
  for (std::size_t i = 0; i < curve.argument.size(); ++i) {
    card.argument.push_back(curve.argument[i] / argument);
    card.force.push_back(curve.force_n[i] / force);
  }
  return card;
}

/// An even function.
CardCurve on_both_sides(const CardCurve& curve, double argument) {
  CardCurve card;
  for (std::size_t i = curve.argument.size(); i-- > 1;) {
    card.argument.push_back(-curve.argument[i] / argument);
    card.force.push_back(curve.force[i]);
  }
  for (std::size_t i = 0; i < curve.argument.size(); ++i) {
    card.argument.push_back(curve.argument[i] / argument);
    card.force.push_back(curve.force[i]);
  }
  return card;
}

/// @throws InvalidInput where the program has no card for the model's law.
void check_law(const CrushModel& model, const std::string& to) {
  const std::vector<double>& c = model.damper.ordinates;
  if (model.law == CrushLaw::crush_damping && std::ranges::any_of(c, [&](double other) { return other != c.front(); }))
    throw InvalidInput(
        fmt::format("export to {}: law crush_damping has no card there: its springs and dampers in one line multiply "
                    "no velocity by a curve over crush. Export the curves as csv, identify with law force, whose "
                    "damper goes over velocity, or give a damper of one knot",
                    to));
  if (model.law == CrushLaw::rate && model.unloading.kind == UnloadingKind::plastic && to == "lsdyna")
    throw InvalidInput(
        "export to lsdyna: law rate with plastic unloading has no card there: *MAT_SPRING_GENERAL_NONLINEAR, which "
        "unloads, takes no rate. Choose unloading elastic, or export to radioss or csv");
}

double steepest_of(const ForceCurve& curve) {
  double steepest = 0.0;
  for (std::size_t i = 1; i < curve.argument.size(); ++i)
    steepest = std::max(
        steepest, std::abs(curve.force_n[i] - curve.force_n[i - 1]) / (curve.argument[i] - curve.argument[i - 1]));
  return steepest;
}

/// k_u of plastic unloading [N/m]; unset where the spring bears nothing at maximum crush.
double unloading_stiffness(const CrushModel& model, std::vector<std::string>& notes) {
  const Unloading& unloading = model.unloading;
  if (!std::isnan(unloading.unloading_stiffness_n_per_m)) return unloading.unloading_stiffness_n_per_m;
  if (std::isnan(model.impact_speed_mps))
    throw InvalidInput(
        "CrushModel.unloading.restitution: its unloading stiffness depends on the impact speed: give the model "
        "impact_speed_mps, or unloading_stiffness_n_per_m instead");
  SimulateOptions to_max_crush;
  to_max_crush.to_max_crush = true;
  const CrushResponse response = simulate(model, to_max_crush);
  if (std::isnan(response.max_crush_m))
    throw NumericalFailure(fmt::format("the unloading stiffness needs the maximum crush: {}", response.brief_report()));
  const double force = spring_force(model, response.max_crush_m);
  if (!(force > 0.0)) {
    notes.emplace_back(
        "the spring bears no force at maximum crush, so that no unloading stiffness gives the restitution: the cards "
        "unload the way they load");
    return kUnset;
  }
  const double e = std::max(unloading.restitution, kLeastRestitution);
  if (e > unloading.restitution)
    notes.push_back(fmt::format("restitution {:g} cannot be had from a spring: the cards unload with {:g}",
                                unloading.restitution, e));
  const double speed = model.impact_speed_mps;
  notes.push_back(
      fmt::format("the unloading stiffness is that of restitution {:g} at {:.6g} m/s; the model's depends on "
                  "the speed",
                  e, speed));
  return force * force / (e * e * model.mass_kg * speed * speed);
}

void note_limits(const CrushModel& model, CardModel& cards) {
  const auto note = [&](std::string text) { cards.notes.push_back(std::move(text)); };
  const bool has_spring = !model.spring.knots.empty();
  if (!model.unloading.bilateral)
    note(
        "loss of contact is not in the cards: where the model's barrier lets go, they pull; cut them off by a contact "
        "or by failure in tension");
  if (model.unloading.kind == UnloadingKind::plastic && !model.damper.knots.empty())
    note("the damper works in unloading, too; the model's is off after maximum crush");
  if (model.unloading.kind == UnloadingKind::plastic && model.law == CrushLaw::rate)
    note("the rate multiplies the force in unloading, too; the model's is off after maximum crush");
  if (model.extrapolation == Extrapolation::error)
    note("the model ends where a curve's knots end; the solver goes on along the curve's last line");
  if (model.extrapolation == Extrapolation::linear)
    note(
        "half as far again as the last knot the curves end; from there the solver goes on along their last line, the "
        "model along its parabola");
  if (has_spring && spring_force(model, 0.0) > 0.0)
    note(fmt::format(
        "the spring starts with {:.6g} N at once; the cards reach it within {:.3g} mm, a steep line that may "
        "shorten the time step",
        spring_force(model, 0.0), 1e3 * spring_curve(model).argument[1]));
}

/// A cell is empty beyond the end of its own columns.
std::vector<double> padded(std::vector<double> values, std::size_t rows) {
  values.resize(rows, kUnset);
  return values;
}

/// F / s; at 0 the ordinate itself, unset where it is no coefficient but a force.
std::vector<double> coefficients(const ForceCurve& curve, double at_zero) {
  std::vector<double> values;
  for (std::size_t i = 0; i < curve.argument.size(); ++i)
    values.push_back(i == 0 ? at_zero : curve.force_n[i] / curve.argument[i]);
  return values;
}

/// Columns of a table, of different lengths.
using NamedColumns = std::vector<std::pair<std::string, std::vector<double>>>;

double first_of(const PiecewiseLinear& law) { return law.ordinates.empty() ? kUnset : law.ordinates.front(); }

NamedColumns spring_columns(const CrushModel& model) {
  const ForceCurve spring = spring_curve(model);
  const double at_zero = model.law == CrushLaw::stiffness ? first_of(model.spring) : kUnset;
  return {{"crush_m", spring.argument},
          {"stiffness_n_per_m", coefficients(spring, at_zero)},
          {"spring_force_n", spring.force_n}};
}

/// What the law has besides the spring.
NamedColumns rate_columns(const CrushModel& model) {
  if (model.law == CrushLaw::crush_damping) {
    const CardCurve damping = damping_over_crush(model);
    return {{"damper_crush_m", damping.argument}, {"damping_ns_per_m", damping.force}};
  }
  if (model.law == CrushLaw::rate) {
    const CardCurve factor = rate_factor(model);
    return {{"velocity_mps", factor.argument}, {"rate_factor", factor.force}};
  }
  const ForceCurve damper = damper_curve(model);
  return {{"velocity_mps", damper.argument},
          {"damping_ns_per_m", coefficients(damper, first_of(model.damper))},
          {"damper_force_n", damper.force_n}};
}

/// What the columns make of the force.
Comments law_comments(const CrushModel& model) {
  Comments comments = {{"law", std::string(name_of(model.law))}};
  if (model.law == CrushLaw::crush_damping) {
    comments.emplace_back("force", "spring_force_n(x) + damping_ns_per_m(x) v");
    comments.emplace_back("symmetry", "F(-x) = -F(x), c(-x) = c(x)");
  } else if (model.law == CrushLaw::rate) {
    comments.emplace_back("rate_coefficient", format_number(model.rate_coefficient));
    comments.emplace_back("reference_speed_mps", format_number(model.reference_speed_mps));
    comments.emplace_back("force", "spring_force_n(x) rate_factor(v)");
    comments.emplace_back("symmetry", "F(-x) = -F(x), rate_factor(-v) = rate_factor(v)");
  } else {
    comments.emplace_back("symmetry", "F(-x) = -F(x), F(-v) = -F(v)");
  }
  return comments;
}

Exported csv_tables(const CrushModel& model, const Record& record) {
  NamedColumns columns = spring_columns(model);
  for (auto& column : rate_columns(model)) columns.push_back(std::move(column));
  std::size_t rows = 0;
  for (const auto& [name, values] : columns) rows = std::max(rows, values.size());
  for (auto& [name, values] : columns) values = padded(std::move(values), rows);
  Comments comments = {{"crashsim", record.version}, {"mass_kg", format_number(model.mass_kg)}};
  if (!std::isnan(model.impact_speed_mps))
    comments.emplace_back("impact_speed_mps", format_number(model.impact_speed_mps));
  for (auto& comment : law_comments(model)) comments.push_back(std::move(comment));
  comments.emplace_back("record", to_json(record));
  std::vector<Column> table;
  for (const auto& [name, values] : columns) table.push_back({name, values});
  return {format_csv(comments, table), {}};
}

}  // namespace

CardModel card_model(const CrushModel& model, const std::string& units) {
  const io::UnitSystem system = io::parse_unit_system(units);
  const auto unit = [&](Dimension dimension) { return io::to_si(system, dimension); };
  const ForceCurve spring = spring_curve(model);
  CardModel cards;
  cards.spring = in_units(spring, unit(Dimension::length), unit(Dimension::force));
  cards.damper = in_units(damper_curve(model), unit(Dimension::speed), unit(Dimension::force));
  if (model.law == CrushLaw::rate) cards.rate = on_both_sides(rate_factor(model), unit(Dimension::speed));
  if (model.unloading.kind == UnloadingKind::plastic && !model.spring.knots.empty())
    cards.unloading_stiffness = unloading_stiffness(model, cards.notes) / unit(Dimension::stiffness);
  cards.steepest = steepest_of(spring) / unit(Dimension::stiffness);
  for (const double force : cards.spring.force) cards.peak_force = std::max(cards.peak_force, force);
  cards.mass = model.mass_kg / unit(Dimension::mass);
  cards.speed = model.impact_speed_mps / unit(Dimension::speed);
  cards.length = 2.0 * (spring.argument.empty() ? 1.0 : spring.argument.back()) / unit(Dimension::length);
  cards.newton_per_metre = 1.0 / unit(Dimension::stiffness);
  note_limits(model, cards);
  return cards;
}

std::string card_header(const CardModel& cards, const CrushModel& model, const ExportOptions& options,
                        const Record& record, std::string_view mark) {
  std::string text;
  const auto line = [&](std::string_view words) { text += fmt::format("{} {}\n", mark, words); };
  line(fmt::format("crashsim = {}", record.version));
  line(fmt::format("record = {}", to_json(record)));
  line(fmt::format("units = {}", options.units.empty() ? "kg-m-s" : options.units));
  line(fmt::format("mass = {:.9g}, impact speed = {:.9g}", cards.mass, cards.speed));
  line(fmt::format("law = {}, extrapolation = {}, unloading = {}", name_of(model.law), name_of(model.extrapolation),
                   name_of(model.unloading.kind)));
  line("Deflection and force of the elements are positive in tension: crush is compression, negative.");
  line(fmt::format("Lines between the points of a curve are within {:g} of its largest force of the model.",
                   kCurveAccuracy));
  for (const std::string& note : cards.notes) line("NOTE: " + note);
  return text;
}

std::string number_field(double value, int width) {
  for (int digits = kCurveDigits; digits > 1; --digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    if (static_cast<int>(text.size()) <= width) return fmt::format("{:>{}}", text, width);
  }
  return fmt::format("{:>{}.0e}", value, width);
}

std::string curve_lines(const CardCurve& curve) {
  std::string text;
  for (std::size_t i = 0; i < curve.argument.size(); ++i)
    text += number_field(curve.argument[i], kCurveColumns) + number_field(curve.force[i], kCurveColumns) + "\n";
  return text;
}

Exported export_model(const CrushModel& model, const ExportOptions& options, const Record& record) {
  validate_options(options, "ExportOptions");
  validate(model);
  if (std::ranges::find(kExportTargets, options.to) == std::end(kExportTargets)) {
    if (options.to.empty()) throw InvalidInput("export: to what? give --to lsdyna, radioss, csv or iso-mme");
    detail::throw_unknown_name("--to", options.to, {std::begin(kExportTargets), std::end(kExportTargets)});
  }
  if (options.to == kIsoMmeTarget)
    throw InvalidInput("export: an ISO-MME test is made of traces (pulse.csv, response.csv), not of a model");
  if (options.to == "csv") {
    if (io::parse_unit_system(options.units) != io::UnitSystem{})
      throw InvalidInput(fmt::format("units = {}: a table is in SI, as its columns say: leave it out", options.units));
    return csv_tables(model, record);
  }
  check_law(model, options.to);
  CardModel cards = card_model(model, options.units);
  const bool is_lsdyna = options.to == "lsdyna";
  if (!is_lsdyna && cards.unloading_stiffness < cards.steepest)
    cards.notes.push_back(fmt::format(
        "the unloading stiffness {:.6g} is below the steepest loading, {:.6g}: OpenRadioss raises it to that",
        cards.unloading_stiffness, cards.steepest));
  const std::string header = card_header(cards, model, options, record, is_lsdyna ? "$" : "#");
  return {header + (is_lsdyna ? lsdyna_cards(cards, options.first_id) : radioss_cards(cards, options.first_id)),
          std::move(cards.notes)};
}

}  // namespace crashsim
