#include "generated_traces.hpp"

#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "support/lsda_writer.hpp"
#include "support/random.hpp"

namespace crashsim::bench {
namespace {

constexpr std::size_t kMegabyte = 1000 * 1000;
constexpr int kNodes = 500;
constexpr std::uint64_t kSeed = 1;

void save(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

double sample(test::Random& random) { return random.between(-300.0, 300.0); }

std::string channel_file(test::Random& random, int first, int last) {
  std::string text;
  for (int i = first; i <= last; ++i) text += fmt::format("{:.6f}\t{:.6e}\n", 1e-4 * i, sample(random));
  return text;
}

std::string node_rows(test::Random& random, int columns) {
  std::string text;
  for (int node = 1; node <= kNodes; ++node) {
    text += fmt::format("{:10d}", 1000000 + node);
    for (int column = 0; column < columns; ++column)
      text += fmt::format("{:{}.5E}", sample(random), column == 0 ? 13 : 12);
    text += '\n';
  }
  return text;
}

std::string state_head(int step, double time, const char* columns) {
  return fmt::format(
      "\n\n\n n o d a l   p r i n t   o u t   f o r   t i m e  s t e p{:8d}                              ( at time "
      "{:.7E} )\n\n nodal point  {}\n",
      step, time, columns);
}

}  // namespace

std::string write_ev5(const std::string& folder, std::size_t megabytes) {
  constexpr int kFirst = -500, kLast = 2999;
  test::Random random(kSeed);
  const std::size_t channels = megabytes * kMegabyte / channel_file(random, kFirst, kLast).size();
  std::string header =
      "----- EV5 -----\n----- TEST -----\n"
      "V5|BENCHMARK|OBJ|01/JAN/2020|LAB|1|2|NCA|VTB|CON|DRY|22|OTH|OTH|56|0|0|0|1|\n----- INSTRUMENTATION -----\n";
  for (std::size_t i = 1; i <= channels; ++i) {
    header += fmt::format("1|{}|AC|NA|FLLR|XG|SEC|G'S|2800|ACME|01/JAN/2020|800|10|56|{}|{}|100|AM|P|CHANNEL {}\n", i,
                          kFirst, kLast, i);
    save(fmt::format("{}/v1.{:03}", folder, i), channel_file(random, kFirst, kLast));
  }
  save(folder + "/v1.EV5", header + "----- END -----\n");
  return folder + "/v1.EV5";
}

std::string write_nodout(const std::string& folder, std::size_t megabytes) {
  test::Random random(kSeed);
  const std::string translations = node_rows(random, 12), rotations = node_rows(random, 9);
  const std::size_t states = megabytes * kMegabyte / (translations.size() + rotations.size());
  std::string text = " A benchmark\n                    ls-dyna smp d R13 date 01/01/2024\n\n";
  for (std::size_t i = 0; i < states; ++i) {
    const int step = static_cast<int>(i) + 1;
    const double time = 1e-4 * static_cast<double>(i);
    text += state_head(step, time,
                       "x-disp     y-disp      z-disp      x-vel       y-vel       z-vel      x-accl      y-accl      "
                       "z-accl      x-coor      y-coor      z-coor") +
            translations;
    text += state_head(step, time,
                       "x-rot      y-rot       z-rot       x-rot vel   y-rot vel   z-rot vel   x-rot acc   y-rot acc  "
                       " z-rot acc") +
            rotations;
  }
  save(folder + "/nodout", text);
  return folder + "/nodout";
}

std::string write_binout(const std::string& folder, std::size_t megabytes) {
  constexpr const char* kVariables[] = {"x_displacement", "y_displacement", "z_displacement", "x_velocity",
                                        "y_velocity",     "z_velocity",     "x_acceleration", "y_acceleration",
                                        "z_acceleration", "x_coordinate",   "y_coordinate",   "z_coordinate"};
  test::Random random(kSeed);
  test::LsdaWriter file;
  file.cd("/nodout/metadata");
  file.write("title", "A benchmark", 80);
  std::vector<std::int32_t> ids(kNodes);
  for (int i = 0; i < kNodes; ++i) ids[static_cast<std::size_t>(i)] = 1000001 + i;
  file.write("ids", ids);
  std::vector<float> values(kNodes);
  for (float& value : values) value = static_cast<float>(sample(random));
  for (std::size_t state = 1; file.bytes().size() < megabytes * kMegabyte; ++state) {
    file.cd(fmt::format("/nodout/d{:06}", state));
    file.write("time", static_cast<float>(1e-5 * static_cast<double>(state)));
    file.write("cycle", static_cast<std::int32_t>(state));
    for (const char* name : kVariables) file.write(name, values);
  }
  file.save();
  save(folder + "/binout0000", file.bytes());
  return folder + "/binout0000";
}

std::string write_csv_table(const std::string& folder, std::size_t megabytes) {
  constexpr int kChannels = 20;
  test::Random random(kSeed);
  std::string text = "time_s";
  for (int channel = 1; channel <= kChannels; ++channel) text += fmt::format(",a{}_mps2", channel);
  text += '\n';
  for (int row = 0; text.size() < megabytes * kMegabyte; ++row) {
    text += fmt::format("{:.6f}", 1e-5 * row);
    for (int channel = 0; channel < kChannels; ++channel) text += fmt::format(",{:.6g}", sample(random));
    text += '\n';
  }
  save(folder + "/table.csv", text);
  return folder + "/table.csv";
}

}  // namespace crashsim::bench
