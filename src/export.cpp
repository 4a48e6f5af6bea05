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

Exported csv_tables(const CrushModel& model, const Record& record) {
  const ForceCurve spring = spring_curve(model), damper = damper_curve(model);
  const auto at_zero = [](const PiecewiseLinear& law) {
    return law.ordinates.empty() ? kUnset : law.ordinates.front();
  };
  const std::size_t rows = std::max(spring.argument.size(), damper.argument.size());
  const auto x = padded(spring.argument, rows), f = padded(spring.force_n, rows);
  const auto k = padded(coefficients(spring, model.law == CrushLaw::stiffness ? at_zero(model.spring) : kUnset), rows);
  const auto v = padded(damper.argument, rows), g = padded(damper.force_n, rows);
  const auto c = padded(coefficients(damper, at_zero(model.damper)), rows);
  Comments comments = {{"crashsim", record.version}, {"mass_kg", format_number(model.mass_kg)}};
  if (!std::isnan(model.impact_speed_mps))
    comments.emplace_back("impact_speed_mps", format_number(model.impact_speed_mps));
  comments.emplace_back("law", std::string(name_of(model.law)));
  comments.emplace_back("symmetry", "F(-x) = -F(x), F(-v) = -F(v)");
  comments.emplace_back("record", to_json(record));
  return {format_csv(comments, {{"crush_m", x},
                                {"stiffness_n_per_m", k},
                                {"spring_force_n", f},
                                {"velocity_mps", v},
                                {"damping_ns_per_m", c},
                                {"damper_force_n", g}}),
          {}};
}

}  // namespace

CardModel card_model(const CrushModel& model, const std::string& units) {
  const io::UnitSystem system = io::parse_unit_system(units);
  const auto unit = [&](Dimension dimension) { return io::to_si(system, dimension); };
  const ForceCurve spring = spring_curve(model);
  CardModel cards;
  cards.spring = in_units(spring, unit(Dimension::length), unit(Dimension::force));
  cards.damper = in_units(damper_curve(model), unit(Dimension::speed), unit(Dimension::force));
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
