#pragma once
/// What a file says of single channels beside what a Trace holds: {"INSTRUMENTATION[93].CHSTAT", "P"}.

#include <string>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include <crashsim/trace.hpp>

namespace crashsim {

/// Looks fields up by channel and name. Holds on to the set's text.
class ChannelFields {
 public:
  explicit ChannelFields(const TraceSet& set) {
    for (const auto& [key, value] : set.metadata)
      if (key.starts_with("INSTRUMENTATION[")) fields_.emplace(key, value);
  }

  /// "" when the file does not say.
  [[nodiscard]] std::string_view of(const Trace& trace, std::string_view field) const {
    const auto found = fields_.find(fmt::format("INSTRUMENTATION[{}].{}", trace.id, field));
    return found == fields_.end() ? std::string_view() : found->second;
  }

 private:
  std::unordered_map<std::string_view, std::string_view> fields_;
};

}  // namespace crashsim
