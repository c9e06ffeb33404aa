// Recordings from films: a separate extension, since it needs FFmpeg's libraries.

#include "wisp/capture/capture.hpp"

#include "module.hpp"

PYBIND11_MODULE(_capture, module) {
  using namespace wisp;
  using namespace wisp::python;
  const py::module_ core = py::module_::import("wisp._wisp");  // provides the types of arguments and results
  share_error(core);
  options<ClipCapture>(module, "ClipCapture")
      .def_readwrite("points", &ClipCapture::points)
      .def_readwrite("dark", &ClipCapture::dark)
      .def_readwrite("flame", &ClipCapture::flame)
      .def_readwrite("rate_hz", &ClipCapture::rate_hz);
  options<FlameCapture, ClipCapture>(module, "FlameCapture");
  py::class_<Captured>(module, "Captured")
      .def_readonly("recording", &Captured::recording)
      .def_readonly("report", &Captured::report);
  module.def(
      "capture",
      [](const std::filesystem::path& path, const ClipCapture& how, py::object progress) {
        return Watch(std::move(progress)).run([&](const Progress& watch) { return capture(path, how, watch); });
      },
      py::arg("path"), py::arg("options") = FlameCapture{}, py::kw_only(), py::arg("progress") = py::none(),
      "The outline in a video or a folder of images, and the wind in its sound. The default follows a flame.");
}
