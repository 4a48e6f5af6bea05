#pragma once
/// What every trace reader offers, and the list of them.
///
/// A reader first builds the catalogue: a TraceSet whose traces carry everything but samples (`has_samples` false). It
/// asks `choose` which of them are wanted, reads those and nothing more, and sets their `has_samples`. A channel whose
/// samples cannot be had keeps `has_samples` false and says why in `problem`; only what makes the whole file useless
/// throws. Values leave the reader in SI units.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/trace.hpp>
#include <crashsim/trace_io.hpp>

#include "io/input_file.hpp"

namespace crashsim::io {

/// Indices of the wanted traces of a catalogue.
using Choose = std::function<std::vector<std::size_t>(const TraceSet& catalogue)>;

struct Reader {
  std::string_view name;         ///< TraceSet::format: "nhtsa_ev5".
  std::string_view description;  ///< For the list of known formats: "NHTSA EV5 (header or channel file)".
  /// Whether the content is of this format; the name decides only where the content cannot.
  bool (*detects)(const InputFile& file);
  /// Sets everything but `format`; `path` and `input_files` before it chooses.
  TraceSet (*read)(const InputFile& file, const ReadOptions& options, const Choose& choose);
};

extern const Reader kIsoMmeReader;
extern const Reader kNhtsaReader;
extern const Reader kLsdynaBinoutReader;
extern const Reader kLsdynaAsciiReader;
extern const Reader kRadiossT01Reader;
extern const Reader kNhtsaUdsReader;
extern const Reader kRadiossCsvReader;
extern const Reader kCsvReader;

/// Every reader, the most particular first: the first that detects a file reads it.
std::span<const Reader* const> readers();

/// Opens a file, finds its reader and reads the chosen channels. @throws InvalidInput as read_traces().
TraceSet read_chosen(const std::string& path, const ReadOptions& options, const Choose& choose);

/// How many channels a file of so many bytes may have: a damaged one must not make more of them than memory holds.
std::size_t most_channels(std::size_t file_bytes);

/// The channels that `options.channels` name, in catalogue order; all when it is empty.
std::vector<std::size_t> channels_named_by(const ReadOptions& options, const TraceSet& catalogue);

}  // namespace crashsim::io
