#pragma once
/// CVODE for small smooth systems: one step at a time, with the step's own polynomial as dense output.

#include <cvodes/cvodes.h>

#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/small_vector.hpp"

namespace crashsim {

/// CVODE gave up.
struct SolverError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One problem y' = f(t, y), integrated by the variable-order Adams method with functional iteration.
class Cvode {
 public:
  using Rhs = std::function<void(double t, const double* y, double* ydot)>;
  using NewVector = N_Vector (*)(sunindextype length, SUNContext context);

  /// @param length number of unknowns. @throws std::bad_alloc, SolverError.
  Cvode(int length, Rhs rhs, NewVector new_vector = new_small_vector);

  /// Relative tolerance, and absolute ones per unknown; before start().
  void set_tolerances(double rtol, std::span<const double> atol);
  /// Instead of tolerances: weight of each unknown's error, 0 where it does not count; may change between steps.
  void set_weights(std::span<const double> weights);
  /// Error left by the iteration for a step's end, of what its error may be; CVODE's own choice is 0.1.
  void set_iteration_error(double fraction);
  /// Least factor by which the step is made longer; CVODE's own choice is 1.5.
  void set_least_growth(double factor);
  /// Never steps beyond this time.
  void set_stop_time(double t);
  /// Starts, or starts anew, from a state. @param first_step 0: CVODE chooses.
  void start(double t, std::span<const double> y, double first_step = 0.0);
  /// Takes one step and returns the time reached. @throws SolverError; whatever the right-hand side threw.
  double step();

  /// State at the end of the last step.
  [[nodiscard]] std::span<const double> state() const;
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double last_step() const;
  [[nodiscard]] int last_order() const;
  /// k-th derivative of the step's polynomial at t, which lies in the last step.
  std::span<const double> derivative(double t, int k);
  [[nodiscard]] long rhs_evaluations() const { return rhs_evaluations_; }

 private:
  static int rhs_callback(sunrealtype t, N_Vector y, N_Vector ydot, void* self) noexcept;
  static int weights_callback(N_Vector y, N_Vector weights, void* self) noexcept;
  void check(int flag, const char* call) const;

  template <auto Destroy>
  struct Deleter {
    void operator()(auto* p) const noexcept { Destroy(p); }
  };
  struct MemoryDeleter {
    void operator()(void* p) const noexcept { CVodeFree(&p); }
  };
  struct ContextDeleter {
    void operator()(SUNContext p) const noexcept { SUNContext_Free(&p); }
  };
  using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, Deleter<N_VDestroy>>;
  using NonlinearSolver = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Deleter<SUNNonlinSolFree>>;

  Rhs rhs_;
  std::exception_ptr pending_;
  std::unique_ptr<std::remove_pointer_t<SUNContext>, ContextDeleter> context_;  // outlives what it made
  Vector state_, atol_, derivative_;
  std::unique_ptr<void, MemoryDeleter> memory_;
  NonlinearSolver nonlinear_solver_;
  double time_ = 0.0;
  double rtol_ = 1e-8;
  std::vector<double> weights_;  // empty: by tolerances
  bool initialised_ = false;
  long rhs_evaluations_ = 0;
};

}  // namespace crashsim
