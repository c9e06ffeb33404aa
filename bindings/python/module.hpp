#pragma once
// What the parts of the Python module share.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <stdexcept>
#include <string>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"

namespace wisp::python {

namespace py = pybind11;

/// What Python sees as wisp.Error: one sentence about data from outside.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value, or the exception with the error's sentence.
template <class T>
T unwrapped(Result<T> result) {
  if (!result) throw Failure(result.error().message);
  return *std::move(result);
}

inline void unwrap(const Result<void>& result) {
  if (!result) throw Failure(result.error().message);
}

/// Runs long work without the interpreter's lock. The callback hears of stages and may end the work by returning False;
/// Ctrl-C and the callback's own exceptions end it too and are raised.
class Watch {
 public:
  explicit Watch(py::object callback) : callback_(std::move(callback)) {}

  template <class Work>
  auto run(Work work) {
    const Progress progress = [this](std::string_view stage, double share) { return goes_on(stage, share); };
    auto result = [&] {
      const py::gil_scoped_release released;
      return work(progress);
    }();
    if (raised_) throw py::error_already_set();
    return unwrapped(std::move(result));
  }

 private:
  bool goes_on(std::string_view stage, double share) {
    const py::gil_scoped_acquire held;
    if (raised_) return false;
    raised_ = PyErr_CheckSignals() != 0;
    if (raised_ || callback_.is_none()) return !raised_;
    try {
      const py::object answer = callback_(py::str(stage.data(), stage.size()), share);
      return answer.is_none() || answer.cast<bool>();
    } catch (py::error_already_set& error) {
      error.restore();
      raised_ = true;
      return false;
    }
  }

  py::object callback_;
  bool raised_ = false;
};

/// Sets each keyword as a field; an unknown one is Python's AttributeError, which names it.
template <class T>
T from_keywords(const py::kwargs& fields) {
  T made;
  const py::object seen = py::cast(&made, py::return_value_policy::reference);
  for (const auto& [name, value] : fields) {
    if (!py::hasattr(seen, name)) throw py::type_error("there is no field '" + py::str(name).cast<std::string>() + "'");
    py::setattr(seen, name, value);
  }
  return made;
}

void bind_recording(py::module_& module);
void bind_report(py::module_& module);
void bind_recipes(py::module_& module);
void bind_models(py::module_& module);
void bind_sound(py::module_& module);

}  // namespace wisp::python
