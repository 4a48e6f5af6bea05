/// Load-cell walls, from generated NHTSA tests with known forces and from the rows of a real one.

#include <crashsim/load_cell_wall.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/nhtsa_files.hpp"
#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using test::cell_record;
using test::NhtsaRecord;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr double kDuration_s = 0.1;
constexpr double kPrinted = 1e-8;  // of the force: nine decimals

double half_sine(double t) { return t > 0.0 && t < kDuration_s ? std::sin(std::numbers::pi * t / kDuration_s) : 0.0; }
/// Force on a cell of the test walls [N].
double cell_peak(int row, int column) { return 1000.0 * row + 10.0 * column; }

/// An NHTSA test of cells "LCrrcc", to spoil before it is written.
struct Wall {
  test::TempDir dir;
  std::vector<NhtsaRecord> records;
  std::vector<std::string> samples;

  void add(NhtsaRecord record, const std::function<double(double)>& force_n) {
    record.curve = static_cast<int>(records.size()) + 1;
    samples.push_back(test::sample_rows(record, force_n));
    records.push_back(std::move(record));
  }
  void add_cells(int first_row, int last_row, int columns) {
    for (int row = first_row; row <= last_row; ++row)
      for (int column = 1; column <= columns; ++column)
        add(cell_record(0, fmt::format("LC{:02}{:02}", row, column), fmt::format("CELL {} {} FORCE", row, column)),
            [=](double t) { return -cell_peak(row, column) * half_sine(t); });
  }
  [[nodiscard]] std::string write() const {
    for (std::size_t i = 0; i < records.size(); ++i)
      if (!samples[i].empty()) dir.file(fmt::format("v01.{:03}", records[i].curve), samples[i]);
    return dir.file("v01.EV5", test::header_text(records));
  }
};

WallOptions unfiltered() {
  WallOptions options;
  options.cfc = 0.0;
  return options;
}

double value_at(const std::vector<double>& values, const LoadCellWall& wall, double t) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(wall.time_s[i] - t) < 1e-9) return values[i];
  return kUnset;
}

TEST(LoadCellWall, KnownCellsGiveKnownRowsColumnsTotalAndHeight) {
  constexpr int kRows = 11, kColumns = 3;
  Wall test;
  test.add_cells(1, kRows, kColumns);
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  EXPECT_EQ(wall.cells, 33);
  EXPECT_EQ(wall.coverage, 1.0);
  EXPECT_THAT(wall.excluded, IsEmpty());
  EXPECT_THAT(wall.warnings, IsEmpty());
  EXPECT_THAT(wall.steps,
              Contains(HasSubstr("rows of 0.125 m, by their number, row a on top: heights 0.0625 to 1.312")));
  ASSERT_EQ(wall.rows.size(), 11u);
  ASSERT_EQ(wall.cell_columns.size(), 3u);
  EXPECT_EQ(wall.rows[0].name, "a");
  EXPECT_EQ(wall.rows[10].name, "k");
  EXPECT_NEAR(wall.rows[10].height_m, 0.0625, 1e-15);
  EXPECT_EQ(wall.cell_columns[2].name, "03");
  double total = 0.0, moment = 0.0;
  for (int row = 1; row <= kRows; ++row) {
    const double peak = 3000.0 * row + 60.0;
    total += peak;
    moment += peak * (kRows - row + 0.5) * 0.125;
    EXPECT_NEAR(value_at(wall.rows[static_cast<std::size_t>(row) - 1].force_n, wall, 0.03), peak * half_sine(0.03),
                kPrinted * peak);
  }
  for (const double t : {0.0, 0.02, 0.05, 0.12}) {
    EXPECT_NEAR(value_at(wall.total_force_n, wall, t), total * half_sine(t), kPrinted * total) << t;
    EXPECT_NEAR(value_at(wall.force_height_m, wall, t), moment / total, kPrinted) << t;
  }
  EXPECT_NEAR(value_at(wall.cell_columns[1].force_n, wall, 0.05), 66000.0 + 11.0 * 20.0, kPrinted * total);
}

