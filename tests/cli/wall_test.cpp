/// crashsim wall, from a test's header to what drives heave and pitch.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/nhtsa_files.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::AllOf;
using testing::HasSubstr;

class WallCommand : public testing::Test {
 protected:
  /// A test with a compartment channel and a wall of 6 rows and 2 columns, one cell of which failed.
  void SetUp() override {
    const auto half_sine = [](double t) { return t > 0.0 && t < 0.1 ? std::sin(std::numbers::pi * t / 0.1) : 0.0; };
    std::vector<test::NhtsaRecord> records = {{.curve = 1, .first = "-200", .last = "2000"}};
    workspace.file("v01.001", test::sample_rows(records[0], [&](double t) { return -27.0 * half_sine(t); }));
    for (int row = 1; row <= 6; ++row)
      for (int column = 1; column <= 2; ++column) {
        const int curve = static_cast<int>(records.size()) + 1;
        records.push_back(test::cell_record(curve, fmt::format("LC{:02}{:02}", row, column), "CELL"));
        workspace.file(fmt::format("v01.{:03}", curve),
                       test::sample_rows(records.back(), [&](double t) { return -35e3 * half_sine(t); }));
      }
    records.back().data_status = "CF";
    workspace.file("v01.EV5", test::header_text(records));
  }
  test::Workspace workspace;
};

TEST_F(WallCommand, TellsItsNumbersAndWritesRows) {
  const Finished finished = workspace.run({"wall", "v01.EV5", "--pulse", "v01.EV5", "-o", "wall.csv", "--json"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  const auto json = nlohmann::json::parse(finished.out);
  EXPECT_EQ(json["cells"], 11);
  EXPECT_EQ(json["cells_excluded"], 1);
  EXPECT_THAT(json["excluded"].get<std::string>(), HasSubstr("F-02 (channel 13)"));
  for (const char* key : {"peak_force_n", "peak_time_s", "impulse_ns", "ahof400_m", "kw400_n_per_m", "mean_height_m"})
    EXPECT_TRUE(json[key].is_number()) << key;
  EXPECT_NEAR(json["impulse_ns"].get<double>(), 11.0 * 35e3 * 0.2 / std::numbers::pi, 30.0);
  EXPECT_THAT(workspace.text_of("wall.csv"),
              AllOf(HasSubstr("# row_a_height_m = 0.6875"), HasSubstr("# left_out = F-02"),
                    HasSubstr("time_s,total_force_n,force_height_m,row_a_force_n,row_b_force_n"),
                    HasSubstr("row_f_force_n,column_01_force_n,column_02_force_n\n")));
}

TEST_F(WallCommand, WhatItWritesDrivesHeaveAndPitch) {
  ASSERT_EQ(workspace.run({"wall", "v01.EV5", "-o", "wall.csv"}).exit_code, kDone);
  const Finished finished = workspace.run({"pitch", "data/paper/table1.json", "--force", "wall.csv", "--start",
                                           "impact", "--cg-height", "0.6m", "-o", "pitch.csv", "--json"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_GT(std::abs(nlohmann::json::parse(finished.out)["pitch_max_rad"].get<double>()), 1e-4);
}

TEST_F(WallCommand, ItsRecordMakesTheSameFileAgain) {
  ASSERT_EQ(
      workspace.run({"wall", "v01.EV5", "--pulse", "v01.EV5", "--lower-edge", "80mm", "-o", "wall.csv"}).exit_code,
      kDone);
  const Finished again = workspace.run({"run", "wall.csv", "-o", "again.csv"});
  ASSERT_EQ(again.exit_code, kDone) << again.err;
  EXPECT_EQ(workspace.text_of("again.csv"), workspace.text_of("wall.csv"));
}

TEST_F(WallCommand, AFileWithoutCellsSaysWhatToDo) {
  const Finished finished = workspace.run({"wall", "data/fe-car/C56.csv", "--json"});
  EXPECT_EQ(finished.exit_code, kUserCanFix);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("no load cells"), HasSubstr("--row")));
}

}  // namespace
}  // namespace crashsim
