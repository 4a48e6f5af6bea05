#pragma once
/// NumPy arrays in and out without copies.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <crashsim/simulate_many.hpp>

namespace crashsim::python {

namespace py = pybind11;

/// Whether an object is taken as an array: a sequence of numbers or what NumPy can make one of.
bool is_array_like(const py::handle& object);

/// @throws InvalidInput naming `what` when it is NaN or infinite.
void check_finite(double value, const std::string& what);

/// A one-dimensional array of doubles that a caller gave: theirs where it is contiguous float64, else a copy.
class Doubles {
 public:
  /// @throws InvalidInput naming `what` when it is not one-dimensional, TypeError when it holds no real numbers.
  Doubles(const py::handle& object, const std::string& what);

  [[nodiscard]] std::span<const double> view() const {
    return {array_.data(), static_cast<std::size_t>(array_.size())};
  }
  [[nodiscard]] std::vector<double> copy() const { return {view().begin(), view().end()}; }
  [[nodiscard]] const std::string& what() const { return what_; }

 private:
  py::array_t<double> array_;
  std::string what_;
};

/// @throws InvalidInput naming the first sample that is NaN or infinite.
void check_finite(const Doubles& samples);

/// A read-only array over `values`, which `owner` keeps alive.
py::array view_of(std::span<const double> values, const py::handle& owner);

/// The same of two dimensions.
py::array view_of(const RowMatrix& values, const py::handle& owner);

/// The same of whole numbers.
py::array view_of(const std::vector<std::uint64_t>& values, const py::handle& owner);

/// A copy of whole numbers >= 0. @throws py::cast_error when they are none.
std::vector<std::uint64_t> integers_from(const py::handle& object);

/// A copy of a two-dimensional array that a caller gave, of its shape (0, 0) for None.
/// @throws InvalidInput naming `what` when it is not two-dimensional, TypeError when it holds no real numbers.
RowMatrix matrix_from(const py::handle& object, const std::string& what);

/// An array that takes over `values`.
py::array array_of(std::vector<double>&& values);

/// A two-dimensional array of rows of equal length.
py::array array_of(const std::vector<std::vector<double>>& rows);

}  // namespace crashsim::python
