#pragma once
/// Design with the coupled model: how crush, pitch and drop react to its numbers, and the best numbers under limits.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/coupled_model.hpp>
#include <crashsim/design_options.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/named_number.hpp>
#include <crashsim/simulate_coupled.hpp>

namespace crashsim {

/// What a design is judged by; all unset when its motion is not usable.
struct DesignResponses {
  double pitch_max_rad = kUnset;  ///< Largest pitch, nose down [rad].
  double heave_min_m = kUnset;    ///< Lowest heave; the drop is its negative [m].
  double max_crush_m = kUnset;    ///< Maximum crush where the force acts [m].
  double olc_g = kUnset;          ///< Occupant load criterion of the travel [g of 9.81].
  double peak_decel_g = kUnset;   ///< Peak deceleration of the travel [g].
  double t_m_s = kUnset;          ///< Time of maximum crush [s].
};
inline constexpr std::array<NamedNumber<DesignResponses>, 6> kDesignResponses = {{
    {"pitch_max_rad", &DesignResponses::pitch_max_rad, "largest pitch, nose down"},
    {"heave_min_m", &DesignResponses::heave_min_m, "lowest heave"},
    {"max_crush_m", &DesignResponses::max_crush_m, "maximum crush where the force acts"},
    {"olc_g", &DesignResponses::olc_g, "occupant load criterion"},
    {"peak_decel_g", &DesignResponses::peak_decel_g, "peak deceleration"},
    {"t_m_s", &DesignResponses::t_m_s, "time of maximum crush"},
}};
DesignResponses design_responses(const CoupledResponse& response);

/// A quantity of these responses; unset for `none`.
double quantity_of(const DesignResponses& responses, DesignQuantity quantity);

/// One parameter of a design.
struct DesignVariable {
  std::string name;  ///< "force_height_m", "k3_n_per_m"
  std::string unit;  ///< SI symbol.
  double lower = kUnset, upper = kUnset;
  double before = kUnset, after = kUnset;  ///< In the given model, at the optimum.
  bool at_bound = false;
};

/// How one response of the given model reacts to one parameter.
struct DesignSensitivity {
  std::string parameter;       ///< Name of a DesignVariable.
  std::string response;        ///< Name in kDesignResponses.
  double derivative = kUnset;  ///< d response / d parameter [SI]; unset when a neighbouring design is not usable.
  double error = kUnset;       ///< Estimate of its error [SI].
  double relative = kUnset;    ///< % of the response per % of the parameter; unset where either is 0.
};

/// A limit, and how the designs keep to it.
struct DesignLimit {
  DesignQuantity quantity = DesignQuantity::none;
  double limit = kUnset, before = kUnset, after = kUnset;
  bool active = false;  ///< The optimum lies on it.
};

/// The optimum under one limit of the trade-off curve; values unset when there is none.
struct TradeOffPoint {
  double limit = kUnset;
  bool feasible = false;
  double objective = kUnset;  ///< The quantity minimised.
  DesignResponses responses;
  std::vector<double> values;  ///< Of the parameters [SI].
};

enum class DesignOutcome {
  not_run,
  completed,
  infeasible,    ///< No design in the ranges keeps all limits; `after` is the one that exceeds them least.
  model_failed,  ///< The given model has no usable motion.
  interrupted
};
inline constexpr std::string_view kDesignOutcomeNames[] = {"not_run", "completed", "infeasible", "model_failed",
                                                           "interrupted"};
template <>
inline constexpr std::span<const std::string_view> enum_names<DesignOutcome>{kDesignOutcomeNames};

/// What a design study gives.
struct DesignResult {
  DesignOutcome outcome = DesignOutcome::not_run;
  std::string message;
  std::vector<DesignVariable> variables;         ///< In the order of DesignOptions::parameters.
  std::vector<DesignSensitivity> sensitivities;  ///< Of the given model, parameter by parameter.
  DesignResponses before, after;                 ///< Of the given model, at the optimum.
  DesignQuantity minimised = DesignQuantity::none;
  std::vector<DesignLimit> limits;
  CoupledModel optimum;                          ///< The given model where nothing was minimised.
  DesignQuantity traded = DesignQuantity::none;  ///< Whose limit varies along the curve.
  std::vector<TradeOffPoint> trade_off;          ///< By increasing limit.
  int starts = 0, starts_at_best = 0;            ///< Starts within 0.1 % of the best.
  long simulations = 0;
  double seconds = kUnset;  ///< Wall time.
  std::vector<std::string> warnings;

  [[nodiscard]] bool usable() const { return outcome == DesignOutcome::completed; }
  /// One line: outcome, what was reached and the limits it lies on.
  [[nodiscard]] std::string brief_report() const;
};

/// Sensitivities by central differences, extrapolated to a step of 0 (Ridders); one-sided at the end of what a
/// parameter may be. Optimum: gradients by differences and NLopt's SLSQP from each start, then COBYLA, which needs no
/// gradients and may get further where a kink stops SLSQP, from the best. Trade-off: the same under each limit, also
/// from the neighbours' optima.
/// @param simulation how to simulate; its rtol is not used: all runs have 1e-10.
/// @throws InvalidInput on a bad model or option, an unknown parameter, or one that the model leaves unset.
DesignResult design(const CoupledModel& model, const DesignOptions& options, const CoupledOptions& simulation = {},
                    const Progress& progress = {});

}  // namespace crashsim
