#pragma once
/// Roots of functions of one variable.

#include <cmath>

namespace crashsim {

/// Where `f` changes sign in [a, b], to neighbouring doubles; an end where f is 0 counts. f(a) and f(b) must not have
/// the same sign.
template <class F>
double bisect(const F& f, double a, double b) {
  const double at_a = f(a);
  if (at_a == 0.0) return a;
  for (;;) {
    const double middle = a + (b - a) / 2.0;
    if (!(middle > a && middle < b)) return b;
    if (std::signbit(f(middle)) == std::signbit(at_a))
      a = middle;
    else
      b = middle;
  }
}

}  // namespace crashsim
