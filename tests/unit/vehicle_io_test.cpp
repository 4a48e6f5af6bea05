#include <crashsim/vehicle_io.hpp>

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>

#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kJson = R"({"title": "a car", "mass_kg": "1.5t", "pitch_inertia_kgm2": 2000,
 "front_axle_m": 1.2, "rear_axle_m": "1400mm", "front_stiffness_n_per_m": 30000, "rear_stiffness_n_per_m": 20000,
 "front_damping_ns_per_m": 1500, "rear_damping_ns_per_m": 3000, "per_wheel": true, "force_arm_m": null})";
constexpr const char* kToml = R"(
[vehicle]
mass = "1.5 t"
pitch_inertia = 2000
front_axle = 1.2
rear_axle = "1.4 m"
front_stiffness = 30000
rear_stiffness = 20000
front_damping = 1500
rear_damping = 3000
per_wheel = true
[pulse]
file = "not read here"
)";

TEST(VehicleFile, SaysTheSameInJsonAndToml) {
  const test::TempDir dir;
  for (const auto& path : {dir.file("v.json", kJson), dir.file("v.toml", kToml)}) {
    const HeavePitchModel vehicle = read_vehicle(path);
    EXPECT_DOUBLE_EQ(vehicle.mass_kg, 1500.0) << path;
    EXPECT_DOUBLE_EQ(vehicle.rear_axle_m, 1.4) << path;
    EXPECT_DOUBLE_EQ(with_axle_values(vehicle).front_stiffness_n_per_m, 60e3) << path;
    EXPECT_TRUE(std::isnan(vehicle.force_arm_m)) << path;
  }
}

TEST(VehicleFile, HoldsThePublishedTable) {
  const HeavePitchModel table = read_vehicle(std::string(test::source_dir()) + "/data/paper/table1.json");
  EXPECT_EQ(table.mass_kg, 400.0);
  EXPECT_EQ(table.pitch_inertia_kgm2, 1400.0);
  EXPECT_EQ(table.front_axle_m + table.rear_axle_m, 2.4);
  EXPECT_TRUE(table.per_wheel);
}

TEST(VehicleFile, ReadsBackWhatIsWritten) {
  const test::TempDir dir;
  HeavePitchModel vehicle = read_vehicle(dir.file("v.json", kJson));
  vehicle.front_damping_ns_per_m = 1.0 / 3.0;
  vehicle.formulation = PitchFormulation::as_printed;
  PitchIdentification fit;
  fit.outcome = IdentifyOutcome::completed;
  fit.error.total = 0.25;
  fit.parameters = {{"front_damping_ns_per_m", "N s/m", 1.0 / 3.0, kUnset, 0.1, 9.0, true, false}};
  const Record record = make_record("identify-pitch", {"v.json"}, {}, {});
  const std::string text = format_vehicle(vehicle, &fit, &record);
  const HeavePitchModel again = read_vehicle(dir.file("again.json", text));
  for (const Field<HeavePitchModel>& field : fields<HeavePitchModel>)
    EXPECT_EQ(get_option(again, field), get_option(vehicle, field)) << field.name;
  EXPECT_EQ(text.find("force_arm_m"), std::string::npos);  // unset
  const auto written = nlohmann::json::parse(text);
  EXPECT_EQ(written["identification"]["error"], 0.25);
  EXPECT_TRUE(written["identification"]["error_pitch"].is_null());
  EXPECT_EQ(written["identification"]["parameters"][0]["value"], 1.0 / 3.0);
  EXPECT_TRUE(written["identification"]["parameters"][0]["standard_error"].is_null());
  EXPECT_EQ(written["identification"]["parameters"][0]["untouched"], true);
  EXPECT_EQ(written["record"]["command"], "identify-pitch");
}

TEST(VehicleFile, ABadVehicleIsNotWritten) {
  EXPECT_THAT([] { static_cast<void>(format_vehicle({})); },
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.mass_kg is not set")));
}

TEST(VehicleFile, IsRefusedWithKeyAndRule) {
  const test::TempDir dir;
  const auto refused = [&](const std::string& old, const std::string& now, const std::string& message) {
    std::string text = kJson;
    text.replace(text.find(old), old.size(), now);
    const std::string path = dir.file("v.json", text);
    EXPECT_THAT([&] { static_cast<void>(read_vehicle(path)); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  refused("\"1.5t\"", "-1", "mass_kg = -1 kg: must be > 0");
  refused("\"1.5t\"", "\"1.5m\"", "'m' measures length, not mass");
  refused("\"mass_kg\"", "\"masss_kg\"", "unknown name 'masss_kg', did you mean 'mass'");
  refused("\"title\"", "\"format\"", "v.json: is a \"a car\", not a vehicle");
  refused("null}", "null", "v.json:3: is not JSON");
  refused("true", "1", "per_wheel: must be true or false, not a whole number");
  EXPECT_THAT([&] { static_cast<void>(read_vehicle(dir.path("none.json"))); },
              ThrowsMessage<InvalidInput>(HasSubstr("no such file")));
}

}  // namespace
}  // namespace crashsim
