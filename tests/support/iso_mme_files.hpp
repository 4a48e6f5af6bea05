#pragma once
/// A small ISO-MME test written to a folder, to read and to spoil.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <crashsim/trace_io.hpp>

#include "support/temp_dir.hpp"

namespace crashsim::test {

using MmeLines = std::vector<std::pair<std::string, std::string>>;

inline std::string mme_text(const MmeLines& lines, const std::string& line_end = "\n") {
  std::string text;
  for (const auto& [name, value] : lines) text += fmt::format("{:<28}:{}{}", name, value, line_end);
  return text;
}

/// Descriptors of a channel file that tests vary; an empty one is left out.
struct MmeChannel {
  std::string code = "10VEHCCG0000ACXP", name = "Centre of gravity X", unit = "m/(s*s)";
  std::string first = "-0.0002", interval = "0.0001", count = "5", status = "ok", direction = "X";
  std::string reference = "implicit", reference_name = "NOVALUE", object = "1";
  std::string samples = "0.5\n1.5\n-2.5E+0\nNOVALUE\n4\n";
  MmeLines more = {};
};

inline std::string channel_text(const MmeChannel& c, const std::string& line_end = "\n") {
  MmeLines lines = {{"Test object number", c.object},   {"Name of the channel", c.name},
                    {"Channel code", c.code},           {"Location", c.code},
                    {"Direction", c.direction},         {"Channel frequency class", "NOVALUE"},
                    {"Sampling interval", c.interval},  {"Unit", c.unit},
                    {"Time of first sample", c.first},  {"Number of samples", c.count},
                    {"Reference channel", c.reference}, {"Reference channel name", c.reference_name},
                    {"Data status", c.status}};
  lines.insert(lines.end(), c.more.begin(), c.more.end());
  std::erase_if(lines, [](const auto& line) { return line.second.empty(); });
  return mme_text(lines, line_end) + c.samples;
}

inline MmeLines test_lines() {
  return {{"Data format edition number", "1.6"}, {"Laboratory name", "Lab"},       {"Title", "SMALL CAR"},
          {"Number of test objects", "1"},       {"Name of test object 1", "Car"}, {"Velocity test object 1", "15.5"},
          {"Mass test object 1", "1500 kg"}};
}

/// Reads a channel file alone.
inline TraceSet read_one(const MmeChannel& channel) {
  const TempDir dir;
  return read_traces(dir.file("test.001", channel_text(channel)));
}

/// Writes TEST.mme, Channel/TEST.chn and the channel files into a folder; returns the path of TEST.mme.
inline std::string write_mme(const TempDir& dir, const std::vector<MmeChannel>& channels,
                             const MmeLines& lines = test_lines()) {
  std::filesystem::create_directories(dir.path("Channel"));
  MmeLines list = {{"Instrumentation standard", "NOVALUE"}, {"Number of channels", std::to_string(channels.size())}};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    list.emplace_back(fmt::format("Name of channel {:03}", i + 1),
                      fmt::format("{} / {}", channels[i].code, channels[i].name));
    dir.file(fmt::format("Channel/test.{:03}", i + 1), channel_text(channels[i]));
  }
  dir.file("Channel/test.chn", mme_text(list));
  return dir.file("test.mme", mme_text(lines));
}

}  // namespace crashsim::test
