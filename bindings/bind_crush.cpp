#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/crush_model.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/simulate.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

bool is_number(const py::object& at) {
  const bool is_single = py::hasattr(at, "ndim") ? at.attr("ndim").cast<int>() == 0 : !is_array_like(at);
  return is_single && py::hasattr(at, "__float__");
}

/// f at one number or at each of an array.
template <class F>
py::object each(const py::object& at, const std::string& what, const F& f) {
  if (is_number(at)) return py::float_(f(py::float_(at).cast<double>()));
  const Doubles points(at, what);
  check_finite(points);
  std::vector<double> values;
  values.reserve(points.view().size());
  for (const double point : points.view()) values.push_back(f(point));
  return array_of(std::move(values));
}

/// f at pairs of two numbers or arrays; a number goes with each of an array.
template <class F>
py::object each(const py::object& a, const std::string& what_a, const py::object& b, const std::string& what_b,
                const F& f) {
  if (is_number(b))
    return each(a, what_a, [&, at_b = py::float_(b).cast<double>()](double at_a) { return f(at_a, at_b); });
  if (is_number(a))
    return each(b, what_b, [&, at_a = py::float_(a).cast<double>()](double at_b) { return f(at_a, at_b); });
  const Doubles points_a(a, what_a), points_b(b, what_b);
  check_finite(points_a);
  check_finite(points_b);
  const std::size_t count = points_a.view().size();
  if (points_b.view().size() != count)
    throw InvalidInput(what_b + ": has " + std::to_string(points_b.view().size()) + " values and " + what_a + " has " +
                       std::to_string(count) + ", must be as many");
  std::vector<double> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) values.push_back(f(points_a.view()[i], points_b.view()[i]));
  return array_of(std::move(values));
}

double abscissa(double at) {
  check_finite(at, "at");
  if (at < 0.0) throw InvalidInput("at = " + format_number(at) + ": must be >= 0");
  return at;
}

void bind_piecewise_linear(py::module_& module) {
  ValueClass<PiecewiseLinear>(module, "PiecewiseLinear",
                              "Curve through (knot, ordinate) pairs, linear between knots; one knot makes a constant. "
                              "Call it: ``curve(0.2)``, ``curve(array)``.")
      .field("knots", &PiecewiseLinear::knots, "Abscissae, array of n: first 0, strictly increasing.")
      .field("ordinates", &PiecewiseLinear::ordinates, "Values at the knots, array of n, >= 0.")
      .def(
          "__call__",
          [](const PiecewiseLinear& self, const py::object& at) {
            validate(self, "PiecewiseLinear");
            return each(at, "at", [&](double s) { return evaluate(self, abscissa(s)); });
          },
          py::arg("at"), "Values at abscissae >= 0 (float or array); beyond the last knot the last ordinate is held.");
}

void bind_unloading(py::module_& module) {
  ValueClass<Unloading>(module, "Unloading",
                        "What the structure does after maximum crush: back on the same path, or down a straight line.")
      .field("kind", &Unloading::kind, "'elastic' or 'plastic'.")
      .field("bilateral", &Unloading::bilateral, "True: the barrier pulls too, contact is never lost.")
      .field("unloading_stiffness_n_per_m", &Unloading::unloading_stiffness_n_per_m,
             "Plastic: slope of the line back [N/m].")
      .field("restitution", &Unloading::restitution, "Plastic: rebound velocity / impact speed, 0..1.");
}

void bind_crush_model(py::module_& module) {
  ValueClass<CrushModel>(module, "CrushModel",
                         R"(One-degree-of-freedom crush against a rigid barrier, [Noorsumar2021] eq. (1)-(3).

    m x'' + F_k + F_c = 0,  x(0) = 0,  v(0) = impact speed

by `law`:

    'stiffness'      F_k = k(abs(x)) x,        F_c = c(abs(v)) v
    'force'          F_k = f(abs(x)) sign(x),  F_c = c(abs(v)) v
    'crush_damping'  F_k = f(abs(x)) sign(x),  F_c = c(abs(x)) v
    'rate'           F_k = f(abs(x)) sign(x),  F_c = F_k r ln(1 + abs(v) / v_ref), without a damper

x is crush [m], positive while the front shortens. Fields are keywords of the constructor; spring or damper may be left
out. Raises InvalidInput, naming the field and the rule, when it is used with a bad value.)")
      .field("mass_kg", &CrushModel::mass_kg, "Test mass [kg], > 0.")
      .field("spring", &CrushModel::spring,
             "PiecewiseLinear of knots [m]; ordinates with law 'stiffness' k [N/m], else f [N].")
      .field("damper", &CrushModel::damper,
             "c: PiecewiseLinear of knots [m/s] ([m] with law 'crush_damping'), ordinates [N s/m].")
      .field("impact_speed_mps", &CrushModel::impact_speed_mps, "Speed it was identified at [m/s], NaN when unset.")
      .field("law", &CrushModel::law,
             "What spring and damper are curves of: 'stiffness', 'force', 'crush_damping' or 'rate'.")
      .field("extrapolation", &CrushModel::extrapolation, "Beyond the last knot: 'constant', 'linear' or 'error'.")
      .field("unloading", &CrushModel::unloading, "Unloading: what happens after maximum crush.")
      .field("rate_coefficient", &CrushModel::rate_coefficient, "Law 'rate': r, >= 0.")
      .field("reference_speed_mps", &CrushModel::reference_speed_mps, "Law 'rate': v_ref [m/s], > 0.")
      .def(
          "validate", [](const CrushModel& self) { validate(self); },
          "Raises InvalidInput naming the field, its value and the rule when the model is not one.")
      .def(
          "spring_force",
          [](const CrushModel& self, const py::object& x) {
            validate(self);
            return each(x, "displacement_m", [&](double at) { return spring_force(self, at); });
          },
          py::arg("displacement_m"), "Spring force [N] at crush [m], float or array.")
      .def(
          "damper_force",
          [](const CrushModel& self, const py::object& v, const py::object& x) {
            validate(self);
            if (x.is_none()) return each(v, "velocity_mps", [&](double at) { return damper_force(self, at); });
            return each(v, "velocity_mps", x, "displacement_m",
                        [&](double at_v, double at_x) { return damper_force(self, at_x, at_v); });
          },
          py::arg("velocity_mps"), py::arg("displacement_m") = py::none(),
          "F_c, the force besides the spring's [N], at velocity [m/s], float or array; laws 'crush_damping' and 'rate' "
          "need the crush [m], too, a number or as many.")
      .def(
          "spring_energy",
          [](const CrushModel& self, const py::object& x) {
            validate(self);
            return each(x, "displacement_m", [&](double at) { return spring_energy(self, at); });
          },
          py::arg("displacement_m"), "Work of the spring from 0 to crush [m], exactly [J]; float or array.");
}

