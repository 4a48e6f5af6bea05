#pragma once
/// CVODES as its manual uses it: Adams method, fixed-point iteration, serial vectors, a scalar tolerance.

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <vector>

namespace peer {

class Solver {
 public:
  /// @param data what `rhs` gets.
  Solver(const std::vector<double>& initial, CVRhsFn rhs, void* data, double tolerance);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Adds sensitivities by `count` parameters of these sizes, from zero. @param controlled part of the error test.
  void add_sensitivities(CVSensRhsFn rhs, std::vector<double> sizes, bool controlled);

  /// State at `t`, by CV_NORMAL; the start for t <= 0.
  const double* at(double t);
  /// Sensitivities there: state by parameter p.
  double** sensitivities();

 private:
  SUNContext context_ = nullptr;
  void* memory_ = nullptr;
  N_Vector state_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr, sensitivity_iteration_ = nullptr;
  N_Vector* sensitivities_ = nullptr;
  bool started_ = false;  // before, CVodeGetSens() gives no numbers
  std::vector<double> sizes_;
  std::vector<double*> sensitivity_data_;
};

}  // namespace peer
