#include "io/iso_mme_test.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <crashsim/units.hpp>

#include "io/iso_mme_code.hpp"
#include "io/test_files.hpp"
#include "number.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr double kFastestImpact_mps = 30.0;  // 108 km/h

void add_metadata(const std::string& prefix, const IsoMmeHeader& header, TraceSet& set) {
  for (const IsoMmeLine& line : header.lines)
    if (!is_no_value(line.value)) set.metadata.emplace_back(fmt::format("{}.{}", prefix, line.name), line.value);
}

/// The number at the end of "Name of channel 001"; 0 when it is another line.
int listed_number(const IsoMmeLine& line) {
  constexpr std::string_view kListed = "name of channel ";
  if (!to_lower(line.name).starts_with(kListed)) return 0;
  const std::string_view digits = std::string_view(line.name).substr(kListed.size());
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && end == digits.data() + digits.size() && number > 0 ? number : 0;
}

/// "11HEADCG0000ACXP / Head X" in two.
std::pair<std::string, std::string> code_and_name(const std::string& listed) {
  const std::size_t slash = std::min(listed.find('/'), listed.size());
  const std::string_view code = trimmed(std::string_view(listed).substr(0, slash));
  const std::string_view name = trimmed(std::string_view(listed).substr(std::min(slash + 1, listed.size())));
  return {std::string(code.substr(0, code.find(' '))), std::string(name)};
}

void read_list(const InputFile& opened, const IsoMmeFiles& files, std::map<int, IsoMmeChannelFile>& channels,
               TraceSet& set) {
  if (files.list.empty()) return;
  const IsoMmeHeader list = with_bytes(
      opened, files.list, [&](std::string_view bytes) { return parse_iso_mme_header(bytes, files.list, false); });
  set.input_files.push_back(files.list);
  add_metadata("CHN", list, set);
  std::size_t listed = 0;
  for (const IsoMmeLine& line : list.lines) {
    const int number = listed_number(line);
    if (number == 0) continue;
    ++listed;
    if (!is_no_value(line.value)) channels[number].listed = line.value;
  }
  const double declared = list.number("Number of channels");
  if (declared > static_cast<double>(listed))
    set.warnings.push_back(
        fmt::format("{}: lists {} of the {} channels that it declares", files.list, listed, declared));
}

std::string_view first_said(const IsoMmeHeader& header, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    if (const std::string_view value = header.value(name); !value.empty()) return value;
  return "";
}

/// Sets dimension and unit. A unit that does not fit the code's dimension is believed, with a warning.
void describe_unit(const IsoMmeChannelFile& channel, std::string_view code, Trace& trace, TraceSet& set) {
  const std::string_view unit = channel.header.value("Unit");
  const Dimension expected = iso_mme_dimension(code);
  trace.source_unit = std::string(unit);
  if (channel.path.empty()) trace.dimension = expected;
  if (unit.empty()) return;
  if (expected != Dimension::unknown && find_unit(unit, expected)) {
    trace.dimension = expected;
    return;
  }
  const auto other = find_unit(unit);
  if (!other) return;
  trace.dimension = other->dimension;
  if (expected != Dimension::unknown && expected != Dimension::none)
    set.warnings.push_back(fmt::format("{}: its unit '{}' measures {}, its code {} says {}: the unit is believed",
                                       channel.path, unit, dimension_name(other->dimension), code,
                                       dimension_name(expected)));
}

/// Sets the axis: what the header says, else the code.
void describe_axis(const IsoMmeChannelFile& channel, std::string_view code, Trace& trace, TraceSet& set) {
  const std::string_view direction = channel.header.value("Direction");
  const char of_code = iso_mme_axis(code);
  const bool said = direction.size() == 1 && std::string_view("XYZ").find(direction[0]) != std::string_view::npos;
  trace.axis = said ? direction[0] : of_code;
  if (said && of_code != ' ' && of_code != trace.axis)
    set.warnings.push_back(
        fmt::format("{}: its header says direction {}, its code {} says {}", channel.path, direction, code, of_code));
  if (of_code != ' ' && is_digit(code[14]))
    set.warnings.push_back(
        fmt::format("{}: the sign of {} is not that of SAE J211, by its direction {}", channel.path, code, code[14]));
}

