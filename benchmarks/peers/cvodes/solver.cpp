#include "solver.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace peer {
namespace {

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(std::string(call) + " failed with " + std::to_string(flag));
}

}  // namespace

Solver::Solver(const std::vector<double>& initial, CVRhsFn rhs, void* data, double tolerance) {
#if SUNDIALS_VERSION_MAJOR >= 7
  check(SUNContext_Create(SUN_COMM_NULL, &context_), "SUNContext_Create");
#else
  check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
#endif
  state_ = N_VNew_Serial(static_cast<sunindextype>(initial.size()), context_);
  std::ranges::copy(initial, N_VGetArrayPointer(state_));
  memory_ = CVodeCreate(CV_ADAMS, context_);
  check(CVodeInit(memory_, rhs, 0.0, state_), "CVodeInit");
  check(CVodeSStolerances(memory_, tolerance, tolerance), "CVodeSStolerances");
  check(CVodeSetUserData(memory_, data), "CVodeSetUserData");
  check(CVodeSetMaxNumSteps(memory_, 100000), "CVodeSetMaxNumSteps");
  iteration_ = SUNNonlinSol_FixedPoint(state_, 0, context_);
  check(CVodeSetNonlinearSolver(memory_, iteration_), "CVodeSetNonlinearSolver");
}

Solver::~Solver() {
  CVodeFree(&memory_);
  SUNNonlinSolFree(iteration_);
  if (sensitivity_iteration_ != nullptr) SUNNonlinSolFree(sensitivity_iteration_);
  if (sensitivities_ != nullptr) N_VDestroyVectorArray(sensitivities_, static_cast<int>(sizes_.size()));
  N_VDestroy(state_);
  SUNContext_Free(&context_);
}

void Solver::add_sensitivities(CVSensRhsFn rhs, std::vector<double> sizes, bool controlled) {
  sizes_ = std::move(sizes);
  const int count = static_cast<int>(sizes_.size());
  sensitivities_ = N_VCloneVectorArray(count, state_);
  for (int p = 0; p < count; ++p) {
    N_VConst(0.0, sensitivities_[p]);
    sensitivity_data_.push_back(N_VGetArrayPointer(sensitivities_[p]));
  }
  check(CVodeSensInit(memory_, count, CV_SIMULTANEOUS, rhs, sensitivities_), "CVodeSensInit");
  check(CVodeSetSensParams(memory_, nullptr, sizes_.data(), nullptr), "CVodeSetSensParams");
  check(CVodeSensEEtolerances(memory_), "CVodeSensEEtolerances");
  check(CVodeSetSensErrCon(memory_, controlled ? 1 : 0), "CVodeSetSensErrCon");
  sensitivity_iteration_ = SUNNonlinSol_FixedPointSens(count + 1, state_, 0, context_);
  check(CVodeSetNonlinearSolverSensSim(memory_, sensitivity_iteration_), "CVodeSetNonlinearSolverSensSim");
}

const double* Solver::at(double t) {
  double reached = 0.0;
  if (t > 0.0) {
    check(CVode(memory_, t, state_, &reached, CV_NORMAL), "CVode");
    started_ = true;
  }
  return N_VGetArrayPointer(state_);
}

double** Solver::sensitivities() {
  double t = 0.0;
  if (started_) check(CVodeGetSens(memory_, &t, sensitivities_), "CVodeGetSens");
  return sensitivity_data_.data();
}

}  // namespace peer