TEST(LoadCellWall, CellsAreFilteredByCfc60) {
  constexpr double kTone_hz = 100.0, kGain = 0.70725;  // of both passes at 10 kHz
  constexpr double kTolerance = 0.01;                  // regression: what the ends of the record add
  Wall test;
  for (int row = 1; row <= 5; ++row) {
    NhtsaRecord record = cell_record(0, fmt::format("LC{:02}01", row), "CELL");
    record.first = "-200";
    record.last = "2000";
    record.step = "100";
    test.add(record, [=](double t) { return 1e4 * std::sin(2.0 * std::numbers::pi * kTone_hz * t); });
  }
  const std::string path = test.write();
  const LoadCellWall filtered = read_wall(path), plain = read_wall(path, unfiltered());
  EXPECT_THAT(filtered.steps, Contains("filter: CFC60, forward and backward"));
  for (const double crest_s : {0.0525, 0.1025, 0.1525}) {
    const double gain =
        std::abs(value_at(filtered.total_force_n, filtered, crest_s) / value_at(plain.total_force_n, plain, crest_s));
    EXPECT_NEAR(gain, kGain, kTolerance * kGain) << crest_s;
  }
}

TEST(LoadCellWall, TheOffsetBeforeImpactIsTakenOff) {
  Wall test;
  for (int row = 1; row <= 5; ++row)
    test.add(cell_record(0, fmt::format("LC{:02}01", row), "CELL"),
             [](double t) { return 700.0 + 1e4 * half_sine(t); });
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  EXPECT_NEAR(value_at(wall.total_force_n, wall, 0.05), 5e4, 1e-3);
  EXPECT_NEAR(value_at(wall.total_force_n, wall, 0.15), 0.0, 1e-3);
}

TEST(LoadCellWall, NumbersOfCrushAreTheClosedForms) {
  Wall test;
  test.add_cells(4, 11, 2);
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  Pulse pulse;  // crush grows by 10 m/s
  pulse.time_s = {0.0, 0.1, 0.2};
  pulse.velocity_mps = {10.0, 10.0, 4.0};
  pulse.displacement_m = {0.0, 1.0, 1.7};
  pulse.mass_kg = 1500.0;
  const WallNumbers numbers = wall_numbers(wall, &pulse);
  double peak = 0.0, moment = 0.0;
  for (int row = 4; row <= 11; ++row) {
    peak += 2000.0 * row + 30.0;
    moment += (2000.0 * row + 30.0) * (11 - row + 0.5) * 0.125;
  }
  constexpr double kPi = std::numbers::pi, kTrapezoids = 2e-4;  // (pi 0.01)^2 / 12, steps of 10 mm
  const double work = peak / kPi * (std::cos(0.025 * kPi) - std::cos(0.4 * kPi));
  EXPECT_NEAR(numbers.kw400_n_per_m / (2.0 * work / (0.16 - 0.000625)), 1.0, kTrapezoids);
  EXPECT_NEAR(numbers.ahof400_m, moment / peak, kPrinted);
  EXPECT_NEAR(numbers.mean_height_m, moment / peak, kPrinted);
  EXPECT_NEAR(numbers.peak_force_n / peak, 1.0, kPrinted);
  EXPECT_NEAR(numbers.peak_time_s, 0.05, 1e-9);
  EXPECT_NEAR(numbers.impulse_ns / (peak * kDuration_s * 2.0 / kPi), 1.0, kTrapezoids);
  EXPECT_NEAR(numbers.momentum_change_ns, 1500.0 * 3.0, 1e-6);
  EXPECT_THAT(check_momentum(numbers), ElementsAre(HasSubstr("from the vehicle's change of momentum, 4500 N s")));
  EXPECT_TRUE(std::isnan(wall_numbers(wall).kw400_n_per_m));
  EXPECT_THAT(check_momentum(wall_numbers(wall)), IsEmpty());
}

TEST(LoadCellWall, TheHeightFollowsTheForce) {
  Wall test;
  test.add(cell_record(0, "LC0101", "TOP"), [](double t) { return 1e5 * half_sine(t) * t / kDuration_s; });
  test.add(cell_record(0, "LC0201", "BOTTOM"), [](double t) { return 1e5 * half_sine(t) * (1.0 - t / kDuration_s); });
  WallOptions options = unfiltered();
  options.cell_height_m = 0.5;
  options.lower_edge_m = 0.1;
  const std::string path = test.write();
  const LoadCellWall wall = read_wall(path, options);
  for (const double t : {0.02, 0.05, 0.09})
    EXPECT_NEAR(value_at(wall.force_height_m, wall, t), 0.1 + 0.25 + 0.5 * t / kDuration_s, kPrinted) << t;
  EXPECT_EQ(wall.force_height_m.front(), value_at(wall.force_height_m, wall, 0.0)) << "held where there is no force";
  options.top_row = TopRow::last;
  const LoadCellWall turned = read_wall(path, options);
  EXPECT_NEAR(value_at(turned.force_height_m, turned, 0.02), 0.1 + 0.75 - 0.5 * 0.2, kPrinted);
}

