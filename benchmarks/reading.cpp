/// bench_reading: how fast traces are read from files in memory (warm cache), by one thread.
///
///     bench_reading write FOLDER MEGABYTES    writes a file of each format, prints their paths
///     bench_reading read FILE...              reads each five times, prints the best as a line of JSON
///
/// `memory` is the most that was allocated over the arrays kept; the checksum is the sum of all samples in the file's
/// units, for other readers to compare with.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <crashsim/error.hpp>
#include <crashsim/trace_io.hpp>

#include "counted_memory.hpp"
#include "generated_traces.hpp"

namespace crashsim::bench {
namespace {

constexpr int kRepetitions = 5;
constexpr double kMega = 1e6;

struct Reading {
  double seconds = kUnset, file_bytes = 0.0, kept_bytes = 0.0, peak_bytes = 0.0, checksum = 0.0;
};

double size_of(const std::vector<std::string>& files) {
  double bytes = 0.0;
  for (const std::string& file : files) bytes += static_cast<double>(std::filesystem::file_size(file));
  return bytes;
}

/// Of the arrays that a set keeps, clocks that channels share counted once.
double kept_bytes(const TraceSet& set) {
  std::set<const void*> clocks;
  std::size_t samples = 0;
  for (const Trace& trace : set.traces) {
    samples += trace.values.size();
    if (clocks.insert(trace.time_s.get()).second) samples += trace.times().size();
  }
  return static_cast<double>(samples * sizeof(double));
}

double checksum(const TraceSet& set) {
  double sum = 0.0;
  for (const Trace& trace : set.traces) {
    const auto unit = find_unit(trace.source_unit);
    double of_trace = 0.0;
    for (const double value : trace.values) of_trace += value;
    sum += of_trace / (unit ? unit->to_si : 1.0);
  }
  return sum;
}

Reading read_once(const std::string& path) {
  Reading reading;
  const std::size_t before = allocated_bytes();
  forget_peak();
  const auto start = std::chrono::steady_clock::now();
  const TraceSet set = read_traces(path);
  reading.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  reading.peak_bytes = static_cast<double>(peak_allocated_bytes() - before);
  reading.kept_bytes = kept_bytes(set);
  reading.file_bytes = size_of(set.input_files);
  reading.checksum = checksum(set);
  return reading;
}

void read(const std::string& path) {
  Reading best;
  for (int i = 0; i < kRepetitions; ++i) {
    const Reading reading = read_once(path);
    if (std::isnan(best.seconds) || reading.seconds < best.seconds) best = reading;
  }
  const nlohmann::json result = {{"workload", "reading"},
                                 {"engine", "crashsim"},
                                 {"file", std::filesystem::path(path).filename().string()},
                                 {"megabytes", best.file_bytes / kMega},
                                 {"seconds", best.seconds},
                                 {"memory", best.peak_bytes / best.kept_bytes},
                                 {"checksum", best.checksum}};
  fmt::print("{}\n", result.dump());
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 3 && arguments[0] == "write") {
    const auto megabytes = static_cast<std::size_t>(std::atol(arguments[2].c_str()));
    for (const auto write : {write_ev5, write_nodout, write_binout, write_csv_table})
      fmt::print("{}\n", write(arguments[1], megabytes));
    return 0;
  }
  if (arguments.size() < 2 || arguments[0] != "read") {
    fmt::print(stderr, "usage: bench_reading write FOLDER MEGABYTES | read FILE...\n");
    return 2;
  }
  for (std::size_t i = 1; i < arguments.size(); ++i) read(arguments[i]);
  return 0;
}

}  // namespace
}  // namespace crashsim::bench

int main(int argc, char** argv) {
  try {
    return crashsim::bench::run({argv + 1, argv + argc});
  } catch (const crashsim::InvalidInput& error) {
    fmt::print(stderr, "bench_reading: {}\n", error.what());
    return 2;
  }
}
