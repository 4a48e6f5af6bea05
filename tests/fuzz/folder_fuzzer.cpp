/// libFuzzer target of a reader whose tests are several files, CRASHSIM_FUZZED_READER. The input is those files one
/// after the other, each after a line "==== name"; the first is the one that is read.

#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>

#include <unistd.h>

#include <crashsim/error.hpp>

#include "fuzz_memory.hpp"
#include "io/reader.hpp"
#include "text.hpp"
#include "trace_rules.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = "==== ";
constexpr std::size_t kMostFiles = 8;

/// A folder of this process, in memory where the system has such a place.
const fs::path& folder() {
  static const fs::path path = [] {
    const fs::path shared_memory = "/dev/shm";
    const fs::path root = fs::exists(shared_memory) ? shared_memory : fs::temp_directory_path();
    const fs::path own = root / ("crashsim-fuzz-" + std::to_string(::getpid()));
    fs::create_directories(own);
    std::atexit([] { fs::remove_all(folder()); });
    return own;
  }();
  return path;
}

/// A name that stays in the folder; one subfolder, as ISO-MME has, is kept.
std::string safe_name(std::string_view name) {
  const bool in_channel = name.starts_with("Channel/");
  std::string safe;
  for (const char c : name.substr(in_channel ? 8 : 0, 40))
    if (std::isalnum(static_cast<unsigned char>(c)) || (c == '.' && !safe.empty())) safe += c;
  if (safe.empty()) safe = "x";
  return (in_channel ? "Channel/" : "") + safe;
}

void write(const std::string& name, std::string_view bytes) {
  std::ofstream(folder() / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Writes the files of an input. @returns the first one's path, "" when there is none.
std::string write_files(std::string_view input) {
  fs::remove_all(folder());
  fs::create_directories(folder() / "Channel");
  std::string first;
  std::size_t count = 0;
  while (input.starts_with(kMark) && count++ < kMostFiles) {
    const std::size_t end_of_name = input.find('\n');
    if (end_of_name == std::string_view::npos) break;
    const std::string name = safe_name(input.substr(kMark.size(), end_of_name - kMark.size()));
    input.remove_prefix(end_of_name + 1);
    const std::size_t next = input.find("\n==== ");
    write(name, input.substr(0, next == std::string_view::npos ? next : next + 1));
    input.remove_prefix(next == std::string_view::npos ? input.size() : next + 1);
    if (first.empty()) first = (folder() / name).string();
  }
  return first;
}

void read(const io::Reader& reader, const io::InputFile& file) {
  if (!reader.detects(file)) return;
  const TraceSet set = reader.read(file, {}, [](const TraceSet& catalogue) {
    std::vector<std::size_t> all(catalogue.traces.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  });
  fuzz::check_traces(set);
}

}  // namespace
}  // namespace crashsim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crashsim::io;
  const std::string first = crashsim::write_files({reinterpret_cast<const char*>(data), size});
  if (first.empty()) return 0;
  const crashsim::fuzz::MemoryLimit limit(size);
  try {
    crashsim::read(CRASHSIM_FUZZED_READER, InputFile(first));
  } catch (const crashsim::InvalidInput&) {
  }
  return 0;
}
