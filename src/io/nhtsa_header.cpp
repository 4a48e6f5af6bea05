#include "io/nhtsa_header.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <crashsim/units.hpp>

#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::string_view kMark = "----- EV5 -----";
constexpr std::string_view kSectionMark = "-----";
constexpr double kKmh = 1.0 / 3.6;

/// Positions of fields in their records.
namespace test {
constexpr std::size_t kTitle = 1, kClosingSpeed = 14, kImpactAngle = 15, kOffset = 16, kChannels = 18;
}
namespace vehicle {
constexpr std::size_t kNumber = 0, kTestMass = 10, kSpeed = 41, kFields = 81;
}
namespace barrier {
constexpr std::size_t kRigidity = 0;
}
namespace channel {
constexpr std::size_t kVehicle = 0, kCurve = 1, kSensor = 2, kOccupant = 3, kAttachment = 4, kAxis = 5, kXUnit = 6,
                      kYUnit = 7, kInitialSpeed = 13, kFirst = 14, kLast = 15, kStep = 16, kDataStatus = 17,
                      kChannelStatus = 18, kComment = 19;
}

/// The fields of one line, and where it stands for messages.
struct Record {
  std::vector<std::string_view> fields;
  std::string where;  // "path:line"

  [[nodiscard]] std::string text(std::size_t i) const {
    return i < fields.size() ? std::string(trimmed(fields[i])) : std::string();
  }
  /// A number; unset when the field is empty.
  [[nodiscard]] double number(std::size_t i, std::string_view name) const {
    const std::string value = text(i);
    if (value.empty()) return kUnset;
    if (const auto parsed = parse_number(value)) return *parsed;
    throw InvalidInput(fmt::format("{}: {} = '{}' is not a number", where, name, value));
  }
  /// A number that a channel cannot do without.
  [[nodiscard]] long needed_integer(std::size_t i, std::string_view name) const {
    constexpr double kLargest = 1e9;
    const double value = number(i, name);
    if (!(std::abs(value) <= kLargest) || value != std::floor(value))
      throw InvalidInput(fmt::format("{}: {} = '{}': must be a whole number", where, name, text(i)));
    return static_cast<long>(value);
  }
  /// A speed in km/h where 0 means that nobody filled it in.
  [[nodiscard]] double speed_mps(std::size_t i, std::string_view name) const {
    const double kmh = number(i, name);
    return kmh == 0.0 ? kUnset : kmh * kKmh;
  }
};

NhtsaVehicle parse_vehicle(const Record& r) {
  NhtsaVehicle v;
  v.number = static_cast<int>(r.needed_integer(vehicle::kNumber, "VEHNO"));
  const double mass_kg = r.number(vehicle::kTestMass, "VEHTWT");
  if (mass_kg > 0.0) v.mass_kg = mass_kg;
  if (r.fields.size() == vehicle::kFields) v.speed_mps = r.speed_mps(vehicle::kSpeed, "VEHSPD");
  return v;
}

NhtsaChannel parse_channel(const Record& r) {
  if (r.fields.size() < channel::kComment)
    throw InvalidInput(
        fmt::format("{}: {} fields in an INSTRUMENTATION record: 20 are expected", r.where, r.fields.size()));
  NhtsaChannel c;
  c.vehicle = static_cast<int>(r.needed_integer(channel::kVehicle, "VEHNO"));
  c.curve = static_cast<int>(r.needed_integer(channel::kCurve, "CURNO"));
  c.sensor = r.text(channel::kSensor);
  c.occupant = r.text(channel::kOccupant);
  c.attachment = r.text(channel::kAttachment);
  c.axis = r.text(channel::kAxis);
  c.x_unit = r.text(channel::kXUnit);
  c.y_unit = r.text(channel::kYUnit);
  c.initial_speed_mps = r.speed_mps(channel::kInitialSpeed, "INIVEL");
  c.first = r.needed_integer(channel::kFirst, "NFP");
  c.last = r.needed_integer(channel::kLast, "NLP");
  c.step_us = r.number(channel::kStep, "DELT");
  if (!(c.step_us > 0.0))
    throw InvalidInput(fmt::format("{}: DELT = '{}': must be > 0", r.where, r.text(channel::kStep)));
  c.data_status = r.text(channel::kDataStatus);
  c.channel_status = r.text(channel::kChannelStatus);
  c.comment = r.text(channel::kComment);
  for (std::size_t i = channel::kComment + 1; i < r.fields.size(); ++i)
    c.comment = fmt::format("{}|{}", c.comment, r.text(i));
  return c;
}

