#include <crashsim/trace.hpp>

#include <algorithm>

#include <fnmatch.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nearest.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

/// "093" and "93" are the same number.
std::string_view without_leading_zeros(std::string_view id) {
  if (id.empty() || !std::all_of(id.begin(), id.end(), is_digit)) return id;
  while (id.size() > 1 && id.front() == '0') id.remove_prefix(1);
  return id;
}

template <class Matches>
std::vector<std::size_t> all_that_match(const TraceSet& set, Matches matches) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < set.traces.size(); ++i)
    if (matches(set.traces[i])) found.push_back(i);
  return found;
}

[[noreturn]] void refuse(const TraceSet& set, const std::string& selector) {
  constexpr std::size_t kSuggestions = 6;
  std::vector<std::string> ids, names;
  for (const Trace& trace : set.traces) {
    names.push_back(trace.name);
    ids.push_back(trace.id);
  }
  std::vector<std::string> suggestions;
  for (const std::string& name : nearest(selector, names, kSuggestions)) {
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    suggestions.push_back(fmt::format("{} ({})", ids[at], name));
  }
  throw InvalidInput(fmt::format("{}: no channel '{}' among {}; nearest: {}", set.path, selector, set.traces.size(),
                                 fmt::join(suggestions, ", ")));
}

}  // namespace

std::vector<std::size_t> select_channels(const TraceSet& set, const std::string& selector) {
  const std::string_view wanted = trimmed(selector);
  const std::string_view number = without_leading_zeros(wanted);
  auto found = all_that_match(set, [&](const Trace& t) { return without_leading_zeros(t.id) == number; });
  if (found.empty()) found = all_that_match(set, [&](const Trace& t) { return t.name == wanted; });
  if (found.empty()) {
    const std::string pattern = to_lower(wanted);
    found = all_that_match(set, [&](const Trace& t) {
      return ::fnmatch(pattern.c_str(), to_lower(t.id).c_str(), 0) == 0 ||
             ::fnmatch(pattern.c_str(), to_lower(t.name).c_str(), 0) == 0;
    });
  }
  if (found.empty()) refuse(set, selector);
  return found;
}

}  // namespace crashsim
