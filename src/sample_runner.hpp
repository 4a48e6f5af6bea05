#pragma once
/// What one sample of a case is made of.

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include <crashsim/sweep.hpp>

#include "sweep_keys.hpp"

namespace crashsim {

inline constexpr const char* kMassKey = "vehicle.mass";
inline constexpr const char* kSpeedKey = "impact.speed";
inline constexpr const char* kRestitutionKey = "crush.restitution";
inline constexpr const char* kUnloadingStiffnessKey = "crush.unloading_stiffness";

/// Whether a sample is the whole chain: something varies that pulse or identification depend on.
bool is_whole_chain(const SamplePlan& plan);

/// Whether each sample has a model of its own from the identification.
bool is_identified_anew(const SamplePlan& plan);

/// Whether nothing but numbers of the crush model varies, and nothing but crush is simulated.
bool is_crush_alone(const SamplePlan& plan);

/// The ordinates of a curve that varies; none where the model's law has no such curve.
std::span<double> ordinates_of(CrushModel& model, const OrdinateKey& ordinate);

/// Speed of the case itself [m/s].
double plan_speed(const SamplePlan& plan);

/// The model of the case with a sample's numbers and speed.
CrushModel sample_model(const SamplePlan& plan, std::span<const double> inputs);

/// Header row of samples.csv.
std::string sample_header(const SampleTable& table);

/// One sample's way through the case. @throws InvalidInput when a number is none that the case can have.
/// @param stop ends an identification.
CaseResult run_sample(const SamplePlan& plan, std::span<const double> inputs, const std::atomic<bool>& stop);

}  // namespace crashsim
