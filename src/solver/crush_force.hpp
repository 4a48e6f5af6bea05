#pragma once
/// The crush force as polynomials between breaks: F(x, v) = sum_j spring[j] x^j + sum_j damper[j] v^j.

#include <array>
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
  bool outer_is_error = false;  ///< The outer segments must not be entered.

  [[nodiscard]] int count() const { return static_cast<int>(segments.size()); }
  [[nodiscard]] double lower(int segment) const;
  [[nodiscard]] double upper(int segment) const;
  /// Segment a variable at `s`, moving in `direction` (+1 or -1), is in or enters.
  [[nodiscard]] int locate(double s, int direction) const;
  [[nodiscard]] bool forbidden(int segment) const { return outer_is_error && (segment == 0 || segment == count() - 1); }
};

/// Axis of a curve with these knots (none: no force). `multiplied`: the ordinates multiply the variable, k(|x|) x;
/// otherwise they are the force itself, f(|x|) sign(x).
ForceAxis make_axis(std::span<const double> knots, bool multiplied, Extrapolation extrapolation);

/// Both axes of a model with their polynomials for the current ordinates.
struct CrushForce {
  ForceAxis spring, damper;
  std::vector<Quadratic> spring_polynomials, damper_polynomials;

  /// Recomputes the polynomials; sizes as the knots.
  void set_ordinates(std::span<const double> spring_ordinates, std::span<const double> damper_ordinates);
};

CrushForce make_force(const CrushModel& model);

/// Work of the spring from 0 to x, exactly.
double spring_energy(const CrushForce& force, double x);

}  // namespace crashsim
