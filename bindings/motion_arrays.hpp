#pragma once
/// The longitudinal motion that a caller gives, as arrays.
#include <string>

#include <pybind11/pybind11.h>

#include <crashsim/metrics.hpp>

#include "arrays.hpp"

namespace crashsim::python {

namespace py = pybind11;

/// The arrays of a motion, as long as the call needs them.
struct MotionArrays {
  Doubles time_s, accel_mps2, velocity_mps, displacement_m;

  [[nodiscard]] Motion view() const {
    return {time_s.view(), accel_mps2.view(), velocity_mps.view(), displacement_m.view()};
  }
};

/// Of any object that has the attributes: a Pulse, a response, a table.
inline MotionArrays motion_of(const py::object& motion) {
  const auto channel = [&](const char* name) {
    if (!py::hasattr(motion, name))
      throw py::type_error("motion: " + std::string(py::str(py::type::of(motion))) + " has no " + name +
                           "; give a Pulse, a response, or time_s, accel_mps2, velocity_mps, displacement_m");
    return Doubles(motion.attr(name), name);
  };
  return {channel("time_s"), channel("accel_mps2"), channel("velocity_mps"), channel("displacement_m")};
}

}  // namespace crashsim::python
