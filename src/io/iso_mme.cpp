/// ISO-MME tests (ISO/TS 13499): TEST.mme, and in its folder Channel TEST.chn and one file a channel, TEST.001 and so
/// on.

#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <crashsim/units.hpp>

#include "io/iso_mme_code.hpp"
#include "io/iso_mme_samples.hpp"
#include "io/iso_mme_test.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr double kLongestInterval_s = 0.01;  // longer ones look like milliseconds

using Times = std::shared_ptr<const std::vector<double>>;

/// Index of the first time that is not after the one before it, or is no number; the size when there is none.
std::size_t first_not_increasing(const std::vector<double>& times) {
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || (i > 0 && times[i] <= times[i - 1])) return i;
  return times.size();
}

/// Sample times of channels, shared between those of one clock.
class Clocks {
 public:
  Clocks(const InputFile& opened, IsoMmeCatalogue& catalogue) : opened_(opened), catalogue_(catalogue) {}

  /// Times of the first `count` samples of channel i. @throws InvalidInput saying why they cannot be had.
  Times of(std::size_t i, std::size_t count) {
    const IsoMmeHeader& header = catalogue_.channels[i].header;
    const std::string_view kind = header.value("Reference channel"), name = header.value("Reference channel name");
    const bool has_interval = !header.value("Sampling interval").empty();
    if (same_ignoring_case(kind, "explicit") || (!has_interval && !name.empty())) return from_channel(name, count);
    if (!has_interval) throw InvalidInput("its header says neither a sampling interval nor a time channel");
    return from_interval(catalogue_.channels[i], count);
  }

 private:
  Times from_interval(const IsoMmeChannelFile& channel, std::size_t count) {
    const auto seconds = [&](std::string_view name) {
      return quantity(channel.header.value(name), Dimension::time, name);
    };
    const double interval_s = seconds("Sampling interval");
    if (!(interval_s > 0.0)) throw InvalidInput(fmt::format("Sampling interval = {} s: must be > 0", interval_s));
    const bool has_first = !channel.header.value("Time of first sample").empty();
    const double first_s = has_first ? seconds("Time of first sample") : 0.0;
    if (!has_first)
      warn(fmt::format("{}: its header does not say the time of the first sample: taken as 0", channel.path));
    if (interval_s > kLongestInterval_s)
      warn(fmt::format("{}: sampling interval {:g} s is long for a crash: is it in s?", channel.path, interval_s));
    Times& times = by_interval_[{first_s, interval_s, count}];
    if (!times) times = std::make_shared<const std::vector<double>>(iso_mme_times(first_s, interval_s, count));
    if (first_not_increasing(*times) < count)
      throw InvalidInput(fmt::format("Sampling interval = {} s: too small to tell samples apart", interval_s));
    return times;
  }

  Times from_channel(std::string_view name, std::size_t count) {
    const std::string_view code = trimmed(name.substr(0, name.find('/')));
    const auto& channels = catalogue_.channels;
    for (std::size_t i = 0; i < channels.size(); ++i)
      if (!code.empty() && same_ignoring_case(channels[i].header.value("Channel code"), code))
        return cut_to(i, count, code);
    throw InvalidInput(fmt::format("its time channel {} is not there", name.empty() ? "has no name and" : name));
  }

  Times cut_to(std::size_t channel, std::size_t count, std::string_view code) {
    Times& all = by_channel_[channel];
    if (!all) all = std::make_shared<const std::vector<double>>(read_times(channel));
    if (all->size() < count)
      throw InvalidInput(
          fmt::format("its time channel {} has {} samples only, it has {} itself", code, all->size(), count));
    if (const std::size_t bad = first_not_increasing(*all); bad < count)
      throw InvalidInput(fmt::format("times of its time channel {} do not increase at sample {}", code, bad + 1));
    if (all->size() == count) return all;
    return std::make_shared<const std::vector<double>>(all->begin(), all->begin() + static_cast<std::ptrdiff_t>(count));
  }

