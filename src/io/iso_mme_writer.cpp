/// Writes ISO-MME tests.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <crashsim/iso_mme.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/version.hpp>

#include "io/iso_mme_code.hpp"
#include "io/iso_mme_samples.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

constexpr std::string_view kLineEnd = "\r\n";  // as the standard wants it
constexpr std::string_view kNoValue = "NOVALUE";

/// What is written for a dimension, as the standard spells it.
std::string_view unit_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return "1";
    case Dimension::acceleration:
      return "m/(s*s)";
    case Dimension::angular_acceleration:
      return "rad/(s*s)";
    case Dimension::moment:
      return "Nm";
    case Dimension::impulse:
      return "kg*m/s";
    default:
      return si_symbol(dimension);
  }
}

/// Writes lines of a header.
class Header {
 public:
  void add(std::string_view name, std::string_view value) {
    std::string line(value.empty() ? kNoValue : value);
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text_ += fmt::format("{:<28}:{}{}", name, line, kLineEnd);
  }
  void add(std::string_view name, double value) { add(name, std::isnan(value) ? "" : format_number(value)); }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string samples_text(const std::vector<double>& values) {
  constexpr std::size_t kLongest = 26;  // "-1.2345678901234567e-300" and the line's end
  std::string text(values.size() * kLongest, '\0');
  char* at = text.data();
  for (const double value : values) {
    if (std::isnan(value)) {
      at = std::copy(kNoValue.begin(), kNoValue.end(), at);
    } else {
      at = std::to_chars(at, at + kLongest, value).ptr;
    }
    at = std::copy(kLineEnd.begin(), kLineEnd.end(), at);
  }
  text.resize(static_cast<std::size_t>(at - text.data()));
  return text;
}

/// How a channel says its times.
struct Clock {
  double first_s = kUnset, interval_s = kUnset;  ///< Implicit.
  std::string channel;                           ///< Code of the time channel; "" implicit.
};

/// The interval that gives times back but for rounding; unset when they are not uniform.
double exact_interval(const std::vector<double>& time_s) {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double mean_s = uniform_step(time_s);
  if (std::isnan(mean_s)) return kUnset;
  const double tolerance_s = kRounding * std::max(std::abs(time_s.front()), std::abs(time_s.back()));
  constexpr double kDigits = 1e12;  // decimals of an interval as people choose it
  for (const double interval_s : {std::round(mean_s * kDigits) / kDigits, mean_s}) {
    const auto times = io::iso_mme_times(time_s.front(), interval_s, time_s.size());
    const bool same =
        interval_s > 0.0 && std::equal(times.begin(), times.end(), time_s.begin(),
                                       [&](double a, double b) { return std::abs(a - b) <= tolerance_s; });
    if (same) return interval_s;
  }
  return kUnset;
}

/// A code for a time channel that no other channel has.
std::string unused_time_code(const std::vector<IsoMmeChannel>& channels, std::size_t number) {
  for (;; ++number) {
    std::string code = fmt::format("10TIRS{:02}{:02}00TI00", number / 100 % 100, number % 100);
    const bool used = std::any_of(channels.begin(), channels.end(),
                                  [&](const IsoMmeChannel& channel) { return channel.code == code; });
    if (!used) return code;
  }
}

/// The clocks of the channels of a test. Adds a time channel for each that is not uniform.
std::vector<Clock> find_clocks(std::vector<IsoMmeChannel>& channels) {
  std::map<std::vector<double>, Clock> known;
  std::vector<Clock> clocks;
  const std::size_t count = channels.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto time_s = channels[i].time_s;
    auto [found, is_new] = known.try_emplace(*time_s);
    if (is_new) {
      const double interval_s = exact_interval(*time_s);
      if (!std::isnan(interval_s)) {
        found->second = {time_s->front(), interval_s, ""};
      } else {
        found->second.channel = unused_time_code(channels, channels.size() - count);
        channels.push_back({found->second.channel, "Time", "", Dimension::time, "", time_s, *time_s});
      }
    }
    clocks.push_back(found->second);
  }
  clocks.resize(channels.size());
  return clocks;
}

void check(const IsoMmeChannel& channel) {
  const std::string what = fmt::format("channel {} {}", channel.code, channel.name);
  if (!io::is_iso_mme_code(channel.code))
    throw InvalidInput(fmt::format("{}: '{}' is no ISO-MME code: 16 letters and digits", what, channel.code));
  if (io::iso_mme_letters(channel.dimension).empty())
    throw InvalidInput(fmt::format("{}: ISO-MME has no unit for {}", what, dimension_name(channel.dimension)));
  if (!channel.time_s) throw InvalidInput(fmt::format("{}: has no times", what));
  std::vector<double> values = channel.values;
  std::replace_if(
      values.begin(), values.end(), [](double value) { return std::isnan(value); }, 0.0);
  check_series(*channel.time_s, values, what, 1);
}