/// Why a channel must not be used, by its "Data status"; "" when there is no reason.
std::string problem_of(std::string_view status) {
  constexpr std::string_view kGood[] = {
      "ok", "o.k.", "good", "valid", "scaling factor applied", "linearised data", "linearized data"};
  const bool good = is_no_value(status) || std::any_of(std::begin(kGood), std::end(kGood), [&](std::string_view word) {
                      return same_ignoring_case(word, status);
                    });
  return good ? "" : fmt::format("its source says: {} (Data status)", status);
}

Trace describe(const IsoMmeChannelFile& channel, TraceSet& set) {
  const auto [listed_code, listed_name] = code_and_name(channel.listed);
  const std::string_view said =
      first_said(channel.header, {"Channel code", "Customer channel code", "Laboratory channel code"});
  const std::string_view code = said.empty() ? std::string_view(listed_code) : said;
  if (!said.empty() && !listed_code.empty() && !same_ignoring_case(said, listed_code))
    set.warnings.push_back(fmt::format("{}: calls itself {}, the list of channels calls it {}: its own name is taken",
                                       channel.path, said, listed_code));
  Trace trace;
  trace.id = code.empty() ? fmt::format("{:03}", channel.number) : std::string(code);
  const std::string_view name = channel.header.value("Name of the channel");
  trace.name = !name.empty() ? std::string(name) : (listed_name.empty() ? trace.id : listed_name);
  const std::string_view location = channel.header.value("Location");
  trace.location = location.empty() || is_iso_mme_code(location) ? iso_mme_location(code) : std::string(location);
  describe_unit(channel, code, trace, set);
  describe_axis(channel, code, trace, set);
  trace.problem = channel.path.empty() ? fmt::format("its file .{:03} is not there", channel.number)
                                       : problem_of(channel.header.value("Data status"));
  trace.has_samples = false;
  return trace;
}

/// Reads a channel's header; the trace of one that cannot be read says why.
void add_channel(const InputFile& opened, IsoMmeChannelFile channel, IsoMmeCatalogue& catalogue) {
  std::string problem;
  if (!channel.path.empty()) try {
      channel.header = with_bytes(opened, channel.path, [&](std::string_view bytes) {
        return parse_iso_mme_header(bytes, channel.path, true);
      });
      catalogue.set.input_files.push_back(channel.path);
      add_metadata(fmt::format("{:03}", channel.number), channel.header, catalogue.set);
    } catch (const InvalidInput& error) {
      problem = error.what();
    }
  Trace trace = describe(channel, catalogue.set);
  if (!problem.empty()) trace.problem = problem;
  catalogue.set.traces.push_back(std::move(trace));
  catalogue.channels.push_back(std::move(channel));
}

/// Codes that several channels have get "#2" and so on.
void make_ids_unique(TraceSet& set) {
  std::map<std::string, int> seen;
  for (Trace& trace : set.traces) {
    const std::string code = trace.id;
    for (int count = ++seen[code]; count > 1; count = ++seen[trace.id]) trace.id = fmt::format("{}#{}", code, count);
  }
}

/// A quantity of TEST.mme in SI: bare numbers are SI. Unset when it is absent, zero or not understood; the latter
/// warns.
double quantity_of(const IsoMmeHeader& test, std::initializer_list<std::string> names, Dimension dimension,
                   TraceSet& set) {
  for (const IsoMmeLine& line : test.lines) {
    const bool meant = std::any_of(names.begin(), names.end(),
                                   [&](const std::string& name) { return same_ignoring_case(name, line.name); });
    if (!meant || is_no_value(line.value)) continue;
    double value = kUnset;
    const char* const begin = line.value.data();
    const char* const end = begin + line.value.size();
    const char* const after = scan_number(begin, end, value);
    const std::string_view unit = trimmed({after, static_cast<std::size_t>(end - after)});
    const auto known = unit.empty() ? Unit{"", dimension, 1.0} : find_unit(unit, dimension);
    if (value == 0.0) continue;
    const bool too_fast = dimension == Dimension::speed && unit.empty() && std::abs(value) > kFastestImpact_mps;
    if (line.whole && after != begin && known && std::isfinite(value) && !too_fast)
      return std::abs(value) * known->to_si;
    set.warnings.push_back(
        fmt::format("{}: {} = '{}' is not taken: {}; give it yourself", set.path, line.name, line.value,
                    !line.whole ? "the file ends within it"
                                : (too_fast ? "no vehicle is that fast in m/s" : "not a number and unit")));
  }
  return kUnset;
}