  std::vector<double> read_times(std::size_t i) const {
    const IsoMmeChannelFile& channel = catalogue_.channels[i];
    IsoMmeSamples samples = with_bytes(opened_, channel.path, [&](std::string_view bytes) {
      return parse_iso_mme_samples(bytes, channel.header, channel.path);
    });
    const std::string_view unit_text = channel.header.value("Unit");
    const auto unit = unit_text.empty() ? Unit{"s", Dimension::time, 1.0} : find_unit(unit_text, Dimension::time);
    if (!unit) throw InvalidInput(fmt::format("{}: its unit '{}' is none of time", channel.path, unit_text));
    scale(samples.values, unit->to_si);
    return std::move(samples.values);
  }

  void warn(const std::string& text) { catalogue_.set.warnings.push_back(text); }

  const InputFile& opened_;
  IsoMmeCatalogue& catalogue_;
  std::map<std::tuple<double, double, std::size_t>, Times> by_interval_;
  std::map<std::size_t, Times> by_channel_;
};

bool is_time_channel(const Trace& trace) { return trace.id.substr(0, 6).ends_with("TIRS"); }

/// Fills in a trace's samples, or why they cannot be had.
void read_samples(const InputFile& opened, std::size_t i, Clocks& clocks, IsoMmeCatalogue& catalogue) {
  const IsoMmeChannelFile& channel = catalogue.channels[i];
  Trace& trace = catalogue.set.traces[i];
  IsoMmeSamples samples = with_bytes(opened, channel.path, [&](std::string_view bytes) {
    return parse_iso_mme_samples(bytes, channel.header, channel.path);
  });
  if (!samples.warning.empty()) catalogue.set.warnings.push_back(samples.warning);
  if (trace.problem.empty()) trace.problem = samples.problem;
  if (samples.values.empty()) return;
  if (trace.dimension != Dimension::unknown)
    scale(samples.values, find_unit(trace.source_unit, trace.dimension).value().to_si);
  try {
    if (!is_time_channel(trace)) {
      trace.time_s = clocks.of(i, samples.values.size());
    } else if (first_not_increasing(samples.values) == samples.values.size()) {
      trace.time_s = std::make_shared<const std::vector<double>>(samples.values);
    } else {
      throw InvalidInput("its times do not increase");
    }
  } catch (const InvalidInput& error) {
    trace.problem = fmt::format("{}: {}", channel.path, error.what());
    return;
  }
  trace.values = std::move(samples.values);
  trace.has_samples = true;
}

/// Nothing is filtered twice silently: says which of the channels read are filtered already.
void warn_of_filters(const std::vector<std::size_t>& chosen, TraceSet& set) {
  std::map<std::string_view, std::string> filtered;
  for (const std::size_t i : chosen) {
    const std::string_view code = std::string_view(set.traces[i].id).substr(0, kIsoMmeCodeLength);
    const std::string_view filter = iso_mme_filter(code);
    if (filter.empty() || !set.traces[i].has_samples) continue;
    std::string& list = filtered[filter];
    list += fmt::format("{}{}", list.empty() ? "" : ", ", set.traces[i].id);
  }
  for (const auto& [filter, list] : filtered)
    set.warnings.push_back(
        fmt::format("{}: already filtered with {} by their codes: {}; a filter here acts on top of "
                    "that, cfc = 0 leaves them as they are",
                    set.path, filter, list));
}

bool detects(const InputFile& file) {
  return file.is_folder() ? is_iso_mme_folder(file.path())
                          : iso_mme_file(file.bytes(), file.path()) != IsoMmeFile::none;
}

TraceSet read(const InputFile& file, const ReadOptions&, const Choose& choose) {
  const IsoMmeFile kind = file.is_folder() ? IsoMmeFile::none : iso_mme_file(file.bytes(), file.path());
  IsoMmeCatalogue catalogue = catalogue_iso_mme(file, find_iso_mme_files(file.path(), file.is_folder(), kind));
  Clocks clocks(file, catalogue);
  const std::vector<std::size_t> chosen = choose(catalogue.set);
  for (const std::size_t i : chosen)
    if (!catalogue.channels[i].path.empty()) read_samples(file, i, clocks, catalogue);
  warn_of_filters(chosen, catalogue.set);
  return std::move(catalogue.set);
}

}  // namespace

const Reader kIsoMmeReader = {"iso_mme", "ISO-MME (folder, TEST.mme, TEST.chn or channel file TEST.001)", detects,
                              read};

}  // namespace crashsim::io
