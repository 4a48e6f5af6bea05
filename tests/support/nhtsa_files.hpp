#pragma once
/// A small NHTSA test written to a folder: header and channel files, to read and to spoil.

#include <string>
#include <vector>

#include <fmt/format.h>

#include "support/temp_dir.hpp"

namespace crashsim::test {

/// Fields of an INSTRUMENTATION record that tests vary.
struct NhtsaRecord {
  int curve = 1;
  std::string attachment = "FLLR", comment = "LEFT REAR SEAT CROSSMEMBER X";
  int vehicle = 1;
  std::string sensor = "AC", occupant = "NA", axis = "XG", unit = "G'S";
  std::string first = "-2", last = "2", step = "100", data_status = "AM", channel_status = "P";
  std::string initial_speed = "50", range = "800", x_unit = "SEC";
};

inline std::string record_line(const NhtsaRecord& r) {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|2800|ACME|01/JAN/2020|{}|10|{}|{}|{}|{}|{}|{}|{}\n", r.vehicle, r.curve,
                     r.sensor, r.occupant, r.attachment, r.axis, r.x_unit, r.unit, r.range, r.initial_speed, r.first,
                     r.last, r.step, r.data_status, r.channel_status, r.comment);
}

inline std::string vehicle_line(int number = 1, const std::string& mass = "1500", const std::string& speed = "57.6") {
  std::vector<std::string> fields(81, "0");
  fields[0] = std::to_string(number);
  fields[10] = mass;
  fields[41] = speed;
  std::string line;
  for (const std::string& field : fields) line += fmt::format("{}{}", line.empty() ? "" : "|", field);
  return line + "\n";
}

/// `test` and `barrier` are single records without their line ends.
inline std::string header_text(const std::vector<NhtsaRecord>& records, const std::string& vehicles = vehicle_line(),
                               const std::string& barrier = "R|LCB|0|0|WALL",
                               const std::string& angle_and_offset = "0|0") {
  std::string text = "# a comment\n----- EV5 -----\n----- TEST -----\n";
  text += fmt::format("V5|SMALL CAR|OBJ|01/JAN/2020|LAB|1|2|NCA|VTB|CON|DRY|22|OTH|OTH|60|{}|0|{}|\n", angle_and_offset,
                      records.size());
  text += "----- VEHICLE -----\n" + vehicles + "----- BARRIER -----\n" + barrier + "\n----- INSTRUMENTATION -----\n";
  for (const NhtsaRecord& r : records) text += record_line(r);
  return text + "----- END -----";
}

/// The rows of a channel file with the clock of a record: value(t) over time.
template <class Value>
std::string sample_rows(const NhtsaRecord& r, Value value) {
  std::string text;
  for (int i = std::stoi(r.first); i <= std::stoi(r.last); ++i) {
    const double t = i * std::stod(r.step) / 1e6;
    text += fmt::format("{:.6f}\t{:.9f}\n", t, value(t));
  }
  return text;
}

/// The record of one cell of a load-cell wall: sampled every 1 ms from -20 to 200 ms.
inline NhtsaRecord cell_record(int curve, const std::string& attachment, const std::string& comment) {
  return {.curve = curve,
          .attachment = attachment,
          .comment = comment,
          .vehicle = 0,
          .sensor = "LC",
          .unit = "NWT",
          .first = "-20",
          .last = "200",
          .step = "1000",
          .range = "300000"};
}

inline constexpr const char* kFiveSamples =
    "-0.000200\t0.0\n-0.000100\t0.0\n0.000000\t0.5\n0.000100\t-1.0\n0.000200\t-2.0\n";

}  // namespace crashsim::test
