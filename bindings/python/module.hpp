#pragma once
// Declarations shared by the sources of the Python module.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"

namespace wisp::python {

namespace py = pybind11;

/// The exception wisp.Error: one sentence about bad external data.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Maps this extension's Failure to the core's wisp.Error, as each extension has its own type Failure.
inline void share_error(const py::module_& core) {
  static const py::object error = core.attr("Error");
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Failure& failure) {
      PyErr_SetString(error.ptr(), failure.what());
    }
  });
}

/// Returns the value, or throws the error's sentence.
template <class T>
T unwrapped(Result<T> result) {
  if (!result) throw Failure(result.error().message);
  return *std::move(result);
}

inline void unwrap(const Result<void>& result) {
  if (!result) throw Failure(result.error().message);
}

/// Runs long work without the interpreter's lock. The callback receives the stages and may stop the work by returning
/// False, or a false value but None; Ctrl-C and the callback's own exceptions also stop it and are raised.
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
      const int truth = answer.is_none() ? 1 : PyObject_IsTrue(answer.ptr());
      if (truth < 0) throw py::error_already_set();
      return truth > 0;
    } catch (py::error_already_set& error) {
      error.restore();
      raised_ = true;
      return false;
    }
  }

  py::object callback_;
  bool raised_ = false;
};

/// Returns the documentation of a field TYPE.FIELD, which field_docs.py extracts from the headers; "" if it has none.
const char* doc_of(std::string_view type, std::string_view field);

/// Makes a T whose fields are set by keywords. An unknown keyword or an unsuitable value is a TypeError that names it.
template <class T>
T from_keywords(const py::kwargs& fields) {
  T made;
  const py::object seen = py::cast(&made, py::return_value_policy::reference);
  const auto type = py::type::of<T>().attr("__name__").template cast<std::string>();
  for (const auto& [name, value] : fields) {
    const auto field = py::str(name).cast<std::string>();
    if (!py::hasattr(seen, name)) throw py::type_error(type + ": there is no field '" + field + "'");
    try {
      py::setattr(seen, name, value);
    } catch (py::error_already_set& error) {
      if (!error.matches(PyExc_TypeError)) throw;
      throw py::type_error(type + "." + field + " does not take " + py::repr(value).template cast<std::string>() +
                           ": " + py::str(py::type::of<T>().attr(name).attr("__doc__")).template cast<std::string>());
    }
  }
  return made;
}

/// A class of options: fields are keywords, and help() shows the headers' documentation.
template <class T, class... Bases>
class Options : public py::class_<T, Bases...> {
 public:
  using Class = py::class_<T, Bases...>;
  Options(py::module_& module, const char* name) : Class(module, name), name_(name) {
    Class::def(py::init(&from_keywords<T>));
    Class::def("__repr__", [](const py::object& self) {
      std::string text = py::type::of(self).attr("__name__").template cast<std::string>() + "(";
      const py::object type = py::type::of(self);
      for (const auto& field : py::module_::import("builtins").attr("dir")(type)) {
        const auto word = py::str(field).cast<std::string>();
        if (word.starts_with("_")) continue;
        text += (text.ends_with("(") ? "" : ", ") + word + "=" +
                py::repr(self.attr(word.c_str())).template cast<std::string>();
      }
      return text + ")";
    });
  }
  template <class Member>
  Options& def_readwrite(const char* field, Member member) {
    Class::def_readwrite(field, member, doc_of(name_, field));
    return *this;
  }

 private:
  const char* name_;
};

template <class T, class... Bases>
Options<T, Bases...> options(py::module_& module, const char* name) {
  return Options<T, Bases...>(module, name);
}

void bind_recording(py::module_& module);
void bind_report(py::module_& module);
void bind_recipes(py::module_& module);
void bind_models(py::module_& module);
void bind_banks(py::module_& module);
void bind_sound(py::module_& module);

}  // namespace wisp::python
