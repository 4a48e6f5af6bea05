#pragma once
/// Dense output of one integration step, and roots of what it describes.

#include <array>
#include <cmath>
#include <cstddef>

namespace crashsim {

inline constexpr int kMaxDegree = 16;  ///< Taylor orders up to 16; Adams methods reach 12.
using Coefficients = std::array<double, kMaxDegree + 1>;

/// sum_k c[k] tau^k.
inline double horner(const Coefficients& c, int degree, double tau) {
  double sum = c[static_cast<std::size_t>(degree)];
  for (int k = degree - 1; k >= 0; --k) sum = sum * tau + c[static_cast<std::size_t>(k)];
  return sum;
}

/// Derivative of horner().
inline double horner_derivative(const Coefficients& c, int degree, double tau) {
  double sum = 0.0;
  for (int k = degree; k >= 1; --k) sum = sum * tau + k * c[static_cast<std::size_t>(k)];
  return sum;
}

struct CrushState {
  double x = 0.0, v = 0.0;
};

/// Crush, velocity and dissipated energy as polynomials in tau = t - base, valid for from <= tau <= to.
struct StepPolynomial {
  double base = 0.0, from = 0.0, to = 0.0;
  int degree = 0;
  Coefficients x{}, v{}, dissipated{};
  CrushState start{}, end{};  ///< States at `from` and `to`.

  [[nodiscard]] double x_at(double tau) const { return horner(x, degree, tau); }
  [[nodiscard]] double v_at(double tau) const { return horner(v, degree, tau); }
  [[nodiscard]] CrushState state_at(double tau) const { return tau == to ? end : CrushState{x_at(tau), v_at(tau)}; }
  [[nodiscard]] double dissipated_at(double tau) const { return horner(dissipated, degree, tau); }
  /// Sets the states at both ends to what the polynomials give.
  void set_ends() {
    start = {x_at(from), v_at(from)};
    end = {x_at(to), v_at(to)};
  }
};

/// Root in [low, high] of a function that changes sign once there: Newton's method, with bisection where it would leave
/// the bracket. `f(t)` returns {value, derivative}.
template <class F>
double bracketed_root(F f, double low, double high) {
  const bool rising = f(high).value > 0.0;
  double t = 0.5 * (low + high);
  for (int i = 0; i < 100; ++i) {
    const auto at = f(t);
    if (at.value == 0.0) return t;
    ((at.value > 0.0) == rising ? high : low) = t;
    const double newton = t - at.value / at.derivative;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (next == t || std::fabs(next - t) <= 1e-16 * std::fabs(high)) return next;
    t = next;
  }
  return t;
}

struct ValueAndDerivative {
  double value, derivative;
};

/// Where a polynomial reaches `level`, which it crosses once between two points with the values given. Newton's method
/// from the parabola through both that has the slope of the first, with bisection where it would leave the bracket.
struct CurvePoint {
  double tau, value;
};
inline double level_crossing(const Coefficients& c, int degree, double level, const CurvePoint& first,
                             const CurvePoint& last) {
  double low = first.tau, high = last.tau;
  const double start = first.value - level, end = last.value - level;
  const double width = high - low, settled = 1e-9 * width;  // the move after this one is below rounding
  const double slope = horner_derivative(c, degree, low) * width, bend = end - start - slope;
  const double chord = start / (start - end);
  const double bent = chord - (start + chord * (slope + chord * bend)) / (slope + 2.0 * bend * chord);
  double t = low + width * (bent > 0.0 && bent < 1.0 ? bent : chord);
  for (int i = 0; i < 100; ++i) {
    double value = c[static_cast<std::size_t>(degree)], derivative = 0.0;
    for (int k = degree - 1; k >= 0; --k) {
      derivative = derivative * t + value;
      value = value * t + c[static_cast<std::size_t>(k)];
    }
    value -= level;
    ((value > 0.0) == (start > 0.0) ? low : high) = t;
    const double newton = t - value / derivative;
    const bool is_inside = newton >= low && newton <= high;
    const double next = is_inside ? newton : 0.5 * (low + high);
    if (std::fabs(next - t) <= (is_inside ? settled : 0.0)) return next;
    t = next;
  }
  return t;
}

}  // namespace crashsim
