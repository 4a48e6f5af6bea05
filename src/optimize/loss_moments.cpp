#include "optimize/loss_moments.hpp"

#include <algorithm>
#include <cmath>

namespace crashsim {
namespace {

/// One channel of a block: loss and d(loss)/d(channel).
struct Channel {
  Lanes value{}, derivative{};
};

CRASHSIM_INLINE Lanes root_of(const Lanes& square) {
  Lanes root{};
  for (std::size_t l = 0; l < kLanes; ++l) root[l] = std::sqrt(square[l]);
  return root;
}

CRASHSIM_INLINE Lanes broadcast(double value) { return Lanes{} + value; }

/// @param live 1 for a sample, 0 for padding.
template <Loss kLoss>
CRASHSIM_INLINE void penalise(const Lanes& residual, double scale, double smoothing, const Lanes& live, Channel& out) {
  const Lanes u = scale * residual;
  const Lanes size = u < 0.0 ? -u : u;
  const Lanes sign = (u > 0.0 ? broadcast(1.0) : Lanes{}) - (u < 0.0 ? broadcast(1.0) : Lanes{});
  if constexpr (kLoss == Loss::l2) {
    out = {u * u, 2.0 * u};
  } else if constexpr (kLoss == Loss::huber) {
    out.value = size <= kHuberThreshold ? 0.5 / kHuberThreshold * u * u : size - 0.5 * kHuberThreshold;
    out.derivative = size <= kHuberThreshold ? u / kHuberThreshold : sign;
  } else if (smoothing > 0.0) {
    const Lanes root = root_of(u * u + smoothing * smoothing);
    out = {root - smoothing, u / root};
  } else {
    out = {size, sign};
  }
  out.value *= live;
  out.derivative *= scale * live;
}

CRASHSIM_INLINE double sum_of(const Lanes& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

/// Residuals of up to kLanes samples; missing ones repeat the last.
struct Block {
  Lanes tau{}, x{}, v{}, a{}, live{};
};

CRASHSIM_INLINE void read_targets(const FitTarget& target, std::size_t at, std::size_t last, Block& block) {
  const double* const time = target.time_s.data();
  const double* const x = target.displacement_m.data();
  const double* const v = target.velocity_mps.data();
  const double* const a = target.accel_mps2.data();
  for (std::size_t l = 0; l < kLanes; ++l) {
    const std::size_t i = at + l < last ? at + l : last - 1;
    block.live[l] = at + l < last ? 1.0 : 0.0;
    block.tau[l] = time[i];
    block.x[l] = x[i];
    block.v[l] = v[i];
    block.a[l] = a[i];
  }
}

CRASHSIM_INLINE void subtract_from_motion(const StepPolynomial& step, double tau_end, const RegionForce& force,
                                          double mass_kg, Block& block) {
  const double* const cx = step.x.data();
  const double* const cv = step.v.data();
  const Lanes tau = block.tau - step.base;
  block.tau = tau < tau_end ? tau : broadcast(tau_end);
  Lanes x = broadcast(cx[step.degree]), v = broadcast(cv[step.degree]);
  for (int n = step.degree - 1; n >= 0; --n) {
    x = x * block.tau + cx[n];
    v = v * block.tau + cv[n];
  }
  const double* const fx = force.spring.data();
  const double* const fv = force.damper.data();
  const Lanes total = (fx[0] + x * (fx[1] + x * fx[2])) + (fv[0] + v * (fv[1] + v * fv[2]));
  block.x = x - block.x;
  block.v = v - block.v;
  block.a = -total / mass_kg - block.a;
}

/// Sums over lanes still apart.
struct LaneSums {
  Lanes sum{};
  Lanes x[kMaxDegree + 1]{}, v[kMaxDegree + 1]{}, a[kMaxDegree + 1]{};
};

CRASHSIM_INLINE void add_moments(int degree, const Lanes& tau, Lanes gx, Lanes gv, Lanes ga, LaneSums& sums) {
  for (int n = 0; n <= degree; ++n) {
    sums.x[n] += gx;
    sums.v[n] += gv;
    sums.a[n] += ga;
    gx *= tau;
    gv *= tau;
    ga *= tau;
  }
}

template <Loss kLoss>
CRASHSIM_INLINE void sum_piece(const FitTarget& target, std::size_t first, std::size_t last, const StepPolynomial& step,
                               double tau_end, const RegionForce& force, const Penalty& penalty, LossMoments& out) {
  const double s = penalty.smoothing;
  LaneSums sums;
  for (std::size_t at = first; at < last; at += kLanes) {
    Block block;
    read_targets(target, at, last, block);
    subtract_from_motion(step, tau_end, force, target.mass_kg, block);
    Channel x, v, a;
    penalise<kLoss>(block.x, target.displacement_scale, s * target.displacement_size, block.live, x);
    penalise<kLoss>(block.v, target.velocity_scale, s * target.velocity_size, block.live, v);
    penalise<kLoss>(block.a, target.accel_scale, s * target.accel_size, block.live, a);
    sums.sum += x.value + v.value + a.value;
    if (penalty.with_moments) add_moments(step.degree, block.tau, x.derivative, v.derivative, a.derivative, sums);
  }
  out.sum = sum_of(sums.sum);
  double* const mx = out.x.data();
  double* const mv = out.v.data();
  double* const ma = out.a.data();
  for (int n = 0; n <= step.degree; ++n) {
    mx[n] = sum_of(sums.x[n]);
    mv[n] = sum_of(sums.v[n]);
    ma[n] = sum_of(sums.a[n]);
  }
}

}  // namespace

CRASHSIM_WIDEST_VECTORS
void loss_moments(const FitTarget& target, std::size_t first, std::size_t last, const StepPolynomial& step,
                  double tau_end, const RegionForce& force, const Penalty& penalty, LossMoments& out) {
  switch (penalty.loss) {
    case Loss::l1:
      return sum_piece<Loss::l1>(target, first, last, step, tau_end, force, penalty, out);
    case Loss::l2:
      return sum_piece<Loss::l2>(target, first, last, step, tau_end, force, penalty, out);
    case Loss::huber:
      return sum_piece<Loss::huber>(target, first, last, step, tau_end, force, penalty, out);
  }
}

}  // namespace crashsim