/// The number of the test object whose mass and speed count: the one the compartment's channels are on.
int test_object(const IsoMmeCatalogue& catalogue, const std::vector<std::size_t>& compartment) {
  if (compartment.empty()) return 1;
  const std::size_t i = compartment.front();
  const double said = catalogue.channels[i].header.number("Test object number");
  if (said >= 1.0 && said <= 99.0) return static_cast<int>(said);
  const char object = catalogue.set.traces[i].id.front();
  return object >= '1' && object <= '9' ? object - '0' : 1;
}

void describe_test(const IsoMmeHeader& test, const std::vector<std::size_t>& compartment, IsoMmeCatalogue& catalogue) {
  TraceSet& set = catalogue.set;
  const int object = test_object(catalogue, compartment);
  set.title = std::string(first_said(test, {"Title", "Type of the test", "Test type"}));
  set.mass_kg = quantity_of(test, {fmt::format("Mass test object {}", object)}, Dimension::mass, set);
  const std::string speed = fmt::format("Velocity test object {}", object);
  set.impact_speed_mps =
      quantity_of(test, {speed, speed + " lon.", speed + " lon", fmt::format("Velocity lon test object {}", object)},
                  Dimension::speed, set);
  if (std::isnan(set.impact_speed_mps))
    set.impact_speed_mps = quantity_of(test, {"Impact velocity"}, Dimension::speed, set);
  if (test.number("Number of test objects") > 1.0 && !(std::isnan(set.mass_kg) && std::isnan(set.impact_speed_mps)))
    set.warnings.push_back(
        fmt::format("{}: several test objects: mass and speed are those of test object {}", set.path, object));
}

/// Adds the channel that the only one takes its times from, if it names one, without a trace.
void add_time_channel(const std::string& only, std::map<int, IsoMmeChannelFile>& channels, IsoMmeCatalogue& catalogue) {
  const std::string reference(catalogue.channels.front().header.value("Reference channel name"));
  if (reference.empty()) return;
  for (auto& [number, channel] : channels) {
    if (channel.path.empty() || channel.path == only) continue;
    const InputFile file(channel.path);
    channel.header = parse_iso_mme_header(file.bytes(), channel.path, true);
    if (!same_ignoring_case(channel.header.value("Channel code"), reference)) continue;
    catalogue.set.input_files.push_back(channel.path);
    catalogue.channels.push_back(std::move(channel));
    return;
  }
}

void add_channels(const InputFile& opened, const IsoMmeFiles& files, IsoMmeCatalogue& catalogue) {
  std::map<int, IsoMmeChannelFile> channels;
  for (const auto& [number, path] : files.channels) channels[number].path = path;
  read_list(opened, files, channels, catalogue.set);
  for (auto& [number, channel] : channels) {
    channel.number = number;
    if (files.only.empty() || channel.path == files.only) add_channel(opened, channel, catalogue);
  }
  if (catalogue.channels.empty())
    throw InvalidInput(
        fmt::format("{}: no channel files (.001, ..) are beside it or in a folder Channel", catalogue.set.path));
  make_ids_unique(catalogue.set);
  if (!files.only.empty()) add_time_channel(files.only, channels, catalogue);
}

/// The channels to use by default: the compartment's, or the only one.
std::vector<std::size_t> default_channels_of(IsoMmeCatalogue& catalogue, bool only) {
  TraceSet& set = catalogue.set;
  if (only) return {0};
  std::vector<bool> good, usable;
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    usable.push_back(set.traces[i].problem.empty());
    good.push_back(usable.back() || catalogue.channels[i].path.empty());
  }
  return choose_compartment(iso_mme_compartment(set, good), iso_mme_compartment(set, usable), usable, set);
}

}  // namespace

IsoMmeCatalogue catalogue_iso_mme(const InputFile& opened, const IsoMmeFiles& files) {
  IsoMmeCatalogue catalogue;
  TraceSet& set = catalogue.set;
  set.path = opened.path();
  IsoMmeHeader test;
  if (!files.test.empty()) {
    test = with_bytes(opened, files.test,
                      [&](std::string_view bytes) { return parse_iso_mme_header(bytes, files.test, false); });
    set.input_files.push_back(files.test);
    add_metadata("MME", test, set);
  }
  add_channels(opened, files, catalogue);
  const auto compartment = default_channels_of(catalogue, !files.only.empty());
  for (const std::size_t i : compartment) set.compartment_x.push_back(set.traces[i].id);
  describe_test(test, compartment, catalogue);
  return catalogue;
}

}  // namespace crashsim::io
