#include <crashsim/plausibility.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "motion_arrays.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

MotionBalance balance_of(const MotionArrays& motion) {
  const Motion m = motion.view();
  return unlocked([&] { return motion_balance(m.time_s, m.accel_mps2, m.velocity_mps, m.displacement_m); });
}

void bind_balance(py::module_& module) {
  ValueClass<MotionBalance>(module, "MotionBalance",
                            "How acceleration, velocity and displacement of one motion agree. Deviations are the "
                            "largest over the samples, of "
                            "the impact speed, of the largest displacement and of the energy at impact.")
      .numbers(kMotionBalanceNumbers);
  module.def(
      "motion_balance", [](const py::object& motion) { return balance_of(motion_of(motion)); }, py::arg("motion"));
  module.def(
      "motion_balance",
      [](const py::object& time_s, const py::object& accel_mps2, const py::object& velocity_mps,
         const py::object& displacement_m) {
        return balance_of({Doubles(time_s, "time_s"), Doubles(accel_mps2, "accel_mps2"),
                           Doubles(velocity_mps, "velocity_mps"), Doubles(displacement_m, "displacement_m")});
      },
      py::arg("time_s"), py::arg("accel_mps2"), py::arg("velocity_mps"), py::arg("displacement_m"),
      R"(How the channels of a longitudinal motion agree, ``motion_balance(motion)`` or ``motion_balance(time_s, ...)``.

Velocity is the integral of acceleration, displacement that of velocity; kinetic energy and the work of the deceleration
add up; up to maximum crush C at t_m that work is v0^2/2 per mass, and the deceleration's time centroid is C/v0. Samples
before time 0 are left out. Integrals are by trapezoids.

Parameters
----------
motion : Pulse, CrushResponse, CoupledResponse or alike
    Any object with the four arrays below as attributes.
time_s : array_like of shape (n,)
    Strictly increasing times [s], impact at 0; n >= 3.
accel_mps2 : array_like of shape (n,)
    dv/dt [m/s^2], negative while the vehicle decelerates.
velocity_mps : array_like of shape (n,)
    Velocity [m/s], the first one > 0.
displacement_m : array_like of shape (n,)
    Crush [m].

Returns
-------
MotionBalance

Raises
------
InvalidInput
    When lengths differ, a value is not finite, times do not increase, there are fewer than 3 samples from time 0 on or
    the first velocity is not > 0.
)");
  module.def("check_balance", &check_balance, py::arg("balance"),
             R"(What is out of balance by more than 1 %.

Parameters
----------
balance : MotionBalance
    As of motion_balance.

Returns
-------
list of str
    One sentence each: which channels disagree, where and by how much. Empty when none do.

Raises
------
TypeError
    When `balance` is no MotionBalance.
)");
}

}  // namespace

void bind_plausibility(py::module_& module) {
  bind_balance(module);
  module.def(
      "check_fleet",
      [](const py::object& max_crush_m, const py::object& peak_decel_g) {
        return check_fleet(number_or_unset(max_crush_m, "m", "max_crush_m"),
                           number_or_unset(peak_decel_g, "", "peak_decel_g"));
      },
      py::arg("max_crush_m"), py::arg("peak_decel_g") = py::none(),
      R"(What lies outside the 5th to 95th percentile of 675 NHTSA frontal tests into a rigid wall.

Those are 0.442 to 0.796 m of maximum crush (median 0.653 m) and 25.5 to 56.3 g of peak deceleration (median 39.6 g).

Parameters
----------
max_crush_m : float or str or None
    Maximum dynamic crush [m]; None or NaN when not known.
peak_decel_g : float or None
    Peak deceleration in g; None or NaN when not known.

Returns
-------
list of str
    One sentence each; empty when nothing is.

Raises
------
TypeError
    When one of them is no number.
)");
}

}  // namespace crashsim::python
