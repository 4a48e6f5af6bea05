#include "io/iso_mme_header.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

#include "io/encoding.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::size_t kMostLines = 20000;
constexpr std::size_t kLongestValue = 4096;
constexpr std::size_t kLongestName = 128;

constexpr std::string_view kChannelNames[] = {"channel code",        "laboratory channel code", "customer channel code",
                                              "name of the channel", "sampling interval",       "time of first sample",
                                              "number of samples",   "reference channel",       "data status",
                                              "data source"};
constexpr std::string_view kTestNames[] = {"data format edition number",
                                           "data format",
                                           "laboratory name",
                                           "laboratory test ref. number",
                                           "customer name",
                                           "customer test ref. number",
                                           "title",
                                           "medium no./number of media",
                                           "type of the test",
                                           "subtype of the test",
                                           "test number",
                                           "date of the test",
                                           "regulation",
                                           "number of test objects",
                                           "name of test object 1",
                                           "mass test object 1",
                                           "velocity test object 1"};

/// The lines of a text one after the other, with their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {
    if (text_.starts_with(kByteOrderMark)) next_ = kByteOrderMark.size();
  }
  bool next() {
    if (next_ >= text_.size()) return false;
    offset_ = next_;
    const std::size_t end = text_.find('\n', offset_);
    next_ = end == std::string_view::npos ? text_.size() : end + 1;
    ++number_;
    return true;
  }
  [[nodiscard]] std::string_view line() const { return text_.substr(offset_, next_ - offset_); }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t offset_ = 0, next_ = 0, number_ = 0;
};

std::string name_in(std::string_view text) { return with_single_blanks(text.substr(0, kLongestName)); }

bool ends(std::string_view line) { return line.ends_with('\n') || line.ends_with('\r'); }

bool is_sample(std::string_view line) {
  return same_ignoring_case(trimmed(line), "NOVALUE") || parse_number(line).has_value();
}

template <std::size_t N>
bool is_one_of(const std::string_view (&names)[N], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool is_utf16(std::string_view text) { return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"); }

}  // namespace

bool is_no_value(std::string_view value) { return value.empty() || same_ignoring_case(value, "NOVALUE"); }

IsoMmeFile iso_mme_file(std::string_view text, const std::string& path) {
  constexpr std::size_t kSample = 8192, kClear = 2;
  std::size_t of_channel = 0, of_list = 0, of_test = 0, others = 0;
  Lines lines(text.substr(0, kSample));
  while (lines.next()) {
    const std::size_t colon = lines.line().find(':');
    if (colon == std::string_view::npos || colon > kLongestName) continue;
    const std::string name = to_lower(name_in(lines.line().substr(0, colon)));
    if (is_one_of(kChannelNames, name)) {
      ++of_channel;
    } else if (name == "number of channels" || name.starts_with("name of channel ")) {
      ++of_list;
    } else if (is_one_of(kTestNames, name)) {
      ++of_test;
    } else {
      ++others;
    }
  }
  if (of_channel >= kClear) return IsoMmeFile::channel;
  if (of_list >= kClear) return IsoMmeFile::channel_list;
  const bool named_so = same_ignoring_case(std::filesystem::path(path).extension().string(), ".mme");
  const bool is_test = of_test >= kClear || (named_so && of_test + others > 0) || (named_so && is_utf16(text));
  return is_test ? IsoMmeFile::test : IsoMmeFile::none;
}

std::string_view IsoMmeHeader::value(std::string_view name) const {
  for (const IsoMmeLine& line : lines)
    if (same_ignoring_case(line.name, name) && !is_no_value(line.value)) return line.value;
  return "";
}

double IsoMmeHeader::number(std::string_view name) const {
  for (const IsoMmeLine& line : lines)
    if (same_ignoring_case(line.name, name) && !is_no_value(line.value))
      return line.whole ? parse_number(line.value).value_or(kUnset) : kUnset;
  return kUnset;
}

IsoMmeHeader parse_iso_mme_header(std::string_view text, const std::string& path, bool has_samples) {
  if (is_utf16(text)) throw InvalidInput(fmt::format("{}: UTF-16 text: save it as UTF-8", path));
  IsoMmeHeader header;
  header.data_offset = text.size();
  Lines lines(text);
  while (lines.next()) {
    const std::string_view line = lines.line();
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      if (!has_samples || !is_sample(line)) continue;
      header.data_offset = lines.offset();
      break;
    }
    if (header.lines.size() >= kMostLines)
      throw InvalidInput(
          fmt::format("{}:{}: more than {} header lines: not an ISO-MME header", path, lines.number(), kMostLines));
    header.lines.push_back({to_utf8(name_in(line.substr(0, colon))),
                            to_utf8(trimmed(line.substr(colon + 1)).substr(0, kLongestValue)), ends(line)});
  }
  header.data_line = lines.number();
  return header;
}

}  // namespace crashsim::io
