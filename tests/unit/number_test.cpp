#include "number.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace crashsim {
namespace {

double scanned(const std::string& text) {
  double value = std::nan("");
  const char* end = scan_number(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(end, text.data() + text.size()) << text;
  return value;
}

TEST(ScanNumber, AgreesBitForBitWithFromChars) {
  std::uint64_t state = 1;
  const auto next = [&state] { return state = state * 6364136223846793005u + 1442695040888963407u; };
  for (int i = 0; i < 20000; ++i) {
    const auto digits = static_cast<std::int64_t>(next() >> 11) >> (next() >> 58);
    const int decimals = static_cast<int>((next() >> 33) % 12), exponent = static_cast<int>((next() >> 33) % 40) - 20;
    const std::string whole = std::to_string(next() >> 63 ? -digits : digits);
    for (const std::string& text : {fmt::format("{}.{:0>{}}", whole, (next() >> 33) % 1000, decimals + 3),
                                    fmt::format("{}e{}", whole, exponent), fmt::format("{}E+{:02}", whole, decimals)}) {
      double expected = 0.0;
      std::string plain = text;
      if (const auto plus = plain.find('+'); plus != std::string::npos) plain.erase(plus, 1);
      ASSERT_EQ(std::from_chars(plain.data(), plain.data() + plain.size(), expected).ec, std::errc()) << text;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(scanned(text)), std::bit_cast<std::uint64_t>(expected)) << text;
    }
  }
}

TEST(ScanNumber, TakesSpecialAndExtremeNumbers) {
  EXPECT_TRUE(std::signbit(scanned("-0.0")));
  EXPECT_EQ(scanned(".5"), 0.5);
  EXPECT_EQ(scanned("5."), 5.0);
  EXPECT_EQ(scanned("1e-320"), 1e-320);
  EXPECT_EQ(scanned("1e9999"), INFINITY);
  EXPECT_EQ(scanned("-1e-9999"), 0.0);
  EXPECT_EQ(scanned("123456789012345678901234567890"), 123456789012345678901234567890.0);
  EXPECT_TRUE(std::isnan(scanned("NaN")));
  EXPECT_EQ(scanned("-inf"), -INFINITY);
}

TEST(ScanNumber, StopsWhereTheNumberEnds) {
  const std::string text = "1.5e2e3,4";
  double value = 0.0;
  EXPECT_EQ(scan_number(text.data(), text.data() + text.size(), value) - text.data(), 5);
  EXPECT_EQ(value, 150.0);
  const std::string unit = "5em";
  EXPECT_EQ(scan_number(unit.data(), unit.data() + unit.size(), value) - unit.data(), 1);
  const std::string none = "abc";
  EXPECT_EQ(scan_number(none.data(), none.data() + none.size(), value), none.data());
}

}  // namespace
}  // namespace crashsim
