#include "io/nhtsa_status.hpp"

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

struct Meaning {
  std::string_view code, words;
  std::string_view problem;  ///< "" for data that may be used.
};
constexpr Meaning kMeanings[] = {
    {"AM", "AS MEASURED", ""},
    {"CM", "COMPUTED", ""},
    {"NO", "NO DATA", "no data were recorded"},
    {"CF", "CHANNEL FAILED", "its source says that the channel failed"},
    {"SF", "SYSTEM FAILED", "its source says that the data system failed"},
    {"QD", "QUESTIONABLE DATA", "its source says that the data are questionable"},
    {"CQ", "COMPUTED WITH QUESTIONABLE DATA", "its source says that it was computed with questionable data"},
    {"ML", "MEANINGLESS", "its source says that the data are meaningless"},
    {"ML", "MEANINGLESS DATA", "its source says that the data are meaningless"},
    // what processing leaves in UDS files
    {"", "MODIFIED", ""},
    {"", "FILTERED", ""},
    {"", "ALIGNED", ""},
    {"", "TRUNCATED", ""},
    {"", "SCALED", ""},
    {"", "SUBSAMPLED", ""},
};

}  // namespace

NhtsaStatus nhtsa_status(std::string_view status, std::string_view field) {
  const std::string_view text = trimmed(status);
  if (text.empty()) return {};
  for (const Meaning& meaning : kMeanings) {
    // a field of 20 characters cuts the longest words
    const bool cut = text.size() >= 20 && meaning.words.size() > text.size() &&
                     same_ignoring_case(meaning.words.substr(0, text.size()), text);
    if (!cut && !same_ignoring_case(text, meaning.words) &&
        (meaning.code.empty() || !same_ignoring_case(text, meaning.code)))
      continue;
    if (meaning.problem.empty()) return {};
    return {fmt::format("{} ({} {})", meaning.problem, field, text), true};
  }
  return {"", false};
}

}  // namespace crashsim::io
