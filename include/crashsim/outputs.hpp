#pragma once
/// The files that crashsim writes, as text. Each carries the record of what made it.

#include <string>
#include <utility>
#include <vector>

#include <crashsim/comparison.hpp>
#include <crashsim/load_cell_wall.hpp>
#include <crashsim/predict.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/record.hpp>
#include <crashsim/sensor_correction.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/simulate_coupled.hpp>
#include <crashsim/simulate_pitch.hpp>

namespace crashsim {

/// pulse.csv: `time_s,accel_mps2,velocity_mps,displacement_m`; mass, speed, channels, steps and warnings as comments.
std::string format_pulse(const Pulse& pulse, const Record& record);

/// wall.csv: `time_s,total_force_n,force_height_m`, then `row_a_force_n` for each row and `column_01_force_n` for each
/// column of cells; heights of rows, cells left out, steps and warnings as comments.
std::string format_wall(const LoadCellWall& wall, const Record& record);

/// corrected.csv: `time_s,accel_mps2` (the mean), then `accel_93_mps2` for each channel; what was corrected, steps and
/// warnings as comments. A pulse is made of the mean unless other channels are chosen.
std::string format_correction(const SensorCorrection& correction, const Record& record);

/// response.csv: the columns of pulse.csv, then `spring_force_n,damper_force_n,energy_residual_j`.
std::string format_response(const CrushResponse& response, double mass_kg, const Record& record);

/// pitch.csv: the columns of kPitchColumns; outcome and notes as comments.
std::string format_pitch(const PitchResponse& response, const Record& record);

/// coupled.csv: the columns of kCoupledColumns; outcome and notes as comments.
std::string format_coupled(const CoupledResponse& response, const Record& record);

/// prediction.csv: `impact_speed_mps,outcome,extrapolated,without_max_crush`, then each metric with its band,
/// `t_m_s,t_m_s_low,t_m_s_high` and so on; message and reasons as comments.
std::string format_prediction(const SpeedPrediction& prediction, const Record& record);
/// The same as JSON, a row a speed.
std::string prediction_json(const SpeedPrediction& prediction);

/// rating.json, or comparison.json when there are several: each under its name.
std::string format_comparisons(const std::vector<NamedComparison>& comparisons, const Record& record);
std::string format_comparison(const Comparison& comparison, const Record& record);
/// rating.json with metrics side by side.
std::string format_comparison(const Comparison& comparison, const std::vector<MetricComparison>& metrics,
                              const Record& record);

/// case.lock.json: the record alone.
std::string format_record(const Record& record);

}  // namespace crashsim
