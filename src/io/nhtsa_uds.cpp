/// NHTSA's binary signal files, UDS-1992: records of 512 bytes, each with 12 characters that say what it holds.
///
/// A header record (test, vehicle, number format), an optional second component, and for each channel a curve header
/// and records of 125 floats: Y DATA, and for a channel of pairs X DATA. Source: the file definition that comes with
/// NHTSA's own tools (UDS_File.txt, UDS_Vars.txt, Units.txt).

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "io/nhtsa_status.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::size_t kRecord = 512, kMark = 12, kFloats = (kRecord - kMark) / 4;
constexpr std::string_view kVersion = "UDS-1992", kFamily = "UDS-19";
constexpr std::string_view kSecondComponent = "CMP-2 HDR", kCurve = "CURVE HDR", kY = "Y DATA", kX = "X DATA";

/// How numbers are stored: IEEE little-endian, IEEE big-endian ("SUN"), or VAX F-floating.
enum class NumberFormat { ieee, sun, vax };

/// One record of 512 bytes, read field by field.
class Fields {
 public:
  Fields(std::string_view record, NumberFormat format) : rest_(record), format_(format) {}

  std::string_view text(std::size_t length) {
    std::string_view field = rest_.substr(0, length);
    rest_.remove_prefix(field.size());
    while (!field.empty() && (field.back() == '\0' || is_blank(field.back()))) field.remove_suffix(1);
    return trimmed(field);
  }
  std::int32_t integer() { return static_cast<std::int32_t>(word()); }
  double real();
  [[nodiscard]] bool has_word() const { return rest_.size() >= 4; }

 private:
  /// The next four bytes as the bits of a number. Integers of VAX files are little-endian.
  std::uint32_t word() {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4 && i < rest_.size(); ++i) {
      const std::size_t shift = 8 * (format_ == NumberFormat::sun ? 3 - i : i);
      bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(rest_[i])) << shift;
    }
    rest_.remove_prefix(std::min<std::size_t>(4, rest_.size()));
    return bits;
  }

  std::string_view rest_;
  NumberFormat format_;
};

/// VAX F-floating: sign, exponent of excess 128 and fraction after a hidden bit, its 16-bit halves swapped.
double vax_real(std::uint32_t stored) {
  const std::uint32_t bits = (stored << 16) | (stored >> 16);
  const int exponent = static_cast<int>((bits >> 23) & 0xff);
  const bool negative = (bits >> 31) != 0;
  if (exponent == 0) return negative ? std::nan("") : 0.0;  // with a sign: reserved
  const double fraction = std::ldexp(static_cast<double>((bits & 0x7fffff) | 0x800000), -24);
  return std::ldexp(negative ? -fraction : fraction, exponent - 128);
}

double Fields::real() {
  const std::uint32_t bits = word();
  return format_ == NumberFormat::vax ? vax_real(bits) : std::bit_cast<float>(bits);
}

/// What one dimensional system measures speed and mass in.
struct DimensionSystem {
  std::string_view name;
  double speed_to_mps, mass_to_kg;
};
constexpr DimensionSystem kSystems[] = {{"MET", 1.0 / 3.6, 1.0}, {"SI", 1.0, 1.0}, {"ENG", 0.44704, 0.45359237}};

/// Units spelled in full, where find_unit() knows others.
constexpr std::pair<std::string_view, std::string_view> kUnitWords[] = {
    {"DEGREES/SEC", "deg/s"},      {"DEGREES/SEC**2", "deg/s^2"}, {"RADIANS/SEC", "rad/s"},
    {"RADIANS/SEC**2", "rad/s^2"}, {"KILOMETERS/HOUR", "km/h"},   {"METERS/SEC", "m/s"},
    {"METERS/SECOND", "m/s"},      {"METERS/SEC**2", "m/s^2"},    {"MILES/HOUR", "mph"},
    {"NEWTON-SECONDS", "N s"},     {"NEWTON-METERS", "N m"},      {"POUNDS", "lbf"},
    {"POUND-FEET", "lbf ft"},      {"POUNDS MASS", "lb"},         {"NONE", "1"}};

std::optional<Unit> unit_of(std::string_view words) {
  for (const auto& [name, ours] : kUnitWords)
    if (same_ignoring_case(words, name)) return find_unit(ours);
  return find_unit(words);
}

