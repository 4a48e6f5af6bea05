/// Which ISO-MME channel each column of this program's files is.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/iso_mme.hpp>

#include "io/iso_mme_code.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

struct KnownColumn {
  std::string_view column, code;  ///< The code without its filter class.
  double sign = 1.0;              ///< -1 turns the column to the sign of SAE J211.
  std::string_view comment;
};

constexpr std::string_view kUpward = "upward in its source, turned to Z down";
constexpr std::string_view kNoseDown = "nose-down positive in its source, turned to rotation about Y right";
constexpr std::string_view kInternal = "sign of the model: compression positive";
constexpr std::array kColumns = std::to_array<KnownColumn>({
    {"accel_mps2", "10VEHCCG0000ACX", 1.0, ""},
    {"velocity_mps", "10VEHCCG0000VEX", 1.0, ""},
    {"displacement_m", "10VEHCCG0000DSX", 1.0, ""},
    {"crush_m", "10FREN000000DC0", 1.0, "shortening of the front"},
    {"spring_force_n", "10FREN010000FO0", 1.0, kInternal},
    {"damper_force_n", "10FREN020000FO0", 1.0, kInternal},
    {"energy_residual_j", "10VEHC000000EN0", 1.0, "error of the energy balance"},
    {"heave_m", "10VEHCCG0000DSZ", -1.0, kUpward},
    {"heave_velocity_mps", "10VEHCCG0000VEZ", -1.0, kUpward},
    {"heave_accel_mps2", "10VEHCCG0000ACZ", -1.0, kUpward},
    {"pitch_rad", "10VEHCCG0000ANY", -1.0, kNoseDown},
    {"pitch_rate_radps", "10VEHCCG0000AVY", -1.0, kNoseDown},
    {"pitch_accel_radps2", "10VEHCCG0000AAY", -1.0, kNoseDown},
    {"front_deflection_m", "10SUUNFR0000DS0", 1.0, kInternal},
    {"rear_deflection_m", "10SUUNRE0000DS0", 1.0, kInternal},
    {"front_axle_force_n", "10AXLEFR0000FOZ", -1.0,
     "on the body less the static load; upward in its source, turned to Z down"},
    {"rear_axle_force_n", "10AXLERE0000FOZ", -1.0,
     "on the body less the static load; upward in its source, turned to Z down"},
    {"front_axle_load_n", "10AXLEFR0000FOZ", -1.0, "of the ground; upward in its source, turned to Z down"},
    {"rear_axle_load_n", "10AXLERE0000FOZ", -1.0, "of the ground; upward in its source, turned to Z down"},
    {"heave_force_n", "10VEHCCG0000FOZ", -1.0, kUpward},
    {"pitch_moment_nm", "10VEHCCG0000MOY", -1.0, kNoseDown},
    {"longitudinal_force_n", "10FREN000000FOX", -1.0,
     "on the vehicle; positive in its source while it stops it, turned to X forward"},
    {"vertical_force_n", "10FREN000000FOZ", 1.0, "on the vehicle"},
});

/// The filter class by the steps that made a pulse: "filter: CFC60 (j211), forward and backward".
char filter_class(const TraceSet& set) {
  constexpr std::string_view kFilter = "filter: CFC";
  char letter = '0';
  for (const auto& [key, value] : set.metadata) {
    if (key != "step" || !value.starts_with(kFilter)) continue;
    const std::string_view rest = std::string_view(value).substr(kFilter.size());
    letter = io::iso_mme_filter_class(parse_number(rest.substr(0, rest.find(' '))).value_or(kUnset));
  }
  return letter;
}

/// Why a trace cannot be written, "" when it can.
std::string fault_of(const Trace& trace) {
  if (!trace.has_samples)
    return trace.problem.empty() ? "its samples are not there"
                                 : fmt::format("its samples are not there: {}", trace.problem);
  if (io::iso_mme_letters(trace.dimension).empty())
    return fmt::format("ISO-MME has no code for {}", trace.dimension == Dimension::unknown
                                                         ? "what has no known unit"
                                                         : dimension_name(trace.dimension));
  return "";
}

/// A code by what a trace measures: "100000010000ACX0", with a number that tells such channels apart.
std::string code_by_dimension(const Trace& trace, std::size_t number) {
  return fmt::format("100000{:02}{:02}00{}{}0", number / 100 % 100, number % 100, io::iso_mme_letters(trace.dimension),
                     trace.axis == ' ' ? '0' : trace.axis);
}

/// To the sign of SAE J211. The name says so, for a column of its own name has the other sign.
void turn(IsoMmeChannel& channel) {
  channel.name += " (SAE J211 sign)";
  for (double& value : channel.values) value = -value;
}

IsoMmeChannel channel_of(const Trace& trace, std::size_t number, const TraceSet& set) {
  IsoMmeChannel channel;
  channel.name = trace.name;
  channel.dimension = trace.dimension;
  channel.problem = trace.problem;
  channel.time_s = trace.time_s;
  channel.values = trace.values;
  const std::string own = trace.id.substr(0, io::kIsoMmeCodeLength);
  const auto known = std::find_if(kColumns.begin(), kColumns.end(),
                                  [&](const KnownColumn& column) { return column.column == trace.name; });
  if (io::is_iso_mme_code(own)) {
    channel.code = own;
  } else if (known != kColumns.end() && io::iso_mme_dimension(std::string(known->code) + "0") == trace.dimension) {
    channel.code = std::string(known->code) + filter_class(set);
    channel.comment = std::string(known->comment);
    if (known->sign < 0.0) turn(channel);
  } else {
    channel.code = code_by_dimension(trace, number);
  }
  return channel;
}

}  // namespace

std::vector<IsoMmeChannel> iso_mme_channels(const TraceSet& set, std::vector<std::string>& notes) {
  std::vector<IsoMmeChannel> channels;
  std::vector<std::string> left_out;
  for (const Trace& trace : set.traces) {
    const std::string fault = fault_of(trace);
    if (fault.empty())
      channels.push_back(channel_of(trace, channels.size() + 1, set));
    else
      left_out.push_back(fmt::format("channel {} {}: {}", trace.id, trace.name, fault));
  }
  if (channels.empty())
    throw InvalidInput(fmt::format("{}: no channel can be written as ISO-MME{}", set.path,
                                   left_out.empty() ? "" : ": " + left_out.front()));
  for (const std::string& channel : left_out) notes.push_back("left out: " + channel);
  return channels;
}

IsoMmeTest make_iso_mme_test(const TraceSet& set, const std::string& name) {
  constexpr std::string_view kRecord = "record";
  IsoMmeTest test;
  test.name = name;
  test.title = set.title;
  test.mass_kg = set.mass_kg;
  test.impact_speed_mps = set.impact_speed_mps;
  test.channels = iso_mme_channels(set, test.notes);
  const bool simulated = std::any_of(set.traces.begin(), set.traces.end(), [](const Trace& trace) {
    return trace.name == "spring_force_n" || trace.name.starts_with("heave_m");
  });
  if (!simulated) test.data_source = "calculation";
  if (set.format != "csv") return test;
  for (const auto& [key, value] : set.metadata) {
    if (key == kRecord) {
      test.record = value;
    } else {
      test.comments.push_back(fmt::format("{} = {}", key, value));
    }
  }
  return test;
}

}  // namespace crashsim
