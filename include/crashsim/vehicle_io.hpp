#pragma once
/// The vehicle on its axles as a file, vehicle.json.

#include <string>
#include <vector>

#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/identify_pitch.hpp>
#include <crashsim/option_docs.hpp>
#include <crashsim/record.hpp>

namespace crashsim {

/// Every key of vehicle.json.
std::vector<FileKey> vehicle_keys();

/// Reads a vehicle: JSON with the keys of vehicle_keys(), or the [vehicle] table of a TOML file. What it does not say
/// stays unset; validate() tells what is missing.
/// @throws InvalidInput with path, key, value and rule when it is missing, neither JSON nor TOML,
///         another kind of file, or has an unknown key
///         or a bad value.
HeavePitchModel read_vehicle(const std::string& path);

/// The vehicle as JSON that read_vehicle() reads; with how it was identified and made, where that is given.
/// @throws InvalidInput on a bad model.
std::string format_vehicle(const HeavePitchModel& model, const PitchIdentification* identification = nullptr,
                           const Record* record = nullptr);

}  // namespace crashsim