/// What the header record says that the samples need.
struct Header {
  NumberFormat format = NumberFormat::ieee;
  DimensionSystem system = kSystems[0];
};

/// One channel: what its curve header says and where its data are.
struct Channel {
  bool is_of_pairs = false;
  std::int32_t first = 0, last = 0;
  double step = kUnset;  ///< DEL, in the unit of x.
  std::string x_unit;
  std::vector<std::size_t> y_records, x_records;  ///< Offsets of their floats in the file.
};

struct Uds {
  Header header;
  std::int32_t declared_channels = 0;  ///< NCHAN.
  std::vector<Channel> channels;
  TraceSet set;
};

void add_text(TraceSet& set, std::string key, std::string_view value) {
  if (!value.empty()) set.metadata.emplace_back(std::move(key), value);
}

void add_number(TraceSet& set, std::string key, double value) {
  if (value != 0.0) set.metadata.emplace_back(std::move(key), format_number(value));  // 0: not filled in
}

Header number_format(std::string_view record, const std::string& path) {
  constexpr std::size_t kNumForm = kMark + 4 + 10, kDimSys = kNumForm + 5;
  Header header;
  const std::string_view format = trimmed(record.substr(kNumForm, 5)), system = trimmed(record.substr(kDimSys, 3));
  if (format == "SUN")
    header.format = NumberFormat::sun;
  else if (format == "VAX")
    header.format = NumberFormat::vax;
  else if (format != "IEEE")
    throw InvalidInput(fmt::format("{}: byte {}: NUMFORM = '{}': must be IEEE, SUN or VAX", path, kNumForm, format));
  const auto known = std::find_if(std::begin(kSystems), std::end(kSystems),
                                  [&](const DimensionSystem& s) { return s.name == system; });
  if (known == std::end(kSystems))
    throw InvalidInput(fmt::format("{}: byte {}: DIMSYS = '{}': must be MET, SI or ENG", path, kDimSys, system));
  header.system = *known;
  return header;
}

/// Fields of an object (vehicle or barrier) and its occupant, which follow one another.
void read_component(Fields& f, const DimensionSystem& system, const std::string& section, bool is_first,
                    TraceSet& set) {
  const std::int32_t number = f.integer();
  const auto key = [&](std::string_view name) { return fmt::format("{}[{}].{}", section, number, name); };
  add_text(set, key("CMPTYP"), f.text(2));
  add_text(set, key("CMPDSC"), f.text(30));
  add_text(set, key("MAKE"), f.text(15));
  add_text(set, key("MODEL"), f.text(25));
  add_number(set, key("YEAR"), f.integer());
  add_text(set, key("BODY"), f.text(25));
  add_text(set, key("ENGINE"), f.text(4));
  const double mass = f.real(), speed = f.real();
  add_number(set, key("VEHTWT"), mass);
  add_number(set, key("VEHSPD"), speed);
  if (is_first && mass > 0.0 && std::isfinite(mass)) set.mass_kg = mass * system.mass_to_kg;
  if (is_first && speed > 0.0 && std::isfinite(speed)) set.impact_speed_mps = speed * system.speed_to_mps;
  add_text(set, key("OCCTYP"), f.text(6));
  add_number(set, key("OCCAGE"), f.integer());
  add_text(set, key("OCCSEX"), f.text(1));
  add_number(set, key("OCCWT"), f.real());
  add_text(set, key("DUMSIZ"), f.text(2));
  add_text(set, key("RESTR1"), f.text(20));
  add_text(set, key("RESTR2"), f.text(20));
}

void read_header(std::string_view record, Uds& uds) {
  TraceSet& set = uds.set;
  uds.header = number_format(record, set.path);
  Fields f(record.substr(kMark), uds.header.format);
  uds.declared_channels = f.integer();
  f.text(10 + 5 + 3);
  add_text(set, "TEST.TSTSRC", f.text(15));
  add_number(set, "TEST.TSTNO", f.integer());
  add_text(set, "TEST.TSTNAM", f.text(12));
  set.title = f.text(70);
  add_text(set, "TEST.TITLE", set.title);
  add_text(set, "TEST.TSTPRF", f.text(25));
  add_text(set, "TEST.TSTREF", f.text(10));
  add_text(set, "TEST.TSTCFN", f.text(3));
  add_number(set, "TEST.IMPANG", f.integer());
  const double closing = f.real();
  add_number(set, "TEST.CLSSPD", closing);
  read_component(f, uds.header.system, "COMPONENT", true, set);
  if (std::isnan(set.impact_speed_mps) && closing > 0.0 && std::isfinite(closing))
    set.impact_speed_mps = closing * uds.header.system.speed_to_mps;
  for (const char* name : {"HIC", "T1", "T2", "HICDTUP", "CLIP3M", "CSI"})
    add_number(set, fmt::format("INJURY.{}", name), f.real());
  add_text(set, "INJURY.AIS", f.text(1));
}

