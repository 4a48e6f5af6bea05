#include "arrays.hpp"

#include <cmath>
#include <memory>
#include <string_view>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

namespace crashsim::python {
namespace {

constexpr std::string_view kRealKinds = "biuf";  // of NumPy's dtypes: bool, signed, unsigned, floating

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

/// Masked samples hold anything: they are no data.
void refuse_masked(const py::handle& object, const std::string& what) {
  if (!py::hasattr(object, "mask") || !py::hasattr(object, "filled")) return;
  if (py::module_::import("numpy").attr("any")(object.attr("mask")).cast<bool>())
    throw InvalidInput(what + ": has masked samples; cut them off or fill them");
}

/// An object as an array of real numbers of so many dimensions.
py::array_t<double> real_array(const py::handle& object, int dimensions, const std::string& what) {
  if (!is_array_like(object))
    throw py::type_error(what + ": must be an array of real numbers, is " +
                         std::string(py::repr(py::type::of(object))));
  refuse_masked(object, what);
  const py::array array = py::module_::import("numpy").attr("asarray")(object);
  const char kind = array.dtype().kind();
  if (array.size() > 0 && kRealKinds.find(kind) == std::string_view::npos)
    throw py::type_error(what + ": must be an array of real numbers, its dtype is " +
                         std::string(py::str(array.dtype())));
  if (array.ndim() != dimensions)
    throw InvalidInput(what + ": must be " + (dimensions == 1 ? "one" : "two") + "-dimensional, its shape is " +
                       shape_of(array));
  return py::array_t<double, py::array::c_style | py::array::forcecast>(array);
}

}  // namespace

bool is_array_like(const py::handle& object) {
  if (py::isinstance<py::str>(object) || py::isinstance<py::bytes>(object)) return false;
  return py::isinstance<py::sequence>(object) || py::hasattr(object, "__array__");
}

void check_finite(double value, const std::string& what) {
  if (!std::isfinite(value)) throw InvalidInput(what + " = " + format_number(value) + ": must be finite");
}

void check_finite(const Doubles& samples) {
  const std::span<const double> values = samples.view();
  for (std::size_t i = 0; i < values.size(); ++i)
    check_finite(values[i], samples.what() + "[" + std::to_string(i) + "]");
}

Doubles::Doubles(const py::handle& object, const std::string& what)
    : array_(real_array(object, 1, what)), what_(what) {}

py::array view_of(std::span<const double> values, const py::handle& owner) {
  py::array_t<double> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array view_of(const RowMatrix& values, const py::handle& owner) {
  py::array_t<double> array({values.rows(), values.cols()}, values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array view_of(const std::vector<std::uint64_t>& values, const py::handle& owner) {
  py::array_t<std::uint64_t> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

std::vector<std::uint64_t> integers_from(const py::handle& object) {
  std::vector<std::uint64_t> numbers;
  for (const py::handle item : object.cast<py::iterable>()) numbers.push_back(item.cast<std::uint64_t>());
  return numbers;
}

RowMatrix matrix_from(const py::handle& object, const std::string& what) {
  if (object.is_none()) return {};
  const py::array_t<double> array = real_array(object, 2, what);
  return Eigen::Map<const RowMatrix>(array.data(), array.shape(0), array.shape(1));
}

py::array array_of(std::vector<double>&& values) {
  auto owned = std::make_unique<std::vector<double>>(std::move(values));
  const auto size = static_cast<py::ssize_t>(owned->size());
  const double* data = owned->data();
  const py::capsule owner(owned.release(), [](void* pointer) { delete static_cast<std::vector<double>*>(pointer); });
  return py::array_t<double>(size, data, owner);
}

py::array array_of(const std::vector<std::vector<double>>& rows) {
  const auto height = static_cast<py::ssize_t>(rows.size());
  const auto width = rows.empty() ? 0 : static_cast<py::ssize_t>(rows.front().size());
  py::array_t<double> array({height, width});
  auto cells = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < height; ++i)
    for (py::ssize_t j = 0; j < width; ++j)
      cells(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace crashsim::python
