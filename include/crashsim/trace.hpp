#pragma once
/// A measured or computed time history, and the set of them that one file holds.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

namespace crashsim {

/// One channel over time, in SI units, with where it came from.
struct Trace {
  std::string id;    ///< Number or code in its file: "93", "10SEATLERE00ACXP"; the column number for CSV.
  std::string name;  ///< What its file calls it.
  std::string
      database;  ///< Which of a file's histories it belongs to ("nodout", "glstat"), "" where there is one only.
  std::string location;                      ///< Sensor location or node ("FLLR"), "" when the file does not say.
  char axis = ' ';                           ///< 'X', 'Y', 'Z' (SAE J1733: forward, right, down) or ' '.
  Dimension dimension = Dimension::unknown;  ///< What it measures.
  std::string source_unit;  ///< Unit in the file, before conversion to SI; "" when the file does not say.
  std::string problem;      ///< Why it must not be used ("no valid data"), "" when its source has no doubt.
  bool has_samples = true;  ///< False when the samples are absent or were not asked for.
  std::shared_ptr<const std::vector<double>> time_s;  ///< Sample times [s], shared between channels of one clock.
  std::vector<double> values;                         ///< Samples [SI], as many as times.

  /// Sample times [s].
  [[nodiscard]] std::span<const double> times() const {
    return time_s ? std::span<const double>(*time_s) : std::span<const double>();
  }
};

/// Everything read from one file or folder.
struct TraceSet {
  std::string path;                  ///< As given by the caller.
  std::string format;                ///< "csv", "nhtsa_ev5", "radioss_csv", ...
  std::string title;                 ///< Run or test title, "" when there is none.
  double mass_kg = kUnset;           ///< Test mass [kg] when the file says it.
  double impact_speed_mps = kUnset;  ///< Impact speed [m/s] when the file says it.
  /// What the file says about the test or run beside its channels, in its order: {"VEHICLE[1].MODEL", "CAMRY"}.
  std::vector<std::pair<std::string, std::string>> metadata;
  std::vector<std::string> input_files;    ///< Every file read.
  std::vector<std::string> warnings;       ///< What a careful reader should know.
  std::vector<std::string> compartment_x;  ///< Ids of the channels that measure the compartment's longitudinal motion.
  std::vector<Trace> traces;               ///< In file order.
};

/// Indices into `set.traces` of the channels a selector names: an id, a name, or a glob (`*`, `?`, `[..]`) over both.
/// An exact id wins over a name, a name over a glob.
/// @throws InvalidInput when nothing matches; the message lists the nearest names.
std::vector<std::size_t> select_channels(const TraceSet& set, const std::string& selector);

}  // namespace crashsim
