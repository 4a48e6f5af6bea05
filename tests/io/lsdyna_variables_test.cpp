#include <gmock/gmock.h>

#include "io/lsdyna_variables.hpp"

namespace crashsim {
namespace {

TEST(LsdynaVariables, CountsHaveNoDimension) {
  for (const char* name : {"number_of_nodes", "number_of_elements", "num_bad_shells"})
    EXPECT_EQ(io::lsdyna_dimension({"glstat", name}), Dimension::none) << name;
  EXPECT_EQ(io::lsdyna_dimension({"rcforc", "tie_count"}), Dimension::none);
}

TEST(LsdynaVariables, NamesSayWhatTheyMeasure) {
  EXPECT_EQ(io::lsdyna_dimension({"nodout", "ry_acceleration"}), Dimension::angular_acceleration);
  EXPECT_EQ(io::lsdyna_dimension({"rbdout", "global_rdy"}), Dimension::angle);
  EXPECT_EQ(io::lsdyna_dimension({"secforc", "total_moment"}), Dimension::moment);
  EXPECT_EQ(io::lsdyna_dimension({"matsum", "x_momentum"}), Dimension::impulse);
  for (const char* force : {"axial", "shear_s", "shear_t"})
    EXPECT_EQ(io::lsdyna_dimension({"elout/beam", force}), Dimension::force) << force;
  for (const char* moment : {"moment_s", "moment_t", "torsion"})
    EXPECT_EQ(io::lsdyna_dimension({"elout/beam", moment}), Dimension::moment) << moment;
  EXPECT_EQ(io::lsdyna_dimension({"nodout", "temperature"}), Dimension::unknown);
  EXPECT_EQ(io::lsdyna_trace({"rbdout", "global_rvy"}, "3", "").axis, 'Y');
}

}  // namespace
}  // namespace crashsim
