#include <crashsim/piecewise_linear.hpp>
#include <crashsim/version.hpp>

#include <cstdio>

int main() {
  const crashsim::PiecewiseLinear spring{{0.0, 0.5, 1.0}, {100e3, 300e3, 300e3}};
  crashsim::validate(spring, "spring");
  std::printf("crashsim %s: k(0.25 m) = %g N/m\n", crashsim::kVersion, crashsim::evaluate(spring, 0.25));
  return crashsim::evaluate(spring, 0.25) == 200e3 ? 0 : 1;
}
