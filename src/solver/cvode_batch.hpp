#pragma once
/// The motions of many models as one CVODE problem, so that they share its bookkeeping.
///
/// CVODE sees one smooth enough system: where x or v leaves its segment, the right-hand side takes the next one's
/// polynomial (the force is continuous there), and error control does the rest. What ends a step in a motion of its own
/// is looked for on the polynomial of each step accepted. A motion that is unloading plastically or out of contact goes
/// on in closed form; one that ended is over. Both leave the problem: their derivatives are zero, their errors do not
/// count, and the others go on undisturbed.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "instruction_set.hpp"
#include "solver/batch_kernel.hpp"
#include "solver/cvode.hpp"
#include "solver/lane_motions.hpp"

namespace crashsim {

class CvodeBatch {
 public:
  /// @param times_s output times; the last one is the end.
  /// @param rtol relative accuracy of the result.
  CvodeBatch(std::span<const double> times_s, double rtol, InstructionSet set);
  ~CvodeBatch() = default;
  CvodeBatch(const CvodeBatch&) = delete;  // the right-hand side refers to it
  CvodeBatch& operator=(const CvodeBatch&) = delete;

  /// Simulates at most kBatch models; samples after the end of a motion that broke off are NaN. Models that do not go
  /// with others (a force that jumps while in contact, motions that grow without bound, and all that were left when
  /// CVODE gave up) are not finished: they are in `alone`. @returns steps made.
  long run(const LaneWork& work, std::vector<std::size_t>& alone);

 private:
  struct Model {
    LaneModel data;
    MotionState state;
    LaneRow row;
    int spring = 0, damper = 0;  ///< Segments of the polynomials in use.
    bool live = false;           ///< In the problem.
  };

  static constexpr std::size_t kTile = 8;  ///< Samples that are taken before rows are written: a cache line's.
  using Unknowns = std::array<double, kBatchLength>;
  struct alignas(64) Sample {
    Unknowns state, rates;
  };

  void start(const LaneWork& work, std::vector<std::size_t>& alone);
  void enter(std::size_t index, double weight);
  void step(const LaneWork& work, std::vector<std::size_t>& alone);
  void rates(const double* y, double* ydot);
  void follow(std::size_t index, double x, double v);
  void set_polynomials(std::size_t index);
  void set_limits(std::size_t index);
  void remove(std::size_t index);
  void sample_until(double t);
  void take_sample(std::span<const double> y);
  void write_tile();
  [[nodiscard]] bool is_beyond(std::size_t index) const;
  void examine(std::size_t index, const LaneWork& work, std::vector<std::size_t>& alone);
  [[nodiscard]] StepPolynomial polynomial(std::size_t index);
  void finish_row(std::size_t index);

  std::vector<double> times_;
  double tolerance_;
  const BatchKernel& kernel_;
  BatchForce force_;
  BatchLimits limits_;
  std::array<Model, kBatch> models_;
  std::vector<std::size_t> live_;
  std::size_t next_sample_ = 0, first_in_tile_ = 0;
  std::array<Sample, kTile> tile_;
  bool has_rows_ = false;
  Unknowns weights_{};
  alignas(64) Unknowns rates_{};
  BatchFlags flags_{};
  std::vector<Unknowns> series_;  ///< Of the last step about its end; empty: not yet asked for.
  Cvode cvode_;
};

}  // namespace crashsim
