#include <crashsim/trace_io.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/redundancy.hpp>
#include <crashsim/signal.hpp>

#include "io/reader.hpp"
#include "text.hpp"

namespace crashsim {
namespace io {

std::span<const Reader* const> readers() {
  static constexpr const Reader* kReaders[] = {&kNhtsaReader,        &kNhtsaUdsReader,    &kIsoMmeReader,
                                               &kLsdynaBinoutReader, &kLsdynaAsciiReader, &kRadiossT01Reader,
                                               &kRadiossCsvReader,   &kCsvReader};
  return kReaders;
}

namespace {

/// Whether the names of the first files in an archive are those of an ISO-MME test.
bool is_archived_test(std::string_view head) {
  const std::string names = to_lower(head);
  return names.find(".mme") != std::string::npos || names.find(".chn") != std::string::npos ||
         names.find("channel/") != std::string::npos;
}

/// What a file that no reader wants looks like, in words.
std::string_view looks_like(const InputFile& file) {
  constexpr std::size_t kSample = 4096, kTarMark = 257;
  if (file.is_folder()) return "a folder without trace files";
  const std::string_view head = file.bytes().substr(0, kSample);
  const std::string_view text = trimmed(head);
  if (text.empty()) return head.size() == file.bytes().size() ? "the file is empty" : "blank lines";
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) return "UTF-16 text: save it as UTF-8";
  if (head.starts_with("PK\x03\x04"))
    return is_archived_test(head) ? "a zip archive of an ISO-MME test: unpack it and name its folder"
                                  : "a zip archive or a spreadsheet: unpack it, or export it as CSV";
  if (head.starts_with("7z\xbc\xaf")) return "a 7z archive: unpack it and name what it holds";
  if (head.size() > kTarMark && head.substr(kTarMark).starts_with("ustar"))
    return "a tar archive: unpack it and name what it holds";
  if (head.starts_with("\x1f\x8b")) return "gzip: unpack it first";
  if (head.find('\0') != std::string_view::npos) return "binary data";
  if (text.front() == '{' || (text.front() == '[' && text.size() > 1)) return "JSON";
  if (text.front() == '<') return "HTML or XML";
  return "text without a table of numbers";
}

[[noreturn]] void refuse(const InputFile& file) {
  std::string known;
  for (const Reader* reader : readers()) known += fmt::format("{}{}", known.empty() ? "" : ", ", reader->description);
  throw InvalidInput(fmt::format("{}: not a trace file: {}. Formats known: {}", file.path(), looks_like(file), known));
}

}  // namespace

TraceSet read_chosen(const std::string& path, const ReadOptions& options, const Choose& choose) {
  const InputFile file(path);
  for (const Reader* reader : readers()) {
    if (!reader->detects(file)) continue;
    const Choose distinct = [&](const TraceSet& catalogue) {
      std::vector<std::size_t> chosen = choose(catalogue);
      std::sort(chosen.begin(), chosen.end());
      chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
      return chosen;
    };
    TraceSet set = reader->read(file, options, distinct);
    set.format = reader->name;
    return set;
  }
  refuse(file);
}

std::size_t most_channels(std::size_t file_bytes) {
  constexpr std::size_t kTraceBytes = 400, kAlways = std::size_t{48} << 20;
  return (3 * file_bytes + kAlways) / kTraceBytes;
}

std::vector<std::size_t> channels_named_by(const ReadOptions& options, const TraceSet& catalogue) {
  std::vector<bool> named(catalogue.traces.size(), options.channels.empty());
  for (const std::string& selector : options.channels)
    for (const std::size_t i : select_channels(catalogue, selector)) named[i] = true;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < named.size(); ++i)
    if (named[i]) indices.push_back(i);
  return indices;
}

}  // namespace io

namespace {

ChannelInfo describe(const Trace& trace) {
  ChannelInfo info;
  info.id = trace.id;
  info.name = trace.name;
  info.database = trace.database;
  info.location = trace.location;
  info.axis = trace.axis;
  info.unit = trace.dimension == Dimension::unknown ? trace.source_unit : si_symbol(trace.dimension);
  info.status = trace.problem.empty() ? "ok" : trace.problem;
  info.samples = trace.values.size();
  if (trace.values.empty()) return info;

  const auto times = trace.times();
  info.first_s = times.front();
  info.last_s = times.back();
  info.uniform = !std::isnan(uniform_step(times));
  if (times.size() > 1) info.rate_hz = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  std::size_t missing = 0;
  for (const double value : trace.values) {  // comparisons with NaN are false: the first number starts the range
    if (!(value >= info.min)) info.min = std::isnan(value) ? info.min : value;
    if (!(value <= info.max)) info.max = std::isnan(value) ? info.max : value;
    if (std::isnan(value)) ++missing;
  }
  if (missing > 0 && trace.problem.empty())
    info.status = fmt::format("{} of {} samples are missing", missing, trace.values.size());
  return info;
}

}  // namespace

TraceSet read_traces(const std::string& path, const ReadOptions& options) {
  return io::read_chosen(path, options,
                         [&](const TraceSet& catalogue) { return io::channels_named_by(options, catalogue); });
}

TraceFileInfo inspect_traces(const std::string& path, const ReadOptions& options) {
  std::vector<std::size_t> chosen;
  TraceFileInfo info{
      io::read_chosen(path, options,
                      [&](const TraceSet& catalogue) { return chosen = io::channels_named_by(options, catalogue); }),
      {}};
  const std::vector<std::string> findings = check_redundant(info.set);
  info.set.warnings.insert(info.set.warnings.end(), findings.begin(), findings.end());
  for (const std::size_t i : chosen) info.channels.push_back(describe(info.set.traces[i]));
  info.set.traces.clear();
  return info;
}

}  // namespace crashsim
