#pragma once
/// How to run many cases.

#include <array>
#include <string>

#include <crashsim/options.hpp>

namespace crashsim {

struct BatchOptions {
  int jobs = 0;                  ///< Worker processes, each with one thread; 0: all cores. Results do not depend on it.
  std::string shard = "1/1";     ///< I/N: of every N cases the I-th, for the I-th of N machines.
  bool resume = false;           ///< Go on in a folder that holds results.
  bool keep_going = false;       ///< A case that fails does not stop the others.
  double time_limit_s = kUnset;  ///< Of one case; unset: none.
  double memory_limit_mb = kUnset;  ///< Address space of a worker process, 1 MB = 1e6 bytes; unset: none.

  bool operator==(const BatchOptions&) const = default;
};
inline constexpr std::array<Field<BatchOptions>, 6> kBatchFields = {{
    {"jobs", "jobs", "", "worker processes of one thread each; 0: all cores", &BatchOptions::jobs, between(0, 1024)},
    {"shard", "shard", "", "I/N: only every N-th case, from the I-th on; crashsim merge joins the N folders",
     &BatchOptions::shard},
    {"resume", "resume", "", "go on in a folder with results: do what is not done, or has changed",
     &BatchOptions::resume},
    {"keep_going", "keep-going", "", "finish the others when a case fails", &BatchOptions::keep_going},
    {"time_limit_s", "time-limit", "s", "a case that takes longer has failed", &BatchOptions::time_limit_s, positive()},
    {"memory_limit_mb", "memory-limit", "", "address space of one case in MB; one that needs more has failed",
     &BatchOptions::memory_limit_mb, positive()},
}};
template <>
inline constexpr std::span<const Field<BatchOptions>> fields<BatchOptions>{kBatchFields};

/// The part of a batch that one machine runs.
struct BatchShard {
  int index = 1;  ///< 1..count
  int count = 1;

  bool operator==(const BatchShard&) const = default;
};

/// Reads "I/N". @throws InvalidInput naming the text and the rule.
BatchShard parse_shard(const std::string& text);

}  // namespace crashsim
