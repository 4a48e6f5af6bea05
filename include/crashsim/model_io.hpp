#pragma once
/// The crush model as a file, model.json.

#include <string>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/option_docs.hpp>
#include <crashsim/predict.hpp>
#include <crashsim/record.hpp>
#include <crashsim/uncertainty.hpp>

namespace crashsim {

/// Every key of model.json, table by table.
std::vector<FileKey> model_keys();

/// Reads a model. Written by hand it needs `format` ("crashsim.crush_model"), `version` (1), `mass_kg`, and `spring` or
/// `damper` or both; what an identification adds is not read.
/// @throws InvalidInput with path, key, value and rule when it is missing, not JSON, of another format
///         or version, has an unknown key
///         or a bad value.
CrushModel read_model(const std::string& path);

/// Reads a model with what predictions rest on, as far as it is there: the tests it was identified from, the verdict,
/// and the replicates of the fit.
/// @throws InvalidInput as read_model(), and when these do not fit the model.
PredictionBasis read_prediction_basis(const std::string& path);

/// The text of model.json. `identification`, `record` and `uncertainty`, where given, become its members of these
/// names. Replicates have nine digits.
std::string format_model(const CrushModel& model, const Identification* identification = nullptr,
                         const Record* record = nullptr, const Uncertainty* uncertainty = nullptr);

}  // namespace crashsim