TEST(LoadCellWall, TheOlderWallHasLetteredRowsAndTallCells) {
  Wall test;
  for (const char row : {'A', 'B', 'C', 'D'})
    for (int column = 1; column <= 9; ++column)
      test.add(cell_record(0, fmt::format("LC{}{}", row, column), "CELL"), [](double t) { return 1e3 * half_sine(t); });
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  EXPECT_EQ(wall.cells, 36);
  EXPECT_NEAR(wall.rows[0].height_m, 3.5 * 0.2460625, 1e-12);
  EXPECT_NEAR(wall.force_height_m[50], 2.0 * 0.2460625, 1e-9);
  EXPECT_THAT(wall.warnings,
              ElementsAre(HasSubstr("heights are an assumption until cell_height_m and top_row are given")));
}

TEST(LoadCellWall, PlacesMayStandInTheCommentAlone) {
  Wall test;
  for (const char row : {'J', 'K'})
    test.add(cell_record(0, "OTHR", fmt::format("BARRIER {}-01 Fx", row)), [](double t) { return 1e4 * half_sine(t); });
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  EXPECT_EQ(wall.cells, 2);
  EXPECT_EQ(wall.rows[1].name, "k");
}

TEST(LoadCellWall, WhatIsNoForceOfTheBarrierAlongXIsNoCell) {
  Wall test;
  test.add_cells(1, 5, 2);
  const auto other = [&](auto change) {
    NhtsaRecord record = cell_record(0, "LC0101", "OTHER");
    change(record);
    test.add(record, [](double) { return 1e5; });
  };
  other([](NhtsaRecord& r) { r.unit = "NWM"; });  // a moment labelled XG
  other([](NhtsaRecord& r) { r.axis = "YG"; });
  other([](NhtsaRecord& r) { r.vehicle = 1; });
  other([](NhtsaRecord& r) { r.sensor = "AC"; });
  other([](NhtsaRecord& r) { r.attachment = "LOAD"; });
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  EXPECT_EQ(wall.cells, 10);
  EXPECT_THAT(wall.excluded, IsEmpty());
  EXPECT_EQ(wall.input_files.size(), 11u) << "the others are not even opened";
}

TEST(LoadCellWall, CellsThatCannotBeTrustedAreLeftOutByName) {
  Wall test;
  test.add_cells(1, 5, 3);
  test.records[0].data_status = "CF";
  test.samples[1].clear();                                                           // no file
  test.samples[2] = test::sample_rows(test.records[2], [](double) { return 5.0; });  // dead
  test.records[3].range = "2";                                                       // kN, it bears 2.01
  test.samples[4] = test::sample_rows(test.records[4], [](double t) { return t > 0.1 ? std::nan("") : t; });
  test.records[5].step = "500";  // another clock
  test.samples[5] = test::sample_rows(test.records[5], [](double t) { return -1e3 * half_sine(t); });
  test.records[6].attachment = test.records[7].attachment;
  const LoadCellWall wall = read_wall(test.write(), unfiltered());
  EXPECT_EQ(wall.cells, 8);
  EXPECT_NEAR(wall.coverage, 8.0 / 15.0, 1e-12);
  EXPECT_THAT(wall.excluded, ElementsAre("A-01 (channel 1): its source says that the channel failed (DASTAT CF)",
                                         "A-02 (channel 2): its file v01.002 is not beside the header",
                                         "A-03 (channel 3): it is 5 N at all times",
                                         "B-01 (channel 4): it reaches 2.01 kN, beyond its range of 2 kN",
                                         "B-02 (channel 5): some samples are not finite",
                                         "C-02 (channel 8): another channel of this cell is used",
                                         "B-03 (channel 6): it has other sample times than most cells"));
  EXPECT_THAT(wall.warnings, Contains(HasSubstr("left out: A-01 (channel 1)")));
  EXPECT_THAT(wall.warnings, Contains(HasSubstr("1 of 15 places")));
  EXPECT_EQ(wall.rows.front().name, "c") << "rows without any cell are absent, heights are not changed by it";
  EXPECT_NEAR(wall.rows.front().height_m, 2.5 * 0.125, 1e-12);
}

TEST(LoadCellWall, FilesWithoutCellsAreRefused) {
  const test::TempDir dir;
  const std::string path = dir.file("v01.EV5", test::header_text({{}}));
  EXPECT_THAT([&] { read_wall(path); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("v01.EV5: no load cells"), HasSubstr("--row"))));
  const std::string absent = dir.file("v02.EV5", test::header_text({cell_record(1, "LC0101", "CELL")}));
  EXPECT_THAT([&] { read_wall(absent); },
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("none of 1 load cells can be used"), HasSubstr("v02.001 is not beside the header"))));
  WallOptions options;
  options.end_s = -1.0;
  EXPECT_THAT([&] { read_wall(path, options); }, ThrowsMessage<InvalidInput>(HasSubstr("end_s = -1 s")));
}

