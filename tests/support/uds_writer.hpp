#pragma once
/// Files of NHTSA's binary format UDS-1992, to read and to spoil.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crashsim::test {

/// Writes a UDS-1992 file record by record, in one of its number formats.
class UdsWriter {
 public:
  explicit UdsWriter(std::string format) : format_(std::move(format)) {}

  UdsWriter& text(std::string_view value, std::size_t length) {
    record_ += std::string(value.substr(0, length)) + std::string(length - std::min(length, value.size()), ' ');
    return *this;
  }
  UdsWriter& integer(std::int32_t value) { return word(static_cast<std::uint32_t>(value)); }
  UdsWriter& real(float value) {
    if (format_ != "VAX") return word(std::bit_cast<std::uint32_t>(value));
    int exponent = 0;
    const double fraction = std::frexp(std::abs(static_cast<double>(value)), &exponent);  // 0.5 <= fraction < 1
    if (value == 0.0F) return word(0);
    const auto mantissa = static_cast<std::uint32_t>(std::ldexp(fraction, 24)) & 0x7fffffU;
    const std::uint32_t bits =
        (value < 0 ? 0x80000000U : 0U) | (static_cast<std::uint32_t>(exponent + 128) << 23) | mantissa;
    return word((bits << 16) | (bits >> 16));
  }
  UdsWriter& end() {
    record_.resize(512, '\0');
    file_ += record_;
    record_.clear();
    return *this;
  }

  UdsWriter& header(int channels = 1, std::string_view version = "UDS-1992") {
    text(version, 12).integer(channels).text("Y", 10).text(format_, 5).text("MET", 3).text("VEHICLE DB", 15);
    integer(7201).text("7201", 12).text("SMALL CAR", 70).text("LAB", 25).text("REF", 10).text("VTB", 3);
    integer(0).real(57.6F);
    return component(1).real(120.0F).real(1).real(2).real(36).real(40).real(300).text("1", 1).end();
  }
  UdsWriter& component(int number) {
    integer(number).text("VE", 2).text("CAR", 30).text("TOYOTA", 15).text("CAMRY", 25).integer(2018).text("SEDAN", 25);
    text("4CIF", 4).real(1500.0F).real(57.6F).text("H3", 6).integer(0).text("M", 1).real(0).text("50", 2);
    return text("3 POINT BELT", 20).text("", 20);
  }
  UdsWriter& curve(int number, int first, int last, std::string_view form = "Y", std::string_view unit = "G'S",
                   std::string_view status = "AS MEASURED", std::string_view x_unit = "SECONDS") {
    text("CURVE HDR", 12).integer(1).text(form, 10).integer(number).text("1", 12).text("FLOORPAN - LEFT REAR", 30);
    text("NA", 2).integer(0).integer(0).integer(0).text("XG", 2).text("ACCELERATION", 20).text(unit, 20);
    text("TIME", 20).text(x_unit, 20).text(status, 20).text("TIME SERIES", 20).text("LEFT REAR SEAT X", 70);
    return integer(first).integer(last).real(0.0001F).real(57.6F).real(1650).end();
  }
  UdsWriter& data(std::string_view mark, const std::vector<float>& values) {
    for (std::size_t i = 0; i < values.size(); i += 125) {
      text(mark, 12);
      for (std::size_t k = i; k < std::min(values.size(), i + 125); ++k) real(values[k]);
      end();
    }
    return *this;
  }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  UdsWriter& word(std::uint32_t bits) {
    for (int i = 0; i < 4; ++i) record_ += static_cast<char>((bits >> (format_ == "SUN" ? 24 - 8 * i : 8 * i)) & 0xffU);
    return *this;
  }

  std::string format_, record_, file_;
};

}  // namespace crashsim::test
