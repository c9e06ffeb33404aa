// Wind from sound, block by block.

#include <span>
#include <vector>

#include "module.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::python {
namespace {

using Samples = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// An estimator and the number of its stream's channels.
struct Stream : WindLevel {
  int channels;
};

/// Feeds all samples; returns a dictionary of arrays with one value per completed frame.
py::dict feed(Stream& level, const Samples& samples) {
  if (samples.size() % level.channels != 0)
    throw py::value_error("found " + std::to_string(samples.size()) + " samples, expected whole rows of " +
                          std::to_string(level.channels) + " channels");
  std::span<const float> left(samples.data(), static_cast<std::size_t>(samples.size()));
  std::vector<WindFrame> frames;
  {
    const py::gil_scoped_release released;
    WindFrame some[256];
    while (!left.empty()) {
      const WindFed fed = level.feed(left, some);
      if (fed.samples == 0 && fed.frames == 0) break;
      frames.insert(frames.end(), some, some + fed.frames);
      left = left.subspan(fed.samples);
    }
  }
  const auto column = [&](float WindFrame::*field) {
    py::array_t<float> values(static_cast<py::ssize_t>(frames.size()));
    for (std::size_t k = 0; k < frames.size(); ++k) values.mutable_at(static_cast<py::ssize_t>(k)) = frames[k].*field;
    return values;
  };
  py::dict made;
  made["wind"] = column(&WindFrame::wind);
  made["speed"] = column(&WindFrame::speed);
  made["level"] = column(&WindFrame::level);
  made["rms"] = column(&WindFrame::rms);
  made["confidence"] = column(&WindFrame::confidence);
  made["background"] = column(&WindFrame::background);
  made["clipped"] = column(&WindFrame::clipped);
  return made;
}

}  // namespace

void bind_sound(py::module_& module) {
  py::enum_<WindAsk>(module, "WindAsk")
      .value("BREATHE_GENTLY", WindAsk::kBreatheGently)
      .value("BLOW_HARD", WindAsk::kBlowHard);
  py::class_<Stream>(module, "WindLevel", "The wind that a microphone hears, as its sound comes.")
      .def(py::init([](double rate_hz, int channels, double frame_rate_hz) {
             auto level = unwrapped(WindLevel::create({rate_hz, channels}, {.frame_rate_hz = frame_rate_hz}));
             return Stream{std::move(level), channels};
           }),
           py::arg("rate_hz") = 44100.0, py::arg("channels") = 1, py::arg("frame_rate_hz") = 60.0)
      .def("feed", &feed, py::arg("samples"),
           "Takes samples, full scale 1, interleaved; returns arrays with a value for each frame that they complete.")
      .def("calibrate", &WindLevel::calibrate, py::arg("ask"), py::arg("seconds") = 3.0)
      .def_property_readonly("calibrating", &WindLevel::calibrating)
      .def_property_readonly("calibrated", &WindLevel::calibrated)
      .def_property_readonly("room_rise_db", &WindLevel::room_rise_db);
}

}  // namespace wisp::python
