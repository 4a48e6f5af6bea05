#include <crashsim/files.hpp>

#include <cmath>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/table_io.hpp>

#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Files, AFileComesBackAsWrittenAndLeavesNothingBeside) {
  const test::TempDir dir;
  const std::string path = dir.path("a.txt");
  write_file_atomically(path, std::string_view("one\0two\n", 8), false);
  EXPECT_EQ(read_file(path), std::string_view("one\0two\n", 8));
  write_file_atomically(path, "", true);
  EXPECT_EQ(read_file(path), "");
  EXPECT_EQ(files_in(dir.path("")), 1u);
}

TEST(Files, AnExistingFileIsReplacedOnlyWhenAsked) {
  const test::TempDir dir;
  const std::string path = dir.file("a.txt", "old");
  EXPECT_THAT([&] { write_file_atomically(path, "new", false); },
              ThrowsMessage<InvalidInput>(HasSubstr("a.txt: exists already")));
  EXPECT_EQ(read_file(path), "old");
  write_file_atomically(path, "new", true);
  EXPECT_EQ(read_file(path), "new");
}

TEST(Files, ALinkKeepsPointingAndADeviceStaysADevice) {
  const test::TempDir dir;
  const std::string target = dir.file("target.txt", "old");
  fs::create_symlink("target.txt", dir.path("link.txt"));
  write_file_atomically(dir.path("link.txt"), "new", true);
  EXPECT_TRUE(fs::is_symlink(dir.path("link.txt")));
  EXPECT_EQ(read_file(target), "new");
  write_file_atomically("/dev/null", "gone", false);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Files, FailuresNameThePathAndTheReason) {
  const test::TempDir dir;
  EXPECT_THAT([&] { write_file_atomically(dir.path("no/such/a.txt"), "x", false); },
              ThrowsMessage<SystemFailure>(HasSubstr("no/such/a.txt: cannot be written: No such file or directory")));
  EXPECT_THAT([&] { write_file_atomically(dir.path(""), "x", true); },
              ThrowsMessage<InvalidInput>(HasSubstr("is a folder: name a file to write")));
  EXPECT_THAT([&] { read_file(dir.path("absent.csv")); },
              ThrowsMessage<InvalidInput>(HasSubstr("absent.csv: no such file")));
  EXPECT_THAT([&] { read_file(dir.path("")); }, ThrowsMessage<InvalidInput>(HasSubstr("is a folder, not a file")));
  const std::string loop = dir.path("loop");
  fs::create_symlink("loop", loop);
  EXPECT_THAT([&] { read_file(loop); }, ThrowsMessage<InvalidInput>(HasSubstr("loop: cannot be read: ")));
}

TEST(Files, Sha256IsThePublishedDigest) {
  const test::TempDir dir;
  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256_of_file(dir.file("abc", "abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(dir.file("none", "")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(WriteCsv, WritesCommentsNamesAndShortestNumbers) {
  const test::TempDir dir;
  const std::vector<double> t = {0.0, 1e-4}, v = {-1.0 / 3.0, std::nan("")};
  write_csv(dir.path("a.csv"), {{"mass_kg", "1719"}, {"note", "two\nlines"}}, {{"time_s", t}, {"velocity_mps", v}});
  EXPECT_EQ(read_file(dir.path("a.csv")),
            "# mass_kg = 1719\n# note = two lines\ntime_s,velocity_mps\n0,-0.3333333333333333\n1e-04,\n");
  EXPECT_THAT([&] { write_csv(dir.path("a.csv"), {}, {}); }, ThrowsMessage<InvalidInput>(HasSubstr("exists already")));
}

TEST(WriteCsv, HoldsTheLongestNumbers) {
  const std::vector<double> longest(1000, -1.2345678901234567e-300);
  const std::string text = format_csv({}, {{"x", longest}});
  EXPECT_EQ(text.size(), 2 + 1000 * std::string_view("-1.2345678901234567e-300\n").size());
}

TEST(WriteCsv, RefusesColumnsOfDifferentLengths) {
  const std::vector<double> two(2), three(3);
  EXPECT_THAT(
      [&] {
        format_csv({}, {{"time_s", two}, {"accel_mps2", three}});
      },
      ThrowsMessage<InvalidInput>(HasSubstr("column accel_mps2 has 3 cells, time_s has 2")));
}

}  // namespace
}  // namespace crashsim
