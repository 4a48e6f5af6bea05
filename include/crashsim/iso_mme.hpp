#pragma once
/// Writing channels as an ISO-MME test (ISO/TS 13499), which crash test software reads.

#include <memory>
#include <string>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/trace.hpp>
#include <crashsim/units.hpp>

namespace crashsim {

/// A channel to be written, in SI units and with the signs of SAE J211: X forward, Y right, Z down.
struct IsoMmeChannel {
  std::string code;                                   ///< 16 letters and digits: "10VEHCCG0000ACXD".
  std::string name;                                   ///< What people call it.
  std::string comment;                                ///< One line, "" none.
  Dimension dimension = Dimension::unknown;           ///< One that the standard has a unit for.
  std::string problem;                                ///< Why it is questionable, "" when it is not.
  std::shared_ptr<const std::vector<double>> time_s;  ///< Sample times [s].
  std::vector<double> values;                         ///< As many as times [SI]; NaN is written as NOVALUE.
};

/// A test to be written.
struct IsoMmeTest {
  std::string name;                        ///< Of its files: name.mme, Channel/name.001.
  std::string title;                       ///< "" when there is none.
  std::string data_source = "simulation";  ///< "simulation", "calculation", "transducer" or "camera".
  double mass_kg = kUnset;                 ///< Test mass [kg], unset when unknown.
  double impact_speed_mps = kUnset;        ///< Impact speed [m/s], unset when unknown.
  std::vector<std::string> comments;       ///< Where it comes from, one line each.
  std::string record;                      ///< What made it, as to_json(record); "" when there is none.
  std::vector<IsoMmeChannel> channels;
  std::vector<std::string> notes;  ///< Channels left out, and why; not written.
};

/// The channels of a set under their ISO-MME codes. Columns of this program's files (pulse.csv, response.csv,
/// pitch.csv, coupled.csv) have codes of their own, and those with another sign than SAE J211 are turned: heave, which
/// is up positive, pitch, which is nose-down positive, and forces that stop the vehicle; their names end in
/// "(SAE J211 sign)". Other channels keep their code when that is one, or get one by what they measure. The filter
/// class is that of the set's step `filter: CFC60 ..`. A channel that has no samples or measures what the standard has
/// no letters for is left out.
/// @param notes gets "left out: channel 2 k_n_per_m: .." for each of those.
/// @throws InvalidInput when none is left.
std::vector<IsoMmeChannel> iso_mme_channels(const TraceSet& set, std::vector<std::string>& notes);

/// A set as a test called `name`: its channels, mass, speed, title, and for a CSV file its comments.
/// @throws InvalidInput as iso_mme_channels().
IsoMmeTest make_iso_mme_test(const TraceSet& set, const std::string& name);

/// The files of a test: NAME.mme, NAME.txt with the record, Channel/NAME.chn and Channel/NAME.001 and so on. Numbers
/// read back as the same doubles. Times that are uniform but for rounding become a first time and an interval, others a
/// time channel that the channels refer to.
/// @throws InvalidInput naming what is no proper name, code, series or dimension.
std::vector<FileText> format_iso_mme(const IsoMmeTest& test);

/// Writes format_iso_mme() as a folder, whole or not at all.
/// @throws InvalidInput as format_iso_mme() and write_folder_atomically().
void write_iso_mme(const IsoMmeTest& test, const std::string& folder, bool overwrite = false);

}  // namespace crashsim
