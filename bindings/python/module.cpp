#include "module.hpp"

PYBIND11_MODULE(_wisp, module) {
  using namespace wisp::python;
  module.doc() = "Learns how a thing behaves from recordings of it, and plays that behaviour live.";
  module.attr("__version__") = WISP_VERSION;
  py::register_exception<Failure>(module, "Error", PyExc_ValueError);
  bind_recording(module);
  bind_report(module);
  bind_recipes(module);
  bind_models(module);
  bind_banks(module);
  bind_sound(module);
}