/// The axis that a comment ends with, as in "BARRIER K-01 Mz" or "DRIVER HEAD XR"; ' ' when it ends otherwise.
char axis_in_words(std::string_view comment) {
  std::string word = to_lower(comment.substr(comment.find_last_of(' ') + 1));
  if (word.size() > 1 && word.back() == 'r') word.pop_back();  // redundant
  if (word.size() == 2 && (word.front() == 'f' || word.front() == 'm')) word.erase(0, 1);
  return word.size() == 1 && word.front() >= 'x' && word.front() <= 'z' ? word.front() : ' ';
}

/// Real headers label some channels with the axis of their neighbour.
std::string doubt_of_axis(const NhtsaChannel& c, const std::string& where) {
  const char said = axis_in_words(c.comment);
  if (said == ' ' || c.axis.empty() || lower(c.axis.front()) == said || lower(c.axis.front()) < 'x' ||
      lower(c.axis.front()) > 'z')
    return {};
  return fmt::format("{}: channel {} '{}' has AXIS {}: one of them is wrong, AXIS is used", where, c.curve, c.comment,
                     c.axis);
}

void parse_test(const Record& r, NhtsaHeader& header) {
  if (!header.title.empty()) return;
  header.title = r.text(test::kTitle);
  header.closing_speed_mps = r.speed_mps(test::kClosingSpeed, "CLSSPD");
  const double angle_deg = r.number(test::kImpactAngle, "IMPANG"), offset_mm = r.number(test::kOffset, "OFFSET");
  if (!std::isnan(angle_deg)) header.impact_angle_deg = angle_deg;
  if (!std::isnan(offset_mm)) header.offset_mm = offset_mm;
  if (const auto channels = parse_number(r.text(test::kChannels)); channels && *channels >= 0.0 && *channels < 1e9)
    header.declared_channels = static_cast<long>(*channels);
}

void parse_record(std::string_view section, const Record& record, NhtsaHeader& header) {
  if (section == "TEST") parse_test(record, header);
  if (section == "VEHICLE") header.vehicles.push_back(parse_vehicle(record));
  if (section == "BARRIER") header.barrier_rigidity = record.text(barrier::kRigidity);
  if (section == "INSTRUMENTATION") {
    header.channels.push_back(parse_channel(record));
    NhtsaChannel& channel = header.channels.back();
    channel.doubt = doubt_of_axis(channel, record.where);
  }
  append_nhtsa_fields(section, record.fields, header.metadata);
}

/// The name between the dashes of "----- TEST -----".
std::string_view section_name(std::string_view line) {
  line.remove_prefix(kSectionMark.size());
  return trimmed(line.substr(0, line.find('-')));
}

void warn_of_what_is_missing(bool has_end, const std::string& path, NhtsaHeader& header) {
  if (!has_end)
    header.warnings.push_back(fmt::format("{}: the header is cut short: its END is missing, {} channels are known",
                                          path, header.channels.size()));
  if (header.declared_channels >= 0 && header.declared_channels != std::ssize(header.channels))
    header.warnings.push_back(fmt::format("{}: TOTCRV promises {} channels, the header describes {}", path,
                                          header.declared_channels, header.channels.size()));
}

}  // namespace

bool is_nhtsa_header(std::string_view text) {
  constexpr std::size_t kHead = 8192;
  return text.substr(0, kHead).find(kMark) != std::string_view::npos;
}

NhtsaHeader parse_nhtsa_header(std::string_view text, const std::string& path) {
  NhtsaHeader header;
  std::string_view section;
  bool has_end = false;
  std::size_t number = 1;
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1, ++number) {
    end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    if (line.empty() || line.starts_with('#')) continue;
    if (line.starts_with(kSectionMark)) {
      section = section_name(line);
      has_end = has_end || section == "END";
      continue;
    }
    if (end == text.size()) {
      header.warnings.push_back(fmt::format("{}:{}: the last record is cut short: left out", path, number));
      continue;
    }
    parse_record(section, {split(line, '|'), fmt::format("{}:{}", path, number)}, header);
  }
  if (header.channels.empty())
    throw InvalidInput(fmt::format("{}: no INSTRUMENTATION records: the header is truncated", path));
  warn_of_what_is_missing(has_end, path, header);
  return header;
}

}  // namespace crashsim::io
