#pragma once
/// What identifications have in common, as JSON.

#include <vector>

#include <crashsim/identify.hpp>

#include "json.hpp"

namespace crashsim {

/// One object for each: name, unit, value, standard error, bounds and what is wrong with it.
Json parameters_json(const std::vector<ParameterReport>& parameters);

Json correlation_json(const std::vector<std::vector<double>>& correlation);

/// E of every start.
Json start_errors_json(const std::vector<StartReport>& starts);

/// Members that identifications of named numbers share. Wall time is left out: a record run again gives the same bytes.
template <class Fit>
Json named_fit_json(const Fit& fit) {
  return {{"outcome", name_of(fit.outcome)},
          {"starts", fit.starts.size()},
          {"starts_at_best", fit.starts_at_best},
          {"verdict",
           {{"identifiable", fit.verdict.identifiable},
            {"rank", fit.verdict.rank},
            {"condition", json_number(fit.verdict.condition)},
            {"message", fit.verdict.message}}},
          {"parameters", parameters_json(fit.parameters)},
          {"evaluations", fit.evaluations},
          {"seed", fit.seed},
          {"correlation", correlation_json(fit.correlation)},
          {"start_errors", start_errors_json(fit.starts)}};
}

}  // namespace crashsim
