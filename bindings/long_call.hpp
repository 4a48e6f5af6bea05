#pragma once
/// Long work without Python's lock; Ctrl-C and a progress callback get their turn.
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <crashsim/identify.hpp>

namespace crashsim::python {

namespace py = pybind11;

/// The progress function of one call: asks Python for Ctrl-C and tells `callback(done, total)`, if it is one.
class Watch {
 public:
  explicit Watch(py::object callback) : callback_(std::move(callback)) {}

  /// Called by the engine, without Python's lock. False: stop.
  bool operator()(int done, int total) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) {
      raised_.emplace();
    } else if (!callback_.is_none()) {
      try {
        stopped_ = tell(done, total).is(py::bool_(false));
      } catch (py::error_already_set& error) {
        raised_ = std::move(error);
      }
    }
    return !raised_ && !stopped_;
  }

  /// Raises what Ctrl-C or the callback raised.
  void rethrow() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }

 private:
  /// A bar such as tqdm's is brought to where the work is, a function is called.
  py::object tell(int done, int total) {
    if (!py::hasattr(callback_, "update")) return callback_(done, total);
    callback_.attr("total") = total;
    return callback_.attr("update")(done - callback_.attr("n").cast<int>());
  }

  py::object callback_;
  std::optional<py::error_already_set> raised_;
  bool stopped_ = false;
};

/// `work(progress)` without Python's lock. What Python raised in between is raised, whatever the work made of it.
template <class Work>
auto watched(const py::object& callback, Work&& work) {
  Watch watch(callback);
  const Progress progress = [&watch](int done, int total) { return watch(done, total); };
  try {
    auto result = [&] {
      const py::gil_scoped_release release;
      return work(progress);
    }();
    watch.rethrow();
    return result;
  } catch (const Interrupted&) {
    watch.rethrow();
    throw;
  }
}

/// Tells Python's logging, logger "crashsim", what a careful reader should know.
inline void log_warnings(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  const py::object logger = py::module_::import("logging").attr("getLogger")("crashsim");
  for (const std::string& warning : warnings) logger.attr("warning")("%s", warning);
}

/// `work()` without Python's lock.
template <class Work>
auto unlocked(Work&& work) {
  const py::gil_scoped_release release;
  return work();
}

}  // namespace crashsim::python