/// The channel's part of the metadata, and what its trace is.
void describe(Fields& f, Uds& uds, Trace& trace, Channel& channel) {
  f.integer();  // ICHAN
  channel.is_of_pairs = f.text(10) == "X-Y";
  trace.id = std::to_string(f.integer());
  const std::string name(f.text(12)), key = fmt::format("INSTRUMENTATION[{}].", trace.id);
  trace.location = f.text(30);
  const auto add = [&](std::string_view field, std::string_view value) {
    add_text(uds.set, fmt::format("{}{}", key, field), value);
  };
  add("CURNAM", name);
  add("SENLOC", f.text(2));
  for (const char* field : {"SENNUM", "BANDNO", "GAGNO"}) add_number(uds.set, key + field, f.integer());
  const std::string_view axis = f.text(2);
  add("AXIS", axis);
  if (!axis.empty() && axis.front() >= 'X' && axis.front() <= 'Z') trace.axis = axis.front();
  add("YTYP", f.text(20));
  trace.source_unit = f.text(20);
  if (const auto unit = unit_of(trace.source_unit)) trace.dimension = unit->dimension;
  add("XTYP", f.text(20));
  channel.x_unit = f.text(20);
  const std::string_view status = f.text(20);
  add("STATUS", status);
  trace.problem = nhtsa_status(status, "STATUS").problem;
  add("CURTYP", f.text(20));
  trace.name = f.text(70);
  if (trace.name.empty()) trace.name = fmt::format("{} {}", trace.location, axis);
  channel.first = f.integer();
  channel.last = f.integer();
  channel.step = f.real();
  for (const char* field : {"INIVEL", "PREF", "FCUT", "FCOR", "FSTP", "SCLFAC"})
    add_number(uds.set, key + field, f.real());
}

/// Why a channel cannot be read, "" when it can.
std::string fault_of(const Channel& c) {
  const auto unit = unit_of(c.x_unit);
  if (!c.x_unit.empty() && (!unit || unit->dimension != Dimension::time))
    return fmt::format("its x is in {}, not a time", c.x_unit);
  if (c.last < c.first) return fmt::format("NFP = {} is above NLP = {}", c.first, c.last);
  if (!c.is_of_pairs && !(c.step > 0.0 && std::isfinite(c.step))) return fmt::format("DEL = {}: must be > 0", c.step);
  return "";
}

void read_curve_header(std::string_view record, Uds& uds) {
  Fields f(record.substr(kMark), uds.header.format);
  Trace trace;
  Channel channel;
  describe(f, uds, trace, channel);
  trace.has_samples = false;
  const std::string fault = fault_of(channel);
  if (trace.problem.empty()) trace.problem = fault;
  if (trace.problem.empty() && trace.axis == 'X' && trace.dimension == Dimension::acceleration)
    uds.set.compartment_x.push_back(trace.id);
  uds.channels.push_back(std::move(channel));
  uds.set.traces.push_back(std::move(trace));
}