void bind_crush_response(py::module_& module) {
  ValueClass<SolverStatistics>(module, "SolverStatistics", "Work of the integrator.")
      .field("steps", &SolverStatistics::steps, "Accepted steps.")
      .field("force_evaluations", &SolverStatistics::force_evaluations, "Right-hand sides evaluated.")
      .field("events", &SolverStatistics::events, "Knots crossed, turning points, separation.");
  ValueClass<CrushResponse>(module, "CrushResponse",
                            "What a simulation of the crush gives. Arrays are read-only, of n samples; numbers are NaN "
                            "and arrays empty where there is nothing.")
      .field("outcome", &CrushResponse::outcome,
             "'completed', 'no_max_crush', 'left_knot_range', 'unloading_too_soft', 'step_limit' or 'failed'.")
      .field("message", &CrushResponse::message, "Why it is not usable, or ''.")
      .field("time_s", &CrushResponse::time_s, "Output times [s].")
      .field("accel_mps2", &CrushResponse::accel_mps2, "dv/dt [m/s^2].")
      .field("velocity_mps", &CrushResponse::velocity_mps, "Velocity [m/s].")
      .field("displacement_m", &CrushResponse::displacement_m, "Crush [m].")
      .field("spring_force_n", &CrushResponse::spring_force_n,
             "Spring force [N]; after t_m of plastic unloading the return line's.")
      .field("damper_force_n", &CrushResponse::damper_force_n, "Damper force [N].")
      .field("energy_residual_j", &CrushResponse::energy_residual_j, "Kinetic + absorbed - initial energy [J].")
      .field("impact_speed_mps", &CrushResponse::impact_speed_mps, "Speed simulated [m/s].")
      .field("t_m_s", &CrushResponse::t_m_s, "Time of maximum crush [s].")
      .field("max_crush_m", &CrushResponse::max_crush_m, "Crush at t_m [m].")
      .field("separation_s", &CrushResponse::separation_s, "Time contact was lost [s]; NaN: never.")
      .field("static_crush_m", &CrushResponse::static_crush_m, "Crush at separation after maximum crush [m].")
      .field("rebound_velocity_mps", &CrushResponse::rebound_velocity_mps, "Velocity at separation, <= 0 [m/s].")
      .field("kinetic_energy_j", &CrushResponse::kinetic_energy_j, "At the end [J].")
      .field("spring_energy_j", &CrushResponse::spring_energy_j, "Stored in the spring at the end [J].")
      .field("dissipated_energy_j", &CrushResponse::dissipated_energy_j, "Dissipated until the end [J].")
      .field("statistics", &CrushResponse::statistics, "SolverStatistics.")
      .result();
}

}  // namespace

void bind_crush(py::module_& module) {
  bind_piecewise_linear(module);
  bind_unloading(module);
  bind_crush_model(module);
  bind_crush_response(module);
  module.def(
      "simulate",
      [](const CrushModel& model, const py::kwargs& keywords) {
        const auto options = options_from<SimulateOptions>(keywords, "simulate");
        return unlocked([&] { return simulate(model, options); });
      },
      py::arg("model"),
      with_options_doc<SimulateOptions>(R"(Simulates the crush of a model from impact.

Parameters
----------
model : CrushModel
**options
    See below.

Returns
-------
CrushResponse
    Look at ``usable`` and ``message``: numerical trouble is reported there.

Raises
------
InvalidInput
    On a bad model or option, or without an impact speed.)")
          .c_str());
  module.def(
      "read_model", [](const py::object& path) { return read_model(path_text(path)); }, py::arg("path"),
      R"(Reads a crush model from a ``model.json``.

Parameters
----------
path : str or os.PathLike

Returns
-------
CrushModel

Raises
------
InvalidInput
    With path, key, value and rule when it is missing, not JSON, of another format, or has a bad value.
)");
  module.def(
      "uniform_knots",
      [](double last, int count) {
        check_finite(last, "last");
        if (last <= 0.0) throw InvalidInput("last = " + format_number(last) + ": must be > 0");
        if (count < 1) throw InvalidInput("count = " + std::to_string(count) + ": must be >= 1");
        return array_of(uniform_knots(last, count));
      },
      py::arg("last"), py::arg("count"),
      R"(Knots evenly spaced on [0, last].

Parameters
----------
last : float
    The last knot, > 0 (any unit).
count : int
    How many, >= 1.

Returns
-------
numpy.ndarray of shape (count,)

Raises
------
InvalidInput
    When `last` or `count` is out of range.
)");
}

}  // namespace crashsim::python
