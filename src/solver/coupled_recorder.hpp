#pragma once
/// Output of a coupled motion: samples, peaks and the energy ledger.

#include <vector>

#include <crashsim/simulate_coupled.hpp>

#include "solver/coupled_motion.hpp"
#include "solver/pitch_peaks.hpp"

namespace crashsim {

/// Fills a response piece by piece.
class CoupledRecorder {
 public:
  /// @param times output times [s]; the last one is the end.
  CoupledRecorder(const CoupledProblem& problem, const std::vector<double>& times, CoupledResponse& out);

  void on_piece(const CoupledMode& mode, const CoupledStep& step, double tau_end);
  /// Adds the end of the motion, the peaks and the energies.
  void finish(const CoupledSummary& summary);

 private:
  void record(const CoupledMode& mode, double t, const CoupledState& y);

  const CoupledProblem& problem_;
  const std::vector<double>& times_;
  CoupledResponse& out_;
  Peak travel_, decel_, pitch_, drop_, drop_rate_, front_load_, front_unload_, rear_unload_;
};

}  // namespace crashsim
