#include "io/lsdyna_slots.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/reader.hpp"

namespace crashsim::io {
namespace {

std::string key_of(LsdynaSlot slot) { return fmt::format("{}\n{}", slot.entity, slot.variable); }

std::string name_of(LsdynaSlot slot) {
  return slot.entity.empty() ? std::string(slot.variable) : fmt::format("{} {}", slot.entity, slot.variable);
}

}  // namespace

LsdynaSlots::LsdynaSlots(std::string_view text) : text_(text), most_(most_channels(text.size())) {}

bool LsdynaSlots::next(CompleteLines& lines, std::string_view& line) {
  while (!learned_ && lines.next(line)) {
    const bool restarts = is_version_line(line);
    interrupted_ |= restarts;
    // The title before it ran into the last line of a state that was cut short.
    is_cut_ |= restarts && put_in_ == line_;
    ++line_;
    const std::size_t legend = end_of_legend(text_, lines, line);
    if (legend != std::string_view::npos) lines.move_to(legend);
    if (!restarts && legend == std::string_view::npos) return true;
  }
  return false;
}

std::size_t LsdynaSlots::find(LsdynaSlot slot) const {
  if (next_ < slots_.size() && slots_[next_].variable == slot.variable && slots_[next_].entity == slot.entity)
    return next_;
  const auto found = index_.find(key_of(slot));
  return found == index_.end() ? kNone : found->second;
}

void LsdynaSlots::start(double time, std::size_t offset) {
  if (learning() && !slots_.empty()) {
    learned_ = true;
    second_ = offset;
    return;
  }
  if (learning()) {
    first_ = offset;
  } else {
    close(time, offset);
    std::fill_n(states_->row(), channels_, std::numeric_limits<double>::quiet_NaN());
    open_ = true;
    ++state_;
  }
  time_ = time;
  offset_ = offset;
  filled_ = next_ = 0;
  interrupted_ = is_cut_ = false;
}

void LsdynaSlots::start_line(std::string_view time_text, LsdynaSlot first, std::size_t offset) {
  if (time_text == time_text_ && (learning() || open_)) {
    const std::size_t slot = find(first);
    // Others may stand twice: some versions of LS-DYNA write them so.
    const bool begins_again = slot == 0 && (learning() || filled_in_[slot] == state_);
    if (!begins_again) return;
  }
  time_text_ = time_text;
  double time = 0.0;
  if (!is_fortran_number(time_text, time)) time = std::numeric_limits<double>::quiet_NaN();
  start(time, offset);
}

void LsdynaSlots::put(LsdynaSlot slot, double value) {
  if (learned_) return;
  if (learning()) {
    if (index_.emplace(key_of(slot), slots_.size()).second) slots_.push_back(slot);
    learned_ = too_many();
    return;
  }
  if (!open_) return;
  const std::size_t found = find(slot);
  if (found == kNone) {
    if (unknown_++ == 0) first_unknown_ = fmt::format("{} at time {:g}", name_of(slot), time_);
    return;
  }
  next_ = found + 1;
  put_in_ = line_;
  if (filled_in_[found] == state_) {
    if (repeated_++ == 0) first_repeated_ = fmt::format("{} at time {:g}", name_of(slot), time_);
    return;
  }
  filled_in_[found] = state_;
  ++filled_;
  const std::size_t channel = channel_of_[found];
  if (channel == kNone) return;
  states_->row()[channel] = value;
  if (std::isnan(value)) states_->note_missing(channel, time_);
}

void LsdynaSlots::close(std::optional<double> next_time, std::size_t end) {
  if (!open_) return;
  open_ = false;
  const bool went_on = next_time && *next_time > time_ && !interrupted_ && filled_ > 0;
  if (std::isnan(time_)) {
    states_->lose(time_, offset_, end, "its time is no number", !next_time);
  } else if (filled_ == slots_.size() && !is_cut_) {
    states_->keep(time_);
  } else if (went_on) {
    for (std::size_t i = 0; i < slots_.size(); ++i)
      if (filled_in_[i] != state_ && channel_of_[i] != kNone) states_->note_missing(channel_of_[i], time_);
    states_->keep(time_);
  } else {
    states_->lose(time_, offset_, end, fmt::format("with {} of {} values", filled_, slots_.size()), !next_time);
  }
}

void LsdynaSlots::finish() {
  if (!learning()) close(std::nullopt, text_.size());
}

std::size_t LsdynaSlots::expected_states() const {
  return learned_ ? (text_.size() - first_) / (second_ - first_) + 1 : 1;
}

void LsdynaSlots::collect(LsdynaStates& states, const std::vector<std::size_t>& chosen) {
  states_ = &states;
  learned_ = false;
  time_text_ = {};
  line_ = 0;
  channels_ = chosen.size();
  channel_of_.assign(slots_.size(), kNone);
  filled_in_.assign(slots_.size(), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) channel_of_[chosen[i]] = i;
}

void LsdynaSlots::warn(TraceSet& set) const {
  if (unknown_ > 0)
    set.warnings.push_back(fmt::format("{}: {} values are not in the first state and were not read, the first {}",
                                       set.path, unknown_, first_unknown_));
  if (repeated_ > 0)
    set.warnings.push_back(fmt::format("{}: {} values stand twice in a state, the first {}: the first of each is kept",
                                       set.path, repeated_, first_repeated_));
}

}  // namespace crashsim::io
