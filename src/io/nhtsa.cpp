/// NHTSA vehicle crash tests: a header vNNNNN.EV5 and one file a channel beside it, vNNNNN.001 and so on.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

#include <fmt/format.h>

#include "io/nhtsa_compartment.hpp"
#include "io/nhtsa_header.hpp"
#include "io/reader.hpp"
#include "number.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

namespace fs = std::filesystem;

constexpr double kTimeRounding_s = 1e-6;  // files print times with six decimals

/// Names of the files in a folder by their lower-case spelling.
std::map<std::string, std::string> files_beside(const std::string& path) {
  std::map<std::string, std::string> files;
  const fs::path folder = fs::path(path).parent_path();
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const std::string name = entry.path().filename().string();
    files.emplace(to_lower(name), (folder / name).string());
  }
  return files;
}

/// The test's name without extension, lower-case: "v10146".
std::string stem_of(const std::string& path) { return to_lower(fs::path(path).stem().string()); }

/// The curve number of a channel file's name, 0 when it is none: "v10146.093" is 93.
int curve_of(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  const bool digits =
      extension.size() >= 4 && extension.size() <= 6 && std::all_of(extension.begin() + 1, extension.end(), is_digit);
  return digits ? std::stoi(extension.substr(1)) : 0;
}

/// The header beside a channel file, "" when there is none.
std::string header_beside(const std::string& path) {
  if (curve_of(path) == 0) return "";
  const auto files = files_beside(path);
  const auto found = files.find(stem_of(path) + ".ev5");
  return found == files.end() ? "" : found->second;
}

std::string problem_of(const NhtsaChannel& c) {
  if (c.data_status == "NO") return "no data were recorded (DASTAT NO)";
  if (c.data_status == "CF") return "its source says that the channel failed (DASTAT CF)";
  if (c.data_status == "QD") return "its source says that the data are questionable (DASTAT QD)";
  return "";
}

Trace describe(const NhtsaChannel& c) {
  Trace trace;
  trace.id = std::to_string(c.curve);
  trace.name = c.comment.empty() ? fmt::format("{} {} {}", c.sensor, c.attachment, c.axis) : c.comment;
  trace.location = c.attachment;
  if (!c.axis.empty() && std::string_view("XYZ").find(c.axis[0]) != std::string_view::npos) trace.axis = c.axis[0];
  trace.source_unit = c.y_unit;
  if (const auto unit = find_unit(c.y_unit)) trace.dimension = unit->dimension;
  trace.problem = problem_of(c);
  trace.has_samples = false;
  return trace;
}

/// The rows of a channel file.
struct Rows {
  std::vector<double> times, values;  ///< As in the file; no times when it has one value a line.
  std::string problem;                ///< What is wrong with the file, "" when nothing is.
};

const char* skip_blanks(const char* p, const char* end) {
  while (p != end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == ',')) ++p;
  return p;
}

Rows parse_rows(std::string_view text, const std::string& path) {
  Rows rows;
  const char* p = text.data();
  const char* const end = p + text.size();
  for (std::size_t line = 1; p != end; ++line) {
    p = skip_blanks(p, end);
    if (p != end && *p != '\n') {
      double numbers[2] = {};
      std::size_t count = 0;
      for (; count < 2 && p != end && *p != '\n'; ++count) {
        const char* const after = scan_number(p, end, numbers[count]);
        if (after == p) break;
        p = skip_blanks(after, end);
      }
      const bool like_the_others = rows.values.empty() || (count == 2) == !rows.times.empty();
      if (count == 0 || (p != end && *p != '\n') || !like_the_others) {
        const auto at = static_cast<std::size_t>(p - text.data());
        rows.problem = fmt::format("{}:{}: '{}' is not a sample", path, line,
                                   trimmed(text.substr(at, std::min(text.find('\n', at) - at, std::size_t{40}))));
        return rows;
      }
      if (count == 2) rows.times.push_back(numbers[0]);
      rows.values.push_back(numbers[count - 1]);
    }
    if (p != end) ++p;
  }
  if (rows.values.empty()) rows.problem = fmt::format("{}: the file is empty", path);
  return rows;
}

/// Sample times by the header, shared between channels of one clock.
class Clocks {
 public:
  std::shared_ptr<const std::vector<double>> of(const NhtsaChannel& c, std::size_t count) {
    auto& clock = clocks_[{c.first, count, c.step_us}];
    if (clock) return clock;
    std::vector<double> times(count);
    for (std::size_t i = 0; i < count; ++i)
      times[i] = (static_cast<double>(c.first) + static_cast<double>(i)) * c.step_us / 1e6;
    clock = std::make_shared<const std::vector<double>>(std::move(times));
    return clock;
  }

 private:
  std::map<std::tuple<long, std::size_t, double>, std::shared_ptr<const std::vector<double>>> clocks_;
};

bool agree(const std::vector<double>& a, const std::vector<double>& b, double step_us) {
  const double tolerance_s = std::max(kTimeRounding_s, 0.02 * step_us / 1e6);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](double x, double y) { return std::abs(x - y) <= tolerance_s; });
}

