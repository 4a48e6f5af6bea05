#pragma once
/// The states of an LS-DYNA database as they are read, and what was lost of them.

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/trace.hpp>

#include "io/unit_system.hpp"

namespace crashsim::io {

/// Collects whole states, each a time and a value for every channel.
///
/// Times increase: a state that is not later than those before it is of a restarted run, which computed them anew, and
/// takes the place of all from its time on.
class LsdynaStates {
 public:
  /// @param expected how many states there may be.
  LsdynaStates(std::size_t channels, std::size_t expected);

  /// Where the values of the next state go, one a channel. keep() takes them.
  double* row() { return batch_.data() + pending_ * columns_.size(); }
  void keep(double time);

  /// A value of the row is not finite, or does not stand in the file.
  void note_missing(std::size_t channel, double time);
  /// The row is filled anew: forgets what was noted of it.
  void forget_row() { missing_in_row_ = {}; }
  /// The state that starts at a byte is not whole. @param at_end whether the file ends in it.
  void lose(double time, std::size_t from, std::size_t to, const std::string& why, bool at_end);

  /// Moves times and values into the chosen traces, in SI units, and says in the warnings what was lost.
  /// @param text the whole file. @throws InvalidInput when there is no state.
  void give(TraceSet& set, const std::vector<std::size_t>& chosen, const UnitSystem& units, std::string_view text);

 private:
  static constexpr std::size_t kBatch = 8;  // values of one channel that fill a line of the cache

  struct Tally {
    std::size_t count = 0;
    double first_time = std::numeric_limits<double>::quiet_NaN();
    void add(std::size_t n, double time);
  };
  struct Loss {
    double time;
    std::size_t from, to;
    std::string why;
  };

  void flush();
  void replace_from(double time);
  void warn(TraceSet& set, const std::vector<std::size_t>& chosen) const;

  std::vector<double> times_, batch_;
  std::size_t pending_ = 0;
  std::vector<std::vector<double>> columns_;
  Tally replaced_, repeated_, missing_, missing_in_row_, lost_;
  std::size_t first_missing_ = 0, first_missing_in_row_ = 0;
  std::optional<Loss> first_loss_, cut_;
};

}  // namespace crashsim::io
