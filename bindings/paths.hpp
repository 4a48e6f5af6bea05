#pragma once
/// Paths that callers give.
#include <string>

#include <pybind11/pybind11.h>

namespace crashsim::python {

/// Text of a str or os.PathLike.
inline std::string path_text(const pybind11::object& path) {
  return pybind11::str(pybind11::module_::import("os").attr("fspath")(path));
}

}  // namespace crashsim::python
