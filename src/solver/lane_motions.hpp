#pragma once
/// The motions of many models by the Taylor kernel in SIMD lanes.

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "instruction_set.hpp"
#include "solver/crush_motion.hpp"
#include "solver/lane_kernel.hpp"

namespace crashsim {

/// One model in a lane.
struct LaneModel {
  CrushForce force;
  double mass_kg = 0.0, speed_mps = 0.0;
  Unloading unloading;

  [[nodiscard]] CrushProblem problem() const { return {force, mass_kg, speed_mps, unloading}; }
};

/// Rows that a model's samples go to; null: none are wanted.
struct LaneRow {
  double *accel = nullptr, *velocity = nullptr, *displacement = nullptr;
};

/// What to simulate: models 0..count-1. The functions are called on the calling thread.
struct LaneWork {
  std::size_t count = 0;
  std::function<void(std::size_t index, LaneModel& model)> load;  ///< Fills a lane; `model` held another one before.
  std::function<LaneRow(std::size_t index)> row;
  std::function<void(std::size_t index, const MotionSummary& summary)> finish;
};

/// Output times and accuracy of a block of motions.
class LaneMotions {
 public:
  /// @param times_s output times; the last one is the end.
  /// @param tolerance error of a step relative to the impact speed.
  LaneMotions(std::span<const double> times_s, double tolerance, InstructionSet set);

  /// Simulates all the work; samples after the end of a motion that broke off are NaN. @returns steps made.
  long run(const LaneWork& work);

 private:
  struct Lane {
    LaneModel model;
    MotionState state;
    LaneRow row;
    std::size_t index = 0, next_sample = 0;
    bool live = false;
  };

  void start(std::size_t lane, const LaneWork& work);
  void finish(std::size_t lane, const LaneWork& work);
  void enter_region(std::size_t lane);
  void set_start(std::size_t lane);
  [[nodiscard]] StepPolynomial polynomial(std::size_t lane) const;
  [[nodiscard]] Event event_of(std::size_t lane) const;
  void end_step(std::size_t lane);
  [[nodiscard]] std::size_t samples_until(double t, std::size_t least) const;
  void sample(std::size_t lane, double t, double tau_end);

  std::vector<double> times_;  ///< Padded by a block, which the kernel may read.
  std::size_t samples_;
  double spacing_s_ = kUnset;  ///< Of uniform times.
  double tolerance_;
  const LaneKernel& kernel_;
  LaneBlock block_;
  std::array<Lane, kMotions> lanes_;
  std::size_t next_model_ = 0;
  LaneNumbers tail_[3]{};  ///< Takes what a block of samples writes beyond a row.
};

}  // namespace crashsim
