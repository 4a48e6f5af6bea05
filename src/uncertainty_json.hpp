#pragma once
/// The uncertainty of a model in model.json.

#include <crashsim/predict.hpp>
#include <crashsim/uncertainty.hpp>

#include "json_object.hpp"

namespace crashsim {

/// Member `uncertainty`.
Json uncertainty_json(const Uncertainty& uncertainty);

/// Reads it, and of `identification` tests and verdict, as far as the file has them, for the model already in `basis`.
/// @throws InvalidInput naming what does not fit.
void read_basis(const JsonObject& file, PredictionBasis& basis);

}  // namespace crashsim
