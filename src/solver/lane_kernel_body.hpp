#pragma once
/// The kernel, for the files that compile it for one instruction set each; see instruction_set.hpp.

#include "solver/lane_kernel.hpp"
#include "vector_types.hpp"

namespace crashsim {
namespace {

constexpr double kLengthPerSpeed = 0.05;  // of the rounding of x to that of v [s]
constexpr double kClearForce = 1e-11;  // of the terms the force is the sum of: a smaller one is left to first_event()
constexpr int kMostIterations = 12;
constexpr double kSettled = 1e-9;  // of the step: Newton's method doubles the digits, so that this move was its last

/// A step of W lanes: the force, and the series of the motion.
template <std::size_t W, bool HasXv>
struct Step {
  using D = typename Vectors<W>::Doubles;
  using I = typename Vectors<W>::Integers;
  static constexpr bool kHasXv = HasXv;
  D constant, x1, x2, v1, v2, xv;
  D x[kLaneDegree + 1], v[kLaneDegree + 1];
};

template <class S, class D = typename S::D>
CRASHSIM_INLINE D square_coefficient(const D* c, int n) {
  D sum = D{};
  for (int i = 0; 2 * i < n; ++i) sum += c[i] * c[n - i];
  sum += sum;
  if (n % 2 == 0) sum += c[n / 2] * c[n / 2];
  return sum;
}

template <class S, class D = typename S::D>
CRASHSIM_INLINE D product_coefficient(const D* a, const D* b, int n) {
  D sum = D{};
  for (int i = 0; i <= n; ++i) sum += a[i] * b[n - i];
  return sum;
}

/// `sum` and a term of xv, where there is one: the bits of other lanes do not depend on their neighbours.
template <class S, class D = typename S::D>
CRASHSIM_INLINE D with_xv(const S& step, const D& sum, const D& factor) {
  return step.xv != 0.0 ? sum + step.xv * factor : sum;
}

template <class S>
CRASHSIM_INLINE void set_series(S& step) {
#pragma GCC unroll 16
  for (int n = 0; n < kLaneDegree; ++n) {
    auto accel = step.x1 * step.x[n] + step.v1 * step.v[n] + step.x2 * square_coefficient<S>(step.x, n) +
                 step.v2 * square_coefficient<S>(step.v, n);
    if constexpr (S::kHasXv) accel = with_xv(step, accel, product_coefficient<S>(step.x, step.v, n));
    if (n == 0) accel += step.constant;
    const double factor = 1.0 / static_cast<double>(n + 1);
    step.x[n + 1] = step.v[n] * factor;
    step.v[n + 1] = accel * factor;
  }
}

/// log2 of a positive normal number to 1 %, by its exponent and a parabola.
template <class S, class D = typename S::D>
CRASHSIM_INLINE D rough_log2(const D& number) {
  using I = typename S::I;
  const I bits = __builtin_bit_cast(I, number);
  const I exponent = (bits >> 52) | 0x4330000000000000;  // 2^52 + exponent, as a double
  const I mantissa = (bits & 0x000fffffffffffff) | 0x3ff0000000000000;
  const D m = __builtin_bit_cast(D, mantissa) - 1.0;
  return __builtin_bit_cast(D, exponent) - (0x1p52 + 1023.0) + m * (1.34 - 0.34 * m);
}

/// 2^y to 1 % for |y| < 1000.
template <class S, class D = typename S::D>
CRASHSIM_INLINE D rough_exp2(const D& y) {
  using I = typename S::I;
  const D shifted = y + 0x1.8p52;  // rounds to an integer
  const D f = y - (shifted - 0x1.8p52);
  const I bits = __builtin_bit_cast(I, shifted) << 52;
  const D mantissa = 1.0 + f * (0.7 + f * 0.23);
  const I scaled = __builtin_bit_cast(I, mantissa) + bits;
  return __builtin_bit_cast(D, scaled);
}

/// Largest step whose last two terms stay below the tolerance.
template <class S, class D = typename S::D>
CRASHSIM_INLINE D step_length(const S& step, const D& tolerance, const D& remaining) {
  constexpr double kLeast = 1e-200;
  D inverse_log2 = D{} - 900.0;
  for (int k = kLaneDegree - 1; k <= kLaneDegree; ++k) {
    D size = size_of(step.v[k]) / tolerance;
    size = size > kLeast ? size : D{} + kLeast;
    const D log = rough_log2<S>(size) * (1.0 / static_cast<double>(k));
    inverse_log2 = log > inverse_log2 ? log : inverse_log2;
  }
  const D length = rough_exp2<S>(-inverse_log2);
  return length < remaining ? length : remaining;
}

template <class D>
CRASHSIM_INLINE D polynomial(const D* c, const D& tau) {
  D value = c[kLaneDegree];
#pragma GCC unroll 16
  for (int n = kLaneDegree - 1; n >= 0; --n) value = value * tau + c[n];
  return value;
}

/// dv/dt, its rate of change, and whether it is too near zero to trust its sign.
template <class S, class D = typename S::D>
struct Pull {
  D accel, jerk;
  typename S::I near_zero;
};
template <class S, class D = typename S::D>
CRASHSIM_INLINE Pull<S> pull_at(const S& step, const D& x, const D& v, const D& margin) {
  D accel = (step.constant + x * (step.x1 + x * step.x2)) + v * (step.v1 + v * step.v2);
  D by_x = step.x1 + 2.0 * x * step.x2, by_v = step.v1 + 2.0 * v * step.v2;
  D terms = size_of(step.constant) + size_of(x) * (size_of(step.x1) + size_of(x * step.x2)) +
            size_of(v) * (size_of(step.v1) + size_of(v * step.v2));
  if constexpr (S::kHasXv) {
    accel = with_xv(step, accel, x * v);
    by_x = with_xv(step, by_x, v);
    by_v = with_xv(step, by_v, x);
    terms += size_of(step.xv * x * v);
  }
  const D least = kClearForce * terms + 10.0 * margin * (kLengthPerSpeed * size_of(by_x) + size_of(by_v));
  return {accel, by_x * v + by_v * accel, size_of(accel) <= least};
}

/// Lanes where the force may change its sign within the step.
template <class S, class D = typename S::D>
CRASHSIM_INLINE typename S::I may_turn(const Pull<S>& from, const Pull<S>& to, const D& length, const D& bilateral) {
  const D sign = from.accel < 0.0 ? D{} - 1.0 : D{} + 1.0;
  const D start = sign * from.accel, end = sign * to.accel, fall = sign * from.jerk, rise = sign * to.jerk;
  // With one minimum inside, the tangents at the ends bound it from below.
  const auto dips = (fall < 0.0) & (rise > 0.0) & (start + fall * length <= 0.0) & (end - rise * length <= 0.0);
  return from.near_zero | to.near_zero | (end <= 0.0) | dips | ((bilateral == 0.0) & (from.accel > 0.0));
}

/// A polynomial that reaches `level` between 0 and tau.
template <class D>
struct Crossing {
  D c[kLaneDegree + 1];
  D level, start, end;  ///< Value less the level at 0 and at tau.
};

/// Moves tau to the crossing in lanes that are `wanted`; `failed` gains those where Newton's method did not settle.
template <class S, class D = typename S::D, class I = typename S::I>
CRASHSIM_INLINE void find_root(const Crossing<D>& crossing, const I& wanted, D& tau, I& failed) {
  const D* const c = crossing.c;
  const D start = crossing.start;
  const D per_tau = 1.0 / tau;
  // First guess: the parabola through both ends that has the slope of the start, by one step from its chord.
  const D chord = start / (start - crossing.end);
  const D bend = (crossing.end - start) - c[1] * tau;
  const D chord_slope = c[1] * tau + 2.0 * bend * chord;
  const D bent = chord - (start + chord * (c[1] * tau + bend * chord)) / chord_slope;
  D low = D{}, high = tau;
  D at = tau * (((bent > 0.0) & (bent < 1.0)) ? bent : chord);
  I open = wanted;
  for (int i = 0; i < kMostIterations && any_of(open); ++i) {
    D value = c[kLaneDegree], slope = D{};
#pragma GCC unroll 16
    for (int n = kLaneDegree - 1; n >= 0; --n) {
      slope = slope * at + value;
      value = value * at + c[n];
    }
    value -= crossing.level;
    const I beyond = (value > 0.0) != (start > 0.0);
    high = beyond ? at : high;
    low = beyond ? low : at;
    const D newton = at - value / slope;
    const D next = ((newton >= low) & (newton <= high)) ? newton : 0.5 * (low + high);
    const D moved = (next - at) * per_tau;
    at = open ? next : at;
    open &= ~((moved <= kSettled) & (moved >= -kSettled));
  }
  failed |= open;
  tau = wanted ? at : tau;
}

/// Lanes beyond a bound of their segment at the end of the step, and the code of it.
template <class S>
struct Exit {
  typename S::I leaves, below, code;
  typename S::D level;
};

/// @param margin_low, margin_high distance from the bound at which a value is beyond it; negative inside.
template <class S, class D = typename S::D, class I = typename S::I>
CRASHSIM_INLINE Exit<S> exit_of(const D& value, const D& low, const D& high, const D& margin_low, const D& margin_high,
                                LaneEnd below_code, LaneEnd above_code) {
  const I below = value < low - margin_low;
  const I above = ~below & (value > high + margin_high);
  const I code = below ? I{} + static_cast<std::int64_t>(below_code) : I{} + static_cast<std::int64_t>(above_code);
  return {below | above, below, code, below ? low : high};
}

/// Lanes of an exit that cross its level inside the step; others are at it by rounding. Those that do not start inside
/// their segment are unclear.
template <class S, class D = typename S::D, class I = typename S::I>
CRASHSIM_INLINE I crosses(const Exit<S>& exit, const D& start, const D& end, I& unclear) {
  const I inside = exit.below ? start > exit.level : start < exit.level;
  unclear |= exit.leaves & ~inside;
  return exit.leaves & inside & (exit.below ? end < exit.level : end > exit.level);
}

/// Ends the step at the first bound that x or v reaches.
template <class S, class D = typename S::D, class I = typename S::I>
CRASHSIM_INLINE void leave_segments(const S& step, const LaneBlock& block, std::size_t first, D& x, D& v, D& tau,
                                    I& end, I& unclear) {
  const D margin = load<D>(block.margin + first), x_margin = margin * kLengthPerSpeed;
  const D x_low = load<D>(block.x_low + first), x_high = load<D>(block.x_high + first);
  const Exit<S> by_v = exit_of<S>(v, load<D>(block.v_low + first), load<D>(block.v_high + first), margin, margin,
                                  LaneEnd::damper_below, LaneEnd::damper_above);
  Exit<S> by_x = exit_of<S>(x, x_low, x_high, x_margin, x_margin, LaneEnd::spring_below, LaneEnd::spring_above);
  if (!any_of(by_v.leaves | by_x.leaves)) return;

  // One root for each lane: of v where it leaves, else of x.
  Crossing<D> crossing;
  for (int n = 0; n <= kLaneDegree; ++n) crossing.c[n] = by_v.leaves ? step.v[n] : step.x[n];
  const Exit<S> one = {by_v.leaves | by_x.leaves, by_v.leaves ? by_v.below : by_x.below,
                       by_v.leaves ? by_v.code : by_x.code, by_v.leaves ? by_v.level : by_x.level};
  const D value = by_v.leaves ? v : x;
  const I wanted = crosses<S>(one, crossing.c[0], value, unclear);
  crossing.level = one.level;
  crossing.start = crossing.c[0] - one.level;
  crossing.end = value - one.level;
  find_root<S>(crossing, wanted, tau, unclear);
  end = one.leaves ? one.code : end;
  x = polynomial(step.x, tau);
  v = polynomial(step.v, tau);

  // Where v has cut the step, x may have reached a bound before. What is as near to it as rounding makes it is at it.
  const D near_low = v < 0.0 ? -x_margin : x_margin, near_high = v > 0.0 ? -x_margin : x_margin;
  by_x = exit_of<S>(x, x_low, x_high, near_low, near_high, LaneEnd::spring_below, LaneEnd::spring_above);
  by_x.leaves &= by_v.leaves;
  if (!any_of(by_x.leaves)) return;
  for (int n = 0; n <= kLaneDegree; ++n) crossing.c[n] = step.x[n];
  const I again = crosses<S>(by_x, step.x[0], x, unclear);
  crossing.level = by_x.level;
  crossing.start = step.x[0] - by_x.level;
  crossing.end = x - by_x.level;
  find_root<S>(crossing, again, tau, unclear);
  end = by_x.leaves ? by_x.code : end;
  x = polynomial(step.x, tau);
  v = polynomial(step.v, tau);
}

template <std::size_t W, bool HasXv>
CRASHSIM_INLINE void advance_lanes(LaneBlock& block, std::size_t first) {
  using S = Step<W, HasXv>;
  using D = typename S::D;
  using I = typename S::I;
  S step;
  step.constant = load<D>(block.force.constant + first);
  step.x1 = load<D>(block.force.x1 + first);
  step.x2 = load<D>(block.force.x2 + first);
  step.v1 = load<D>(block.force.v1 + first);
  step.v2 = load<D>(block.force.v2 + first);
  if constexpr (HasXv) step.xv = load<D>(block.force.xv + first);
  step.x[0] = load<D>(block.x_from + first);
  step.v[0] = load<D>(block.v_from + first);
  set_series(step);
  const D length = step_length(step, load<D>(block.tolerance + first), load<D>(block.remaining + first));
  const D margin = load<D>(block.margin + first);
  D x = polynomial(step.x, length), v = polynomial(step.v, length), tau = length;
  I unclear = may_turn<S>(pull_at(step, step.x[0], step.v[0], margin), pull_at(step, x, v, margin), length,
                          load<D>(block.bilateral + first));
  I end = I{};
  leave_segments(step, block, first, x, v, tau, end, unclear);
  end = unclear ? I{} + static_cast<std::int64_t>(LaneEnd::unclear) : end;
  for (int n = 0; n <= kLaneDegree; ++n) {
    store(step.x[n], block.x[n] + first);
    store(step.v[n], block.v[n] + first);
  }
  store(length, block.length + first);
  store(tau, block.tau + first);
  store(x, block.x_to + first);
  store(v, block.v_to + first);
  __builtin_memcpy(block.end + first, &end, sizeof(I));
}

/// A function of its own for each: the common one is compiled as if there were no other.
template <std::size_t W, bool HasXv>
[[gnu::noinline]] void advance_all(LaneBlock& block) {
  for (std::size_t first = 0; first < kMotions; first += W) advance_lanes<W, HasXv>(block, first);
}

template <std::size_t W>
CRASHSIM_INLINE void advance(LaneBlock& block) {
  block.has_xv ? advance_all<W, true>(block) : advance_all<W, false>(block);
}

template <std::size_t W, bool HasXv>
[[gnu::noinline]] void sample_lane(const LaneBlock& block, std::size_t lane, const LaneSamples& samples) {
  using D = typename Vectors<W>::Doubles;
  double cx[kLaneDegree + 1], cv[kLaneDegree + 1];
  for (int n = 0; n <= kLaneDegree; ++n) {
    cx[n] = block.x[n][lane];
    cv[n] = block.v[n][lane];
  }
  const double constant = block.force.constant[lane], x1 = block.force.x1[lane], x2 = block.force.x2[lane],
               v1 = block.force.v1[lane], v2 = block.force.v2[lane], xv = block.force.xv[lane];
  for (std::size_t i = 0; i < samples.count; i += W) {
    D tau;
    __builtin_memcpy(&tau, samples.times + i, sizeof(D));
    tau -= samples.base;
    tau = tau < samples.tau_end ? tau : D{} + samples.tau_end;
    D x = D{} + cx[kLaneDegree], v = D{} + cv[kLaneDegree];
#pragma GCC unroll 16
    for (int n = kLaneDegree - 1; n >= 0; --n) {
      x = x * tau + cx[n];
      v = v * tau + cv[n];
    }
    D a = (constant + x * (x1 + x * x2)) + v * (v1 + v * v2);
    if constexpr (HasXv) a += xv * (x * v);
    __builtin_memcpy(samples.accel + i, &a, sizeof(D));
    __builtin_memcpy(samples.velocity + i, &v, sizeof(D));
    __builtin_memcpy(samples.displacement + i, &x, sizeof(D));
  }
}

template <std::size_t W>
CRASHSIM_INLINE void sample(const LaneBlock& block, std::size_t lane, const LaneSamples& samples) {
  block.force.xv[lane] != 0.0 ? sample_lane<W, true>(block, lane, samples)
                              : sample_lane<W, false>(block, lane, samples);
}

template <std::size_t W>
constexpr LaneKernel kKernel = {
    [](LaneBlock& block) { advance<W>(block); },
    [](const LaneBlock& block, std::size_t lane, const LaneSamples& samples) { sample<W>(block, lane, samples); }};

}  // namespace
}  // namespace crashsim
