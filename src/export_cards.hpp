#pragma once
/// What the writers of cards share: the model in the deck's units, and fields of fixed width.

#include <string>
#include <string_view>
#include <vector>

#include <crashsim/export.hpp>

namespace crashsim {

/// Points, in a card over tension and compression; `force` may be what a force is multiplied by.
struct CardCurve {
  std::vector<double> argument, force;
};

/// A model in the deck's units.
struct CardModel {
  CardCurve spring, damper;             ///< Empty where the model has none.
  CardCurve rate;                       ///< Law `rate`: what the spring's force is multiplied by, over velocity.
  double unloading_stiffness = kUnset;  ///< Of plastic unloading.
  double steepest = 0.0;                ///< Largest slope of the spring.
  double peak_force = 0.0;              ///< Largest spring force.
  double mass = 0.0, speed = kUnset;    ///< Of the vehicle.
  double length = 0.0;                  ///< A length that the spring does not use up.
  double newton_per_metre = 1.0;        ///< 1 N/m.
  std::vector<std::string> notes;
};

/// Damping [N s/m] of law `crush_damping` over crush [m].
CardCurve damping_over_crush(const CrushModel& model);

/// 1 + r ln(1 + v / v_ref) of law `rate` over v >= 0 [m/s].
CardCurve rate_factor(const CrushModel& model);

/// @throws InvalidInput, NumericalFailure as export_model().
CardModel card_model(const CrushModel& model, const std::string& units);

/// What stands at the top of a file: what it is, what made it, signs, notes; each line after `mark`.
std::string card_header(const CardModel& cards, const CrushModel& model, const ExportOptions& options,
                        const Record& record, std::string_view mark);

/// A number in a field; digits are dropped where it would be too long.
std::string number_field(double value, int width);

/// The points of a curve, two fields of 20 columns a line.
std::string curve_lines(const CardCurve& curve);

std::string lsdyna_cards(const CardModel& cards, int first_id);
std::string radioss_cards(const CardModel& cards, int first_id);

}  // namespace crashsim
