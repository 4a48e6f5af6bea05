#pragma once
/// Numbers of a coupled model that a design may change, and limits of what it does.

#include <span>
#include <string>
#include <variant>
#include <vector>

#include <crashsim/design.hpp>

namespace crashsim {

/// Where a number of a coupled model is: a member of one of its parts, or an ordinate of one of the crush curves.
struct CurveOrdinate {
  PiecewiseLinear CrushModel::*curve;
  std::size_t index;

  bool operator==(const CurveOrdinate&) const = default;
};
using ModelPlace =
    std::variant<double HeavePitchModel::*, double VerticalForceLaw::*, double CrushModel::*, CurveOrdinate>;

/// One number, sought evenly between its bounds.
struct DesignParameter {
  std::string name, unit;
  ModelPlace place;
  Range allowed;  ///< What the model allows.
  double lower = kUnset, upper = kUnset;

  [[nodiscard]] double value_at(double place_between) const;
  [[nodiscard]] double place_of(double value) const;
};

double value_of(const CoupledModel& model, const DesignParameter& parameter);
void set_value(CoupledModel& model, const DesignParameter& parameter, double value);

/// Reads parameters with their bounds. @throws InvalidInput naming the name or bound that is not allowed.
std::vector<DesignParameter> design_parameters(const CoupledModel& model, const DesignOptions& options);

/// SI symbol of a quantity, "" for those in g.
std::string_view unit_of(DesignQuantity quantity);

/// What must not be exceeded.
struct QuantityLimit {
  DesignQuantity quantity;
  double value;
};
std::vector<QuantityLimit> limits_of(const DesignOptions& options);

/// Limits of the trade-off curve, increasing. @throws InvalidInput when they are none, or what they limit is minimised.
std::vector<double> trade_off_limits(const DesignOptions& options);

}  // namespace crashsim
