#pragma once
/// Tables of a coupled response: the one list from which files and summaries are written.

#include <array>
#include <string_view>
#include <vector>

#include <crashsim/named_number.hpp>
#include <crashsim/simulate_coupled.hpp>

namespace crashsim {

/// Columns of coupled.csv, in order.
struct CoupledColumn {
  std::string_view name;
  std::vector<double> CoupledResponse::*member;
};
inline constexpr std::array<CoupledColumn, 16> kCoupledColumns = {{
    {"time_s", &CoupledResponse::time_s},
    {"displacement_m", &CoupledResponse::displacement_m},
    {"velocity_mps", &CoupledResponse::velocity_mps},
    {"accel_mps2", &CoupledResponse::accel_mps2},
    {"crush_m", &CoupledResponse::crush_m},
    {"heave_m", &CoupledResponse::heave_m},
    {"heave_velocity_mps", &CoupledResponse::heave_velocity_mps},
    {"heave_accel_mps2", &CoupledResponse::heave_accel_mps2},
    {"pitch_rad", &CoupledResponse::pitch_rad},
    {"pitch_rate_radps", &CoupledResponse::pitch_rate_radps},
    {"pitch_accel_radps2", &CoupledResponse::pitch_accel_radps2},
    {"longitudinal_force_n", &CoupledResponse::longitudinal_force_n},
    {"vertical_force_n", &CoupledResponse::vertical_force_n},
    {"front_axle_load_n", &CoupledResponse::front_axle_load_n},
    {"rear_axle_load_n", &CoupledResponse::rear_axle_load_n},
    {"energy_residual_j", &CoupledResponse::energy_residual_j},
}};

/// The summary of a response, in the order in which it is printed.
inline constexpr std::array<NamedNumber<CoupledResponse>, 23> kCoupledNumbers = {{
    {"t_m_s", &CoupledResponse::t_m_s, "time of maximum crush"},
    {"max_crush_m", &CoupledResponse::max_crush_m, "maximum crush where the force acts"},
    {"displacement_max_m", &CoupledResponse::displacement_max_m, "largest travel of the centre of gravity"},
    {"displacement_max_time_s", &CoupledResponse::displacement_max_time_s, "time of the largest travel"},
    {"peak_decel_g", &CoupledResponse::peak_decel_g, "peak deceleration"},
    {"separation_s", &CoupledResponse::separation_s, "time contact was lost"},
    {"static_crush_m", &CoupledResponse::static_crush_m, "crush when contact was lost"},
    {"rebound_velocity_mps", &CoupledResponse::rebound_velocity_mps, "velocity when contact was lost"},
    {"pitch_max_rad", &CoupledResponse::pitch_max_rad, "largest pitch, nose down"},
    {"pitch_max_time_s", &CoupledResponse::pitch_max_time_s, "time of the largest pitch"},
    {"heave_min_m", &CoupledResponse::heave_min_m, "lowest heave"},
    {"heave_min_time_s", &CoupledResponse::heave_min_time_s, "time of the lowest heave"},
    {"heave_velocity_min_mps", &CoupledResponse::heave_velocity_min_mps, "fastest drop"},
    {"front_axle_load_max_n", &CoupledResponse::front_axle_load_max_n, "largest load of the front axle"},
    {"front_axle_load_min_n", &CoupledResponse::front_axle_load_min_n, "smallest load of the front axle"},
    {"rear_axle_load_min_n", &CoupledResponse::rear_axle_load_min_n, "smallest load of the rear axle"},
    {"front_lift_off_s", &CoupledResponse::front_lift_off_s, "time the front wheels leave the ground"},
    {"rear_lift_off_s", &CoupledResponse::rear_lift_off_s, "time the rear wheels leave the ground"},
    {"kinetic_energy_j", &CoupledResponse::kinetic_energy_j, "kinetic energy at the end"},
    {"crush_energy_j", &CoupledResponse::crush_energy_j, "energy absorbed by the structure"},
    {"suspension_energy_j", &CoupledResponse::suspension_energy_j, "energy stored in suspension and height"},
    {"suspension_dissipated_j", &CoupledResponse::suspension_dissipated_j, "energy dissipated by the suspension"},
    {"vertical_work_j", &CoupledResponse::vertical_work_j, "work against the vertical force"},
}};

}  // namespace crashsim
