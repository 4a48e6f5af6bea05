/// Writes small well-formed files of each format to start fuzzing from: write_seeds FOLDER, one subfolder a fuzz
/// target.

#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "support/binout_files.hpp"
#include "support/iso_mme_files.hpp"
#include "support/lsdyna_files.hpp"
#include "support/nhtsa_files.hpp"
#include "support/radioss_t01_files.hpp"
#include "support/uds_writer.hpp"

namespace crashsim::fuzz {
namespace {

namespace fs = std::filesystem;

void save(const fs::path& folder, const std::string& name, const std::string& bytes) {
  fs::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void write_csv(const fs::path& root) {
  save(root / "csv", "comma", "# mass_kg = 1500\ntime_s,accel_g,force [kN]\n0,0,1\n0.001,-1.5,2\n0.002,-3e1,nan\n");
  save(root / "csv", "decimal_comma", "time [ms];\"accel [g]\"\r\n0,0;0,0\r\n1,0;-1,5\r\n2,0;-30,0\r\n");
  save(root / "csv", "curve", "Curveplot\nTime\nA 1 #pts=2\n  0.0e+00  1.5e+01\n  1.0e-03  1.4e+01\nendcurve\n");
  save(root / "radioss_csv", "numbered",
       "\"time\",\"INTERNAL ENERGY\",\"KINETIC ENERGY\",\"part1      KE \",\"TH RWALL      1 Barrier      var 6\"\n"
       "0,1,2,3,4\n1e-3,2,3,4,5\n");
  save(root / "radioss_csv", "named", "time_s,mass_Mg,REAR_VX,REAR_VY,REAR_VZ\n0,1.2,1,2,3\n0.001,1.2,2,3,4\n");
}

void write_lsdyna_ascii(const fs::path& root) {
  const test::LsdynaPlan plan{.seed = 1, .states = 3, .first_state = 0, .entities = 2};
  save(root / "lsdyna_ascii", "nodout", test::nodout_run(plan).text);
  save(root / "lsdyna_ascii", "rcforc", test::rcforc_run(plan).text);
  save(root / "lsdyna_ascii", "rwforc", test::rwforc_run(plan).text);
  save(root / "lsdyna_ascii", "secforc", test::secforc_run(plan).text);
  save(root / "lsdyna_ascii", "rbdout", test::rbdout_run(plan).text);
  save(root / "lsdyna_ascii", "glstat", test::glstat_run(plan).text);
  save(root / "lsdyna_ascii", "matsum", test::matsum_run(plan).text);
}

void write_lsdyna_binout(const fs::path& root) {
  test::Random random(1);
  const test::BinoutData data = test::random_binout(random, 3);
  save(root / "lsdyna_binout", "single", test::binout_bytes<float>(data));
  save(root / "lsdyna_binout", "double_big_endian",
       test::binout_bytes<double>(data, {.length = 4, .offset = 4, .command = 1, .type = 1, .big_endian = true}));
}

void write_radioss_t01(const fs::path& root) {
  test::Random random(1);
  for (int i = 0; i < 4; ++i)
    save(root / "radioss_t01", fmt::format("random{}", i), test::random_radioss_t01_file(random).bytes);
}

/// Several files in one, as folder_fuzzer.cpp takes them apart.
std::string joined(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string text;
  for (const auto& [name, bytes] : files) text += fmt::format("==== {}\n{}\n", name, bytes);
  return text;
}

void write_nhtsa(const fs::path& root) {
  save(root / "nhtsa", "test",
       joined({{"v1.EV5", test::header_text({{.curve = 1}, {.curve = 2, .attachment = "FLRR"}})},
               {"v1.001", test::kFiveSamples},
               {"v1.002", test::kFiveSamples}}));
  save(root / "nhtsa", "channel", joined({{"v1.001", test::kFiveSamples}, {"v1.EV5", test::header_text({{}})}}));
  for (const char* format : {"IEEE", "SUN", "VAX"})
    save(root / "nhtsa_uds", format,
         test::UdsWriter(format)
             .header(2)
             .curve(1, -1, 1)
             .data("Y DATA", {1, 2, 3})
             .curve(2, 1, 3, "X-Y")
             .data("Y DATA", {1, 2, 3})
             .data("X DATA", {0, 1, 2})
             .file());
}

void write_iso_mme(const fs::path& root) {
  const std::string implied = test::channel_text({});
  const std::string explicit_times =
      test::channel_text({.reference = "explicit", .reference_name = "10TIRS000000TI0", .samples = "1\n2\n3\n4\n5\n"});
  const std::string times =
      test::channel_text({.code = "10TIRS000000TI00", .unit = "s", .samples = "0.0\n0.1\n0.2\n0.4\n0.5\n"});
  const std::string list = test::mme_text({{"Number of channels", "2"}, {"Name of channel 001", "10VEHCCG0000ACXP"}});
  save(root / "iso_mme", "test",
       joined({{"test.mme", test::mme_text(test::test_lines())},
               {"Channel/test.chn", list},
               {"Channel/test.001", explicit_times},
               {"Channel/test.002", times}}));
  save(root / "iso_mme", "channel", joined({{"Channel/test.001", implied}}));
}

}  // namespace
}  // namespace crashsim::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: write_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path root = argv[1];
  crashsim::fuzz::write_csv(root);
  crashsim::fuzz::write_lsdyna_ascii(root);
  crashsim::fuzz::write_lsdyna_binout(root);
  crashsim::fuzz::write_radioss_t01(root);
  crashsim::fuzz::write_nhtsa(root);
  crashsim::fuzz::write_iso_mme(root);
}
