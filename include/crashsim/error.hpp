#pragma once
/// Errors and the mark of an unset number.

#include <limits>
#include <stdexcept>

namespace crashsim {

/// A number nobody has set or computed yet. NaN, so that using it by mistake shows.
inline constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

/// The caller can fix it: a bad value, file, name or unit. Exit code 2; `ValueError` in Python.
class InvalidInput : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The numbers failed and no result could be formed. Exit code 3; `RuntimeError` in Python.
class NumericalFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine failed: a file cannot be written, no memory. Exit code 4; `OSError` in Python.
class SystemFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C). Exit code 130; `KeyboardInterrupt` in Python.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace crashsim