/// Goes over the records once.
Uds catalogue(const InputFile& file) {
  const std::string_view bytes = file.bytes();
  Uds uds;
  uds.set.path = file.path();
  uds.set.input_files = {file.path()};
  if (!bytes.starts_with(kVersion))
    throw InvalidInput(fmt::format(
        "{}: {} files do not say how their numbers are stored: download the EV5 or ASCII version of the test instead",
        file.path(), trimmed(bytes.substr(0, kMark))));
  if (bytes.size() < kRecord)
    throw InvalidInput(fmt::format("{}: ends in its header, at byte {} of {}", file.path(), bytes.size(), kRecord));
  read_header(bytes.substr(0, kRecord), uds);
  for (std::size_t at = kRecord; at + kMark <= bytes.size(); at += kRecord) {
    const std::string_view record = bytes.substr(at, kRecord);
    const std::string_view mark = Fields(record, uds.header.format).text(kMark);
    const bool is_whole = record.size() == kRecord;
    if (mark == kCurve && is_whole) {
      read_curve_header(record, uds);
    } else if (mark == kSecondComponent && is_whole) {
      Fields f(record.substr(kMark), uds.header.format);
      read_component(f, uds.header.system, "COMPONENT", false, uds.set);
    } else if ((mark == kY || mark == kX) && !uds.channels.empty()) {
      (mark == kY ? uds.channels.back().y_records : uds.channels.back().x_records).push_back(at + kMark);
    } else if (is_whole) {
      throw InvalidInput(fmt::format("{}: byte {}: '{}' is no record of a UDS file", file.path(), at, mark));
    }
  }
  if (uds.channels.empty())
    throw InvalidInput(fmt::format("{}: no curve header: the file is cut short at byte {}", file.path(), bytes.size()));
  if (uds.set.compartment_x.size() > 1) uds.set.compartment_x.clear();  // the file does not say which is its
  if (uds.declared_channels != std::ssize(uds.channels))
    uds.set.warnings.push_back(fmt::format("{}: NCHAN promises {} channels, the file has {}", file.path(),
                                           uds.declared_channels, uds.channels.size()));
  return uds;
}

/// The floats of some records, as many as declared and there.
std::vector<double> read_floats(std::string_view bytes, const std::vector<std::size_t>& records, std::size_t declared,
                                NumberFormat format) {
  std::vector<double> values;
  values.reserve(std::min(declared, records.size() * kFloats));
  for (const std::size_t at : records) {
    Fields f(bytes.substr(at, kFloats * 4), format);
    for (std::size_t i = 0; i < kFloats && values.size() < declared && f.has_word(); ++i) values.push_back(f.real());
  }
  return values;
}

void read_samples(std::string_view bytes, const Uds& uds, const Channel& channel, Trace& trace,
                  std::vector<std::string>& warnings) {
  if (!fault_of(channel).empty()) return;
  const auto declared = static_cast<std::size_t>(std::int64_t{channel.last} - channel.first + 1);
  std::vector<double> y = read_floats(bytes, channel.y_records, declared, uds.header.format);
  std::vector<double> x;
  if (channel.is_of_pairs) {
    x = read_floats(bytes, channel.x_records, declared, uds.header.format);
    y.resize(std::min(x.size(), y.size()));
    x.resize(y.size());
  } else {
    for (std::size_t i = 0; i < y.size(); ++i) x.push_back(channel.step * (channel.first + static_cast<double>(i)));
  }
  if (y.size() < declared) {
    const std::string lost = fmt::format("{}: channel {}: the file is cut short: {} of {} samples are there",
                                         uds.set.path, trace.id, y.size(), declared);
    warnings.push_back(lost);
    if (trace.problem.empty()) trace.problem = lost;
  }
  if (y.empty()) return;
  const auto back = std::adjacent_find(x.begin(), x.end(), [](double a, double b) { return !(a < b); });
  if (back != x.end() && trace.problem.empty())
    trace.problem = fmt::format("{}: time does not increase after sample {}", uds.set.path, back - x.begin() + 1);
  if (const auto unit = unit_of(channel.x_unit)) scale(x, unit->to_si);
  if (const auto unit = unit_of(trace.source_unit)) scale(y, unit->to_si);
  trace.time_s = std::make_shared<const std::vector<double>>(std::move(x));
  trace.values = std::move(y);
  trace.has_samples = true;
}

bool detects(const InputFile& file) { return !file.is_folder() && file.bytes().starts_with(kFamily); }

TraceSet read(const InputFile& file, const ReadOptions&, const Choose& choose) {
  Uds uds = catalogue(file);
  std::vector<std::string> warnings;
  for (const std::size_t i : choose(uds.set))
    read_samples(file.bytes(), uds, uds.channels[i], uds.set.traces[i], warnings);
  uds.set.warnings.insert(uds.set.warnings.end(), warnings.begin(), warnings.end());
  return std::move(uds.set);
}

}  // namespace

const Reader kNhtsaUdsReader = {"nhtsa_uds", "NHTSA UDS-1992 (binary signal file)", detects, read};

}  // namespace crashsim::io
