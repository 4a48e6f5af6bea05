#include "io/encoding.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace crashsim::io {
namespace {

/// Code points of Windows-1252 from 0x80 to 0x9f; the five that it leaves undefined are those of Latin-1.
constexpr std::array<std::uint16_t, 32> kWindows = {0x20ac, 0x0081, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                                    0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0x008d, 0x017d, 0x008f,
                                                    0x0090, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                                    0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0x009d, 0x017e, 0x0178};

constexpr bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

/// How many bytes a character takes by its first byte, 0 when no character starts so.
std::size_t length_by_first(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  return first < 0xe0 ? 2 : (first < 0xf0 ? 3 : 4);
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = length_by_first(static_cast<unsigned char>(text.front()));
    if (length == 0 || length > text.size()) return false;
    const std::string_view rest = text.substr(1, length - 1);
    if (!std::all_of(rest.begin(), rest.end(), is_continuation)) return false;
    text.remove_prefix(length);
  }
  return true;
}

void append(unsigned code_point, std::string& text) {
  const auto add = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (code_point < 0x80U) return add(code_point);
  if (code_point < 0x800U) {
    add(0xc0U | (code_point >> 6U));
  } else {
    add(0xe0U | (code_point >> 12U));
    add(0x80U | ((code_point >> 6U) & 0x3fU));
  }
  add(0x80U | (code_point & 0x3fU));
}

}  // namespace

std::string to_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string result;
  for (const char c : text) {
    const unsigned byte = static_cast<unsigned char>(c);
    append(byte >= 0x80U && byte < 0xa0U ? kWindows[byte - 0x80U] : byte, result);
  }
  return result;
}

}  // namespace crashsim::io
