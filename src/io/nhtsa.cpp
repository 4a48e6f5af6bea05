/// NHTSA vehicle crash tests: a header vNNNNN.EV5 and one file a channel beside it, vNNNNN.001 and so on.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "io/nhtsa_compartment.hpp"
#include "io/nhtsa_header.hpp"
#include "io/nhtsa_samples.hpp"
#include "io/nhtsa_status.hpp"
#include "io/reader.hpp"
#include "io/test_files.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTabSeparated = "tsv";  // "v10146tsv.093": a channel file of the tab-separated export

/// The test that a file belongs to, lower-case: "v10146".
std::string test_name(const std::string& path) {
  std::string stem = stem_of(path);
  if (stem.size() > kTabSeparated.size() && stem.ends_with(kTabSeparated))
    stem.resize(stem.size() - kTabSeparated.size());
  return stem;
}

/// The header beside a channel file, "" when there is none.
std::string header_beside(const std::string& path) {
  if (channel_number(path) == 0) return "";
  const auto files = files_in(fs::path(path).parent_path());
  const auto found = files.find(test_name(path) + ".ev5");
  return found == files.end() ? "" : found->second;
}

Trace describe(const NhtsaChannel& c) {
  Trace trace;
  trace.id = std::to_string(c.curve);
  trace.name = c.comment.empty() ? fmt::format("{} {} {}", c.sensor, c.attachment, c.axis) : c.comment;
  trace.location = c.attachment;
  if (!c.axis.empty() && std::string_view("XYZ").find(c.axis[0]) != std::string_view::npos) trace.axis = c.axis[0];
  trace.source_unit = c.y_unit;
  if (const auto unit = find_unit(c.y_unit)) trace.dimension = unit->dimension;
  trace.problem = nhtsa_status(c.data_status, "DASTAT").problem;
  const auto x_unit = find_unit(c.x_unit);
  if (trace.problem.empty() && !c.x_unit.empty() && (!x_unit || x_unit->dimension != Dimension::time))
    trace.problem = fmt::format("its x is in {}, not a time", c.x_unit);
  trace.has_samples = false;
  return trace;
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
  for (const NhtsaChannel& c : header.channels)
    if (!nhtsa_status(c.data_status, "").is_known)
      warn(fmt::format("channel {}: DASTAT {} is not known: its data are taken as good", c.curve, c.data_status));
}

/// A test with every channel described, and the file of each.
struct Test {
  NhtsaHeader header;
  std::vector<std::string> files;  ///< "" where there is none.
  TraceSet set;
};

Test open_test(const std::string& header_path, std::string_view text) {
  Test test;
  test.header = parse_nhtsa_header(text, header_path);
  test.set.path = header_path;
  test.set.input_files = {header_path};
  test.set.metadata = std::move(test.header.metadata);
  test.set.warnings = std::move(test.header.warnings);
  const auto beside = files_in(fs::path(header_path).parent_path());
  std::vector<bool> good, usable;  // by the header; and with a file
  for (const NhtsaChannel& c : test.header.channels) {
    const std::string name = fmt::format("{}.{:03}", test_name(header_path), c.curve);
    auto found = beside.find(name);
    if (found == beside.end())
      found = beside.find(fmt::format("{}{}.{:03}", test_name(header_path), kTabSeparated, c.curve));
    test.files.push_back(found == beside.end() ? "" : found->second);
    Trace trace = describe(c);
    good.push_back(trace.problem.empty());
    if (found == beside.end() && trace.problem.empty())
      trace.problem = fmt::format("its file {} is not beside the header", name);
    usable.push_back(trace.problem.empty());
    test.set.traces.push_back(std::move(trace));
  }
  const auto compartment = choose_compartment(compartment_channels(test.header, good),
                                              compartment_channels(test.header, usable), usable, test.set);
  for (const std::size_t i : compartment) test.set.compartment_x.push_back(test.set.traces[i].id);
  describe_test(test.header, compartment, test.set);
  return test;
}

/// Leaves only the channel of one file, which then is the one to use.
void keep_only(Test& test, const std::string& channel_path) {
  const int curve = channel_number(channel_path);
  const auto& channels = test.header.channels;
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.curve == curve; });
  if (found == channels.end())
    throw InvalidInput(fmt::format("{}: its header {} lists no channel {}", channel_path, test.set.path, curve));
  const auto i = static_cast<std::size_t>(found - channels.begin());
  test.set.path = channel_path;
  test.set.traces = {test.set.traces[i]};
  test.set.compartment_x = {test.set.traces.front().id};
  test.files = {channel_path};
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
  NhtsaClocks clocks;
  for (const std::size_t i : choose(test.set)) {
    const NhtsaChannel& channel = test.header.channels[i];
    if (!channel.doubt.empty()) test.set.warnings.push_back(channel.doubt);
    if (!test.files[i].empty()) read_nhtsa_samples(channel, test.files[i], clocks, test.set.traces[i], test.set);
  }
  return std::move(test.set);
}

}  // namespace

const Reader kNhtsaReader = {"nhtsa_ev5", "NHTSA EV5 (header vNNNNN.EV5 or channel file vNNNNN.001)", detects, read};

}  // namespace crashsim::io
