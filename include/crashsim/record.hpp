#pragma once
/// The record of a run, kept in every output: what was asked, of which inputs, by which version. Running it again gives
/// the same bytes.

#include <optional>
#include <string>
#include <vector>

#include <crashsim/config.hpp>

namespace crashsim {

/// An input as it was.
struct RecordedInput {
  std::string path;    ///< As given; relative to the folder the command ran in.
  std::string sha256;  ///< Of its bytes, 64 hexadecimal digits.

  bool operator==(const RecordedInput&) const = default;
};

/// What made an output.
struct Record {
  std::string version;                 ///< Of crashsim: "0.1.0".
  std::string command;                 ///< Subcommand: "pulse".
  std::vector<std::string> arguments;  ///< Files named on the command line, in order.
  std::vector<ConfigEntry> options;    ///< Every option that the result depends on, set or default.
  std::vector<RecordedInput> inputs;   ///< Every file read.
};

/// A record of this version, with the inputs' fingerprints. Options named `jobs` are left out: results do not depend on
/// them. @throws InvalidInput when an input cannot be read.
Record make_record(std::string command, std::vector<std::string> arguments, std::vector<ConfigEntry> options,
                   const std::vector<std::string>& input_files);

/// The record as one line of JSON.
std::string to_json(const Record& record);

/// The record in a file: a `case.lock.json`, the member `record` of a JSON output or the comment `# record = ..` of a
/// CSV output (`$` before the cards of LS-DYNA); empty when there is none. @throws InvalidInput when the file is
/// missing or its record is damaged.
std::optional<Record> find_record(const std::string& path);

/// @throws InvalidInput naming the first input that is gone or has changed since.
void verify_inputs(const Record& record);

}  // namespace crashsim
