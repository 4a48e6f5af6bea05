#pragma once
/// The values of one state of a line-oriented LS-DYNA database, found again in every state.

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/lsdyna_states.hpp"
#include "io/lsdyna_text.hpp"

namespace crashsim::io {

/// A value's place in a state: what its file calls entity and variable.
struct LsdynaSlot {
  std::string_view entity, variable;
};

/// Takes what a database's parser finds. At first it learns which values the first state has; asked to collect, it
/// hands over every state.
///
/// A state is whole when all these values are there. One that lacks some is kept, with these missing, when the same run
/// went on to a later state (an entity may vanish); at the end of the file or before a restart it was cut short.
class LsdynaSlots {
 public:
  explicit LsdynaSlots(std::string_view text);

  /// The next line of states: preambles and legends of restarted runs are skipped. False at the end, and once the
  /// first state has been learned.
  bool next(CompleteLines& lines, std::string_view& line);

  /// A state starts at a byte.
  void start(double time, std::size_t offset);
  /// A line of values starts that says its time: in the present state, or in a new one when the time is another or the
  /// state's first value begins again.
  void start_line(std::string_view time_text, LsdynaSlot first, std::size_t offset);
  void put(LsdynaSlot slot, double value);
  /// No more states.
  void finish();

  [[nodiscard]] const std::vector<LsdynaSlot>& slots() const { return slots_; }
  /// Whether the first state has more values than memory holds; the others were not learned.
  [[nodiscard]] bool too_many() const { return slots_.size() > most_; }
  /// How many states there may be, by the size of the first.
  [[nodiscard]] std::size_t expected_states() const;
  /// From now on, states go to `states`. @param chosen slots of its channels.
  void collect(LsdynaStates& states, const std::vector<std::size_t>& chosen);
  /// Says which values were not read, as they do not stand in the first state or stand twice in one.
  void warn(TraceSet& set) const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] bool learning() const { return states_ == nullptr; }
  [[nodiscard]] std::size_t find(LsdynaSlot slot) const;
  void close(std::optional<double> next_time, std::size_t end);

  std::string_view text_;
  std::size_t most_;  // values that a state may have
  std::vector<LsdynaSlot> slots_;
  std::unordered_map<std::string, std::size_t> index_;
  std::size_t first_ = 0, second_ = 0;  // where these states start
  bool learned_ = false;

  LsdynaStates* states_ = nullptr;
  std::vector<std::size_t> channel_of_, filled_in_;  // of each slot: its channel; the last state that had it
  std::size_t channels_ = 0, state_ = 0, filled_ = 0, next_ = 0;
  std::size_t line_ = 0, put_in_ = 0;  // number of the present line, of the last that had a value
  bool open_ = false, interrupted_ = false, is_cut_ = false;
  double time_ = 0.0;
  std::string_view time_text_;
  std::size_t offset_ = 0;
  std::size_t unknown_ = 0, repeated_ = 0;
  std::string first_unknown_, first_repeated_;
};

}  // namespace crashsim::io