TEST(LoadCellWall, RowSumsAreReadByNameOrChoice) {
  const test::TempDir dir;
  std::string text = "time_s,row_a_n,row_b_n,lower_n,t_m_s\n";
  for (int i = 0; i <= 150; ++i) {
    const double f = half_sine(i / 1000.0);
    text += fmt::format("{},{:.9g},{:.9g},{:.9g},{}\n", i / 1000.0, 1e4 * f, 2e4 * f, 3e4 * f, i);
  }
  const std::string path = dir.file("rows.csv", text);
  const LoadCellWall named = read_wall(path);
  EXPECT_EQ(named.cells, 2);
  EXPECT_THAT(named.cell_columns, IsEmpty());
  EXPECT_THAT(named.steps, Contains("filter: none"));
  EXPECT_NEAR(value_at(named.total_force_n, named, 0.05), 3e4, 1e-3);
  EXPECT_NEAR(named.force_height_m[50], (1.5 + 2.0 * 0.5) / 3.0 * 0.2460625, 1e-8);
  const auto assumed = HasSubstr("heights are an assumption until cell_height_m and top_row are given");
  EXPECT_THAT(named.warnings, Contains(assumed));
  WallOptions given;
  given.cell_height_m = 0.125;
  EXPECT_THAT(read_wall(path, given).warnings, testing::Not(Contains(assumed)));
  WallOptions options;
  options.rows = {"row_b_n", "lower_n"};
  EXPECT_NEAR(value_at(read_wall(path, options).total_force_n, named, 0.05), 5e4, 1e-3);
  options.rows = {"t_m_s"};
  EXPECT_THAT([&] { read_wall(path, options); },
              ThrowsMessage<InvalidInput>(HasSubstr("measures time; the force on a row of cells is needed")));
}

/// The row sums of test 10146, filtered by CFC60, against what is known of its 176 cells.
TEST(LoadCellWall, TheCamryRowsGiveItsImpulseAndHeights) {
  const auto rows = test::shared_data("nhtsa-10146/barrier_rows_cfc60.csv");
  const auto header = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!rows || !header) GTEST_SKIP() << test::kNoSharedData;
  const LoadCellWall wall = read_wall(rows->string());
  const Pulse pulse = read_pulse(header->string());
  const WallNumbers numbers = wall_numbers(wall, &pulse);
  EXPECT_EQ(wall.rows.size(), 11u);
  EXPECT_NEAR(wall.rows.back().height_m, 0.0625, 1e-12) << "row K is the lowest";
  EXPECT_NEAR(numbers.impulse_ns, 32807.0, 1.0);
  EXPECT_NEAR(numbers.momentum_change_ns, 31049.0, 10.0);
  EXPECT_THAT(check_momentum(numbers), IsEmpty());
  constexpr double kKnown_m = 0.003;  // three digits, of a slightly smoother signal
  EXPECT_NEAR(numbers.mean_height_m, 0.415, kKnown_m);
  EXPECT_NEAR(value_at(wall.force_height_m, wall, 0.020), 0.385, kKnown_m);
  EXPECT_NEAR(value_at(wall.force_height_m, wall, 0.065), 0.449, kKnown_m);
  EXPECT_NEAR(numbers.kw400_n_per_m, 1016.5e3, 1e3);
  EXPECT_NEAR(numbers.ahof400_m, 0.3905, 5e-4);
  EXPECT_NEAR(numbers.peak_force_n, 731e3, 1e3);
  WallOptions again;
  again.cfc = 60.0;
  const WallNumbers smoother = wall_numbers(read_wall(rows->string(), again));
  EXPECT_NEAR(smoother.peak_force_n, 678e3, 500.0) << "the known peak is that of CFC60 over CFC60";
  EXPECT_NEAR(smoother.peak_time_s, 0.035, 1e-9);
}

TEST(LoadCellWall, TheCamryHeaderDescribes176Cells) {
  const auto header = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!header) GTEST_SKIP() << test::kNoSharedData;
  EXPECT_THAT([&] { read_wall(header->string()); },
              ThrowsMessage<InvalidInput>(HasSubstr("none of 176 load cells can be used; the first: A-01")));
}

}  // namespace
}  // namespace crashsim
