#pragma once
/// What is timed, in one place: `bench_workloads` writes it as JSON for programs in other languages.
///
/// W1: forward runs of the crush. 50 random models, 7 + 7 ordinates, 0..120 ms, 1201 samples of x, v and a.
/// W2: identification. 620 samples of a known model, with noise; normalised L1, bounds, random starts.
/// W3: heave and pitch under tabulated forces. 1201 samples over 300 ms.

#include <span>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/simulate_many.hpp>
#include <crashsim/simulate_pitch.hpp>

namespace crashsim::bench {

/// Channels over the samples of a workload.
using Channels = std::vector<std::vector<double>>;

/// Largest error of each channel relative to the largest reference value of that channel; the worst of them.
double largest_error(const Channels& result, const Channels& reference);

/// Value that 90 % of the errors do not exceed. How accurate an engine is over many models.
double ninetieth_percentile(std::vector<double> errors);

/// W1. The barrier pulls, too, so that all engines solve one equation from beginning to end.
struct ForwardWorkload {
  std::vector<CrushModel> models;
  SimulateOptions options;
  std::vector<Channels> reference;  ///< x, v, a of each model by CVODE at rtol 1e-12.
};
CrushModel random_model(int index, int knots = 7);
CrushModels random_models(int count);  ///< The first random models as arrays.
ForwardWorkload forward_workload(int models = 50);
Channels channels_of(const CrushResponse& response);

/// W2, on one of kTargets targets.
inline constexpr int kTargets = 10;
inline constexpr int kUsualTarget = 2;  ///< The one that takes nearest to 62 ms, 620 samples at 10 kHz, to stop.
struct FitWorkload {
  CrushModel truth;         ///< Its knots are those that identification places: evenly to maximum crush and speed.
  Pulse pulse;              ///< Its motion to maximum crush, each channel with noise of 2 % of its maximum.
  IdentifyOptions options;  ///< Bounds, and one thread.
  std::vector<std::vector<double>> starts;  ///< Ordinates to start from, spring first, for other programs.
  std::vector<std::vector<double>> points;  ///< Where gradients are compared.
};
FitWorkload fit_workload(int samples = 620, int knots = 7, int target = kUsualTarget);

/// W3.
struct PitchWorkload {
  HeavePitchModel model;
  PitchForcing forcing;
  PitchOptions options;
  Channels reference;  ///< z, theta, z', theta' by CVODE at rtol 1e-13, restarted at every sample of the forces.
};
PitchWorkload pitch_workload(int samples = 1201);
Channels channels_of(const PitchResponse& response);

}  // namespace crashsim::bench
