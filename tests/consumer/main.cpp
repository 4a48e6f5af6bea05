// Simulates a crush model, then identifies it from its own pulse: goes through SUNDIALS and NLopt.
#include <crashsim/crashsim.hpp>

#include <cmath>
#include <cstdio>

namespace {

crashsim::CrushModel small_car() {
  crashsim::CrushModel model;
  model.mass_kg = 1200.0;
  model.impact_speed_mps = 15.0;
  model.spring = {{0.0, 0.3, 0.6}, {400e3, 500e3, 700e3}};
  model.damper = {{0.0, 15.0}, {2e3, 5e3}};
  return model;
}

crashsim::Identification identify_again(const crashsim::CrushModel& car, const crashsim::CrushResponse& crash) {
  crashsim::IdentifyOptions options;
  options.starts = 4;
  options.spring_knots = 3;
  options.damper_knots = 2;
  const auto pulse = crashsim::make_pulse(crash.time_s, crash.accel_mps2, car.impact_speed_mps, car.mass_kg);
  return crashsim::identify(pulse, options);
}

}  // namespace

int main() {
  const crashsim::CrushModel car = small_car();
  const crashsim::CrushResponse crash = crashsim::simulate(car);
  std::printf("crashsim %s\n%s\n", crashsim::kVersion, crash.brief_report().c_str());
  if (!crash.usable() || std::abs(crash.energy_residual_j.back()) > 1.0) return 1;

  const crashsim::Identification fit = identify_again(car, crash);
  std::printf("%s\n", fit.brief_report().c_str());
  const double crush = crashsim::simulate(fit.model).max_crush_m;
  return fit.usable() && std::abs(crush / crash.max_crush_m - 1.0) < 0.02 ? 0 : 1;
}