void add_extremes(const IsoMmeChannel& channel, Header& header) {
  std::size_t largest = channel.values.size(), smallest = largest;
  for (std::size_t i = 0; i < channel.values.size(); ++i) {
    if (std::isnan(channel.values[i])) continue;
    if (largest == channel.values.size() || channel.values[i] > channel.values[largest]) largest = i;
    if (smallest == channel.values.size() || channel.values[i] < channel.values[smallest]) smallest = i;
  }
  const bool none = largest == channel.values.size();
  header.add("First global maximum value", none ? kUnset : channel.values[largest]);
  header.add("Time of maximum value", none ? kUnset : (*channel.time_s)[largest]);
  header.add("First global minimum value", none ? kUnset : channel.values[smallest]);
  header.add("Time of minimum value", none ? kUnset : (*channel.time_s)[smallest]);
}

std::string channel_text(const IsoMmeChannel& channel, const Clock& clock, const IsoMmeTest& test) {
  const std::string_view filter = io::iso_mme_filter(channel.code);
  Header header;
  header.add("Test object number", channel.code.substr(0, 1));
  header.add("Name of the channel", channel.name);
  for (const char* name : {"Laboratory channel code", "Customer channel code", "Channel code"})
    header.add(name, channel.code);
  if (!channel.comment.empty()) header.add("Comments", channel.comment);
  header.add("Location", channel.code);
  header.add("Direction", channel.code.substr(14, 1));
  header.add("Dimension", channel.code.substr(12, 2));
  header.add("Channel frequency class", filter.starts_with("CFC ") ? filter.substr(4) : "");
  header.add("Unit", unit_of(channel.dimension));
  header.add("Reference system", "local");
  for (const char* name :
       {"Transducer type", "Transducer id", "Pre-filter type", "Cut off frequency", "Channel amplitude class"})
    header.add(name, "");
  header.add("Sampling interval", clock.interval_s);
  header.add("Bit resolution", "");
  header.add("Time of first sample", clock.first_s);
  header.add("Number of samples", std::to_string(channel.values.size()));
  const bool has_times = !std::isnan(clock.interval_s) || !clock.channel.empty();
  header.add("Reference channel", !has_times ? "" : (clock.channel.empty() ? "implicit" : "explicit"));
  header.add("Reference channel name", clock.channel);
  header.add("Data source", test.data_source);
  header.add("Data status", channel.problem.empty() ? "ok" : "questionable data");
  add_extremes(channel, header);
  return header.take() + samples_text(channel.values);
}

std::string test_text(const IsoMmeTest& test) {
  Header header;
  header.add("Data format edition number", "1.6");
  header.add("Laboratory name", "");
  header.add("Customer name", "");
  header.add("Title", test.title.empty() ? test.name : test.title);
  header.add("Type of the test", "");
  header.add("Comments", fmt::format("Written by crashsim {}", kVersion));
  for (const std::string& comment : test.comments) header.add("Comments", comment);
  header.add("Number of test objects", "1");
  header.add("Name of test object 1", "Vehicle");
  header.add("Velocity test object 1", test.impact_speed_mps);
  header.add("Mass test object 1", test.mass_kg);
  header.add("Type of data source", test.data_source);
  return header.take();
}

std::string list_text(const std::vector<IsoMmeChannel>& channels) {
  Header header;
  header.add("Instrumentation standard", "");
  header.add("Number of channels", std::to_string(channels.size()));
  for (std::size_t i = 0; i < channels.size(); ++i)
    header.add(fmt::format("Name of channel {:03}", i + 1), fmt::format("{} / {}", channels[i].code, channels[i].name));
  return header.take();
}

void check(const IsoMmeTest& test) {
  const bool proper =
      !test.name.empty() && test.name.front() != '.' && test.name.find_first_of("/\\\n\r") == std::string::npos;
  if (!proper) throw InvalidInput(fmt::format("test name '{}': must be a file name without folder", test.name));
  if (test.channels.empty()) throw InvalidInput(fmt::format("test {}: has no channels to write", test.name));
  for (const IsoMmeChannel& channel : test.channels) check(channel);
}

}  // namespace

std::vector<FileText> format_iso_mme(const IsoMmeTest& test) {
  check(test);
  constexpr std::size_t kMostChannels = 9999;  // what codes of time channels can number
  if (test.channels.size() > kMostChannels)
    throw InvalidInput(
        fmt::format("test {}: {} channels: at most {} can be written", test.name, test.channels.size(), kMostChannels));
  std::vector<IsoMmeChannel> channels = test.channels;
  const std::vector<Clock> clocks = find_clocks(channels);
  std::vector<FileText> files = {{test.name + ".mme", test_text(test)}};
  if (!test.record.empty()) files.push_back({test.name + ".txt", fmt::format("# record = {}\n", test.record)});
  files.push_back({fmt::format("Channel/{}.chn", test.name), list_text(channels)});
  for (std::size_t i = 0; i < channels.size(); ++i)
    files.push_back({fmt::format("Channel/{}.{:03}", test.name, i + 1), channel_text(channels[i], clocks[i], test)});
  return files;
}

void write_iso_mme(const IsoMmeTest& test, const std::string& folder, bool overwrite) {
  write_folder_atomically(folder, format_iso_mme(test), overwrite);
}

}  // namespace crashsim