/// Fills in a trace's samples, or why they cannot be had.
void read_samples(const NhtsaChannel& c, const std::string& path, Clocks& clocks, Trace& trace, TraceSet& set) {
  const InputFile file(path);
  Rows rows = parse_rows(file.bytes(), path);
  set.input_files.push_back(path);
  if (!rows.problem.empty()) {
    trace.problem = rows.problem;
    return;
  }
  const long declared = c.last - c.first + 1;
  if (trace.problem.empty() && std::ssize(rows.values) < declared)
    trace.problem =
        fmt::format("{}: truncated: {} of the {} samples that its header declares", path, rows.values.size(), declared);
  trace.time_s = clocks.of(c, rows.values.size());
  if (!rows.times.empty() && !agree(rows.times, *trace.time_s, c.step_us)) {
    set.warnings.push_back(
        fmt::format("{}: times in the file differ from those of its header; the file's are used", path));
    trace.time_s = std::make_shared<const std::vector<double>>(std::move(rows.times));
  }
  const auto unit = find_unit(c.y_unit);
  if (unit && unit->to_si != 1.0)
    for (double& value : rows.values) value *= unit->to_si;
  trace.values = std::move(rows.values);
  trace.has_samples = true;
}

/// Mass, speed and what a careful reader should know of a test.
void describe_test(const NhtsaHeader& header, const std::vector<std::size_t>& compartment, TraceSet& set) {
  set.title = header.title;
  if (!header.vehicles.empty()) {
    set.mass_kg = header.vehicles.front().mass_kg;
    set.impact_speed_mps = header.vehicles.front().speed_mps;
  }
  if (std::isnan(set.impact_speed_mps) && !compartment.empty())
    set.impact_speed_mps = header.channels[compartment.front()].initial_speed_mps;
  if (std::isnan(set.impact_speed_mps) && header.vehicles.size() < 2) set.impact_speed_mps = header.closing_speed_mps;

  const auto warn = [&](const std::string& text) { set.warnings.push_back(fmt::format("{}: {}", set.path, text)); };
  if (header.vehicles.size() > 1)
    warn(fmt::format("{} vehicles: mass and speed are those of vehicle {}, and the speed may be the closing speed",
                     header.vehicles.size(), header.vehicles.front().number));
  if (header.barrier_rigidity == "D") warn("the barrier is deformable: its deformation is part of what is measured");
  if (header.impact_angle_deg != 0.0)
    warn(fmt::format("impact angle {:g} degrees: not full frontal", header.impact_angle_deg));
  if (header.offset_mm != 0.0) warn(fmt::format("offset {:g} mm: not full frontal", header.offset_mm));
}

/// A test with every channel described, and the file of each.
struct Test {
  NhtsaHeader header;
  std::vector<std::string> files;  ///< "" where there is none.
  TraceSet set;
};

/// The compartment's channels: those with files, else those the header names.
std::vector<std::size_t> choose_compartment(const NhtsaHeader& header, const std::vector<bool>& good,
                                            const std::vector<bool>& usable, TraceSet& set) {
  auto wanted = compartment_channels(header, good);
  auto present = compartment_channels(header, usable);
  if (present.empty()) return wanted;
  std::string absent;
  for (const std::size_t i : wanted)
    if (!usable[i]) absent += fmt::format("{}{}", absent.empty() ? "" : ", ", set.traces[i].id);
  if (!absent.empty())
    set.warnings.push_back(
        fmt::format("{}: compartment channel {} has no file here: what is taken instead may differ", set.path, absent));
  return present;
}

Test open_test(const std::string& header_path, std::string_view text) {
  Test test;
  test.header = parse_nhtsa_header(text, header_path);
  test.set.path = header_path;
  test.set.input_files = {header_path};
  const auto beside = files_beside(header_path);
  std::vector<bool> good, usable;  // by the header; and with a file
  for (const NhtsaChannel& c : test.header.channels) {
    const std::string name = fmt::format("{}.{:03}", stem_of(header_path), c.curve);
    const auto found = beside.find(name);
    test.files.push_back(found == beside.end() ? "" : found->second);
    Trace trace = describe(c);
    good.push_back(trace.problem.empty());
    if (found == beside.end() && trace.problem.empty())
      trace.problem = fmt::format("its file {} is not beside the header", name);
    usable.push_back(trace.problem.empty());
    test.set.traces.push_back(std::move(trace));
  }
  const auto compartment = choose_compartment(test.header, good, usable, test.set);
  for (const std::size_t i : compartment) test.set.compartment_x.push_back(test.set.traces[i].id);
  describe_test(test.header, compartment, test.set);
  return test;
}

/// Leaves only the channel of one file, which then is the one to use.
void keep_only(Test& test, const std::string& channel_path) {
  const int curve = curve_of(channel_path);
  const auto& channels = test.header.channels;
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.curve == curve; });
  if (found == channels.end())
    throw InvalidInput(fmt::format("{}: its header {} lists no channel {}", channel_path, test.set.path, curve));
  const auto i = static_cast<std::size_t>(found - channels.begin());
  test.set.path = channel_path;
  test.set.traces = {test.set.traces[i]};
  test.set.compartment_x = {test.set.traces.front().id};
  test.files = {test.files[i]};
  test.header.channels = {NhtsaChannel(*found)};
}

bool detects(const InputFile& file) {
  return !file.is_folder() && (is_nhtsa_header(file.bytes()) || !header_beside(file.path()).empty());
}

TraceSet read(const InputFile& file, const ReadOptions&, const Choose& choose) {
  Test test;
  if (is_nhtsa_header(file.bytes())) {
    test = open_test(file.path(), file.bytes());
  } else {
    const InputFile header(header_beside(file.path()));
    test = open_test(header.path(), header.bytes());
    keep_only(test, file.path());
  }
  Clocks clocks;
  for (const std::size_t i : choose(test.set))
    if (!test.files[i].empty())
      read_samples(test.header.channels[i], test.files[i], clocks, test.set.traces[i], test.set);
  return std::move(test.set);
}

}  // namespace

const Reader kNhtsaReader = {"nhtsa_ev5", "NHTSA EV5 (header vNNNNN.EV5 or channel file vNNNNN.001)", detects, read};

}  // namespace crashsim::io
