#pragma once
/// The crush force between breaks of x and of v:
///     F(x, v) = spring(x) (1 + rate ln(1 + per_reference v)) + damper(v) + cross x v
/// with polynomials spring and damper.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <crashsim/crush_model.hpp>

namespace crashsim {

/// Polynomial c[0] + c[1] s + c[2] s^2.
using Quadratic = std::array<double, 3>;
inline double value(const Quadratic& c, double s) { return c[0] + s * (c[1] + s * c[2]); }

/// Contribution of one ordinate inside a segment: ordinate * value(c, s).
struct OrdinateBasis {
  int ordinate = -1;  ///< Index of the ordinate, -1: none.
  Quadratic c{};
};

/// One curve of the model along its whole signed axis. Segment s lies between breaks[s-1] and breaks[s]; the outer ones
/// are unbounded. 0 is always a break, so that the sign of the variable is constant inside a segment.
struct ForceAxis {
  std::vector<double> breaks;
  std::vector<std::array<OrdinateBasis, 2>> segments;
  int first_allowed = 0, last_allowed = 0;  ///< Segments that may be entered.

  [[nodiscard]] int count() const { return static_cast<int>(segments.size()); }
  [[nodiscard]] double lower(int segment) const;
  [[nodiscard]] double upper(int segment) const;
  /// Segment a variable at `s`, moving in `direction` (+1 or -1), is in or enters.
  [[nodiscard]] int locate(double s, int direction) const;
  [[nodiscard]] bool forbidden(int segment) const { return segment < first_allowed || segment > last_allowed; }
};

/// What a curve's ordinates make of its variable s: a force y(|s|) s, a force y(|s|) sign(s), or the factor y(|s|).
enum class OrdinateKind { stiffness, force, factor };

/// Axis of a curve with these knots (none: no force).
ForceAxis make_axis(std::span<const double> knots, OrdinateKind kind, Extrapolation extrapolation);

/// Both axes of a model with their polynomials for the current ordinates.
struct CrushForce {
  ForceAxis spring, damper;
  /// Law `crush_damping`: the damper's ordinates on the segments of `spring`, which has the breaks of both curves;
  /// `damper` then only tells the sign of v.
  std::vector<std::array<OrdinateBasis, 2>> damping;
  double rate_coefficient = 0.0, per_reference_speed = 0.0;  ///< Law `rate`.
  std::vector<Quadratic> spring_polynomials, damper_polynomials, damping_polynomials;

  /// Recomputes the polynomials; sizes as the knots.
  void set_ordinates(std::span<const double> spring_ordinates, std::span<const double> damper_ordinates);
};

/// Curves of a force without ordinates.
struct ForceShape {
  CrushLaw law = CrushLaw::stiffness;
  Extrapolation extrapolation = Extrapolation::constant;
  std::span<const double> spring_knots, damper_knots;
  double reference_speed_mps = kUnset;
};

CrushForce make_force(const ForceShape& shape);
CrushForce make_force(const CrushModel& model);

/// The force inside one region of x and v, as a function of both.
struct RegionForce {
  Quadratic spring{}, damper{};
  double cross = 0.0;
  double rate = 0.0, per_reference = 0.0;  ///< rate = 0: none. per_reference has the sign of v.

  [[nodiscard]] double at(double x, double v) const { return value(spring, x) * hardening(v) + damping_at(x, v); }
  /// F_c: what is not the spring's.
  [[nodiscard]] double damper_at(double x, double v) const {
    return value(spring, x) * (hardening(v) - 1.0) + damping_at(x, v);
  }
  [[nodiscard]] double by_x(double x, double v) const {
    return (spring[1] + 2.0 * x * spring[2]) * hardening(v) + cross * v;
  }
  [[nodiscard]] double by_v(double x, double v) const {
    const double by_rate = rate == 0.0 ? 0.0 : value(spring, x) * rate * per_reference * log_slope(per_reference * v);
    return by_rate + damper[1] + 2.0 * v * damper[2] + cross * x;
  }

 private:
  /// Of the logarithm's argument: an integrator that tries a step beyond v = 0 must not meet its pole. From here on the
  /// tangent goes on.
  static constexpr double kLeastArgument = -0.5;

  [[nodiscard]] double hardening(double v) const { return rate == 0.0 ? 1.0 : 1.0 + rate * log_of(per_reference * v); }
  /// ln(1 + s).
  [[nodiscard]] static double log_of(double s) {
    if (s >= kLeastArgument) return std::log1p(s);
    return std::log1p(kLeastArgument) + (s - kLeastArgument) / (1.0 + kLeastArgument);
  }
  [[nodiscard]] static double log_slope(double s) { return 1.0 / (1.0 + std::max(s, kLeastArgument)); }
  [[nodiscard]] double damping_at(double x, double v) const { return value(damper, v) + cross * x * v; }
};

/// @param spring segment of x, @param damper segment of v.
RegionForce region_force(const CrushForce& force, int spring, int damper);

/// Work of the spring from 0 to x, exactly.
double spring_energy(const CrushForce& force, double x);

}  // namespace crashsim
