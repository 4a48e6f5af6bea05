#include "channel_choice.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {
namespace {

void check(const TraceSet& set, const Trace& trace) {
  const std::string what = channel_label(set, trace);
  if (!trace.problem.empty()) throw InvalidInput(fmt::format("{}: {}", what, trace.problem));
  if (!trace.has_samples) throw InvalidInput(fmt::format("{}: its samples are not there", what));
  check_series(trace.times(), trace.values, what);
}

}  // namespace

std::string channel_label(const TraceSet& set, const Trace& trace) {
  return fmt::format("{}: channel {} {}", set.path, trace.id, trace.name);
}

std::vector<const Trace*> chosen_channels(const TraceSet& set, const std::vector<std::string>& selectors) {
  std::vector<const Trace*> chosen;
  for (const std::string& selector : selectors)
    for (const std::size_t i : select_channels(set, selector))
      if (std::find(chosen.begin(), chosen.end(), &set.traces[i]) == chosen.end()) chosen.push_back(&set.traces[i]);
  for (const Trace* trace : chosen) check(set, *trace);
  return chosen;
}

}  // namespace crashsim
