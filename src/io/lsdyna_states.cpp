#include "io/lsdyna_states.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

std::string count_of(std::size_t n, const std::string& what) {
  return n == 1 ? fmt::format("one {}", what) : fmt::format("{} {}s", n, what);
}

}  // namespace

void LsdynaStates::Tally::add(std::size_t n, double time) {
  if (count == 0) first_time = time;
  count += n;
}

LsdynaStates::LsdynaStates(std::size_t channels, std::size_t expected) : batch_(kBatch * channels), columns_(channels) {
  times_.reserve(expected);
  for (std::vector<double>& column : columns_) column.reserve(expected);
}

void LsdynaStates::flush() {
  const std::size_t channels = columns_.size();
  for (std::size_t channel = 0; channel < channels; ++channel)
    for (std::size_t i = 0; i < pending_; ++i) columns_[channel].push_back(batch_[i * channels + channel]);
  pending_ = 0;
}

void LsdynaStates::replace_from(double time) {
  const double* current = row();
  flush();
  std::copy_n(current, columns_.size(), row());
  const auto first = std::lower_bound(times_.begin(), times_.end(), time);
  const auto dropped = static_cast<std::size_t>(times_.end() - first);
  (dropped == 1 && *first == time ? repeated_ : replaced_).add(dropped, time);
  times_.erase(first, times_.end());
  for (std::vector<double>& column : columns_) column.resize(times_.size());
}

void LsdynaStates::keep(double time) {
  if (!times_.empty() && !(time > times_.back())) replace_from(time);
  times_.push_back(time);
  if (missing_in_row_.count > 0) {
    if (missing_.count == 0) first_missing_ = first_missing_in_row_;
    missing_.add(missing_in_row_.count, time);
    forget_row();
  }
  if (++pending_ == kBatch) flush();
}

void LsdynaStates::note_missing(std::size_t channel, double time) {
  if (missing_in_row_.count == 0) first_missing_in_row_ = channel;
  missing_in_row_.add(1, time);
}

void LsdynaStates::lose(double time, std::size_t from, std::size_t to, const std::string& why, bool at_end) {
  forget_row();
  if (at_end) {
    cut_ = {time, from, to, why};
    return;
  }
  if (!first_loss_) first_loss_ = {time, from, to, why};
  lost_.add(1, time);
}

void LsdynaStates::give(TraceSet& set, const std::vector<std::size_t>& chosen, const UnitSystem& units,
                        std::string_view text) {
  flush();
  if (times_.empty()) {
    const std::optional<Loss>& loss = first_loss_ ? first_loss_ : cut_;
    const std::string why = loss ? fmt::format(": the first starts at byte {}, {}", loss->from, loss->why) : "";
    throw InvalidInput(fmt::format("{}: no whole state{}", set.path, why));
  }
  scale(times_, to_si(units, Dimension::time));
  const bool single = times_.size() == 1;
  const auto time_s = std::make_shared<const std::vector<double>>(std::move(times_));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Trace& trace = set.traces[chosen[i]];
    trace.values = std::move(columns_[i]);
    scale(trace.values, to_si(units, trace.dimension));
    trace.time_s = time_s;
    trace.has_samples = true;
  }
  if (single) set.warnings.push_back(fmt::format("{}: has one state only, which may be cut short", set.path));
  if (const std::size_t line = text.rfind('\n') + 1; !cut_ && !trimmed(text.substr(line)).empty())
    set.warnings.push_back(fmt::format("{}: ends in the middle of a line: left out {} bytes from byte {} on", set.path,
                                       text.size() - line, line));
  warn(set, chosen);
}

void LsdynaStates::warn(TraceSet& set, const std::vector<std::size_t>& chosen) const {
  const auto say = [&set](const std::string& text) { set.warnings.push_back(fmt::format("{}: {}", set.path, text)); };
  if (cut_)
    say(fmt::format("ends in the middle of a state: left out that of time {:g}, {} bytes from byte {} on ({})",
                    cut_->time, cut_->to - cut_->from, cut_->from, cut_->why));
  if (lost_.count > 0)
    say(fmt::format("{} not whole and left out, the first of time {:g} in bytes {} to {}: {}",
                    count_of(lost_.count, "state"), first_loss_->time, first_loss_->from, first_loss_->to,
                    first_loss_->why));
  if (replaced_.count > 0)
    say(fmt::format("the run was restarted: {} of an earlier run gave way to those from time {:g} on",
                    count_of(replaced_.count, "state"), replaced_.first_time));
  if (repeated_.count > 0)
    say(fmt::format("{} the same time as the next, the first {:g}: the later is kept",
                    count_of(repeated_.count, "state") + (repeated_.count == 1 ? " has" : " have"),
                    repeated_.first_time));
  if (missing_.count > 0)
    say(fmt::format("{} missing (nan, overflowed or not written), the first of channel {} at time {:g}",
                    count_of(missing_.count, "value"), set.traces[chosen[first_missing_]].name, missing_.first_time));
}

}  // namespace crashsim::io
