#pragma once
/// The crush model as a file, model.json.

#include <string>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/option_docs.hpp>
#include <crashsim/record.hpp>

namespace crashsim {

/// Every key of model.json, table by table.
std::vector<FileKey> model_keys();

/// Reads a model. Written by hand it needs `format` ("crashsim.crush_model"), `version` (1), `mass_kg`, and `spring` or
/// `damper` or both; what an identification adds is not read.
/// @throws InvalidInput with path, key, value and rule when it is missing, not JSON, of another format
///         or version, has an unknown key
///         or a bad value.
CrushModel read_model(const std::string& path);

/// The text of model.json. `identification` and `record`, where given, become its members of these names.
std::string format_model(const CrushModel& model, const Identification* identification = nullptr,
                         const Record* record = nullptr);

}  // namespace crashsim
