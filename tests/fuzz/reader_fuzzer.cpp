/// libFuzzer target of one trace reader, CRASHSIM_FUZZED_READER: the input is a file's bytes.
///
/// What must hold for any bytes, in any units: only InvalidInput is thrown; the rules of trace_rules.hpp; a channel of
/// a sound file, read alone, is the same as read among all; and no more memory is held than fuzz_memory.hpp allows.

#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>

#include <crashsim/error.hpp>

#include "fuzz_memory.hpp"
#include "io/reader.hpp"
#include "trace_rules.hpp"

namespace crashsim {
namespace {

std::vector<std::size_t> all_of(const TraceSet& catalogue) {
  std::vector<std::size_t> all(catalogue.traces.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

void check_alone(const io::Reader& reader, const io::InputFile& file, const Trace& trace, std::size_t index) {
  const TraceSet set = reader.read(file, {}, [&](const TraceSet&) { return std::vector{index}; });
  fuzz::require(set.traces.at(index).has_samples == trace.has_samples);
  fuzz::require(same_bits(set.traces[index].values, trace.values));
}

void read(const io::Reader& reader, const io::InputFile& file) {
  if (!reader.detects(file)) return;
  const TraceSet set = reader.read(file, {}, all_of);
  fuzz::check_traces(set);
  if (!set.traces.empty() && set.warnings.empty()) check_alone(reader, file, set.traces.back(), set.traces.size() - 1);
  fuzz::check_traces(reader.read(file, {.channels = {}, .columns = "", .units = "t-mm-s"}, all_of));
}

}  // namespace
}  // namespace crashsim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crashsim::io;
  const InputFile file("input", std::string(reinterpret_cast<const char*>(data), size));
  const crashsim::fuzz::MemoryLimit limit(size);
  try {
    crashsim::read(CRASHSIM_FUZZED_READER, file);
  } catch (const crashsim::InvalidInput&) {
  }
  return 0;
}
