// Lottie animations: the specification of the Lottie Animation Community, version 1.0.1, sections "Layers", "Shapes"
// and "Properties".

#include <algorithm>
#include <cmath>

#include "base/json_text.hpp"
#include "export/outline.hpp"
#include "wisp/export/export.hpp"

namespace wisp {
namespace {

using namespace exporting;

constexpr int kShapeLayer = 4;

// Position and scale of the outline in the picture.
struct Frame {
  double left = 0, top = 0, scale = 1;
  int width = 0, height = 0;
};

// A picture that contains the range of the model's outputs and a margin.
Frame frame_of(const Take& take, int height) {
  constexpr double kRoom = 0.05;
  double low[2] = {1e30, 0}, high[2] = {-1e30, -1e30};
  for (std::size_t frame = 0; frame < take.frames; ++frame) {
    const auto row = take.at(frame, 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      low[i % 2] = std::min<double>(low[i % 2], row[i]);
      high[i % 2] = std::max<double>(high[i % 2], row[i]);
    }
  }
  Frame frame{.height = height};
  frame.scale = height / (std::max(1e-6, high[1] - low[1]) * (1 + 2 * kRoom));
  const double room = kRoom * height;
  frame.width = std::max(16, static_cast<int>(std::ceil((high[0] - low[0]) * frame.scale + 2 * room)));
  frame.left = room - low[0] * frame.scale;
  frame.top = room + high[1] * frame.scale;
  return frame;
}

// One path: vertices with their incoming and outgoing tangents.
void write_path(const std::vector<double>& knots, std::span<const float> control, const Frame& frame, JsonText& json) {
  auto points = bezier_points(knots, control);
  for (auto& point : points) point = {frame.left + frame.scale * point[0], frame.top - frame.scale * point[1]};
  const auto pixels = [](double value) { return std::round(value * 1000) / 1000; };
  const auto write = [&](const char* key, int step) {
    json.list(key);
    for (std::size_t k = 0; k < points.size(); k += 3) {
      const std::size_t beside = step < 0 ? (k > 0 ? k - 1 : k) : (step > 0 && k + 1 < points.size() ? k + 1 : k);
      const double base = step == 0 ? 0 : 1;
      json.list();
      for (std::size_t axis = 0; axis < 2; ++axis) json.value(pixels(points[beside][axis] - base * points[k][axis]));
      json.end();
    }
    json.end();
  };
  write("v", 0);
  write("i", -1);
  write("o", 1);
  json.value(true, "c");
}

// A key has its start and end value, which old players need; the last one only its time.
void write_key(const OutlineView& view, const Take& take, std::size_t key, const Frame& frame, JsonText& json) {
  json.object().value(key, "t");
  // Linear interpolation between keys.
  json.object("o").values(std::vector{0}, "x").values(std::vector{0}, "y").end();
  json.object("i").values(std::vector{1}, "x").values(std::vector{1}, "y").end();
  for (const std::size_t end : {0, 1}) {
    json.list(end == 0 ? "s" : "e").object();
    write_path(view.knots, take.at((key + end) % take.frames, 0), frame, json);
    json.end().end();
  }
  json.end();
}

template <class Values>
void write_fixed(const char* key, const Values& values, JsonText& json) {
  json.object(key).value(0, "a").values(values, "k").end();
}

void write_transform(JsonText& json) {
  write_fixed("p", std::vector{0, 0}, json);
  write_fixed("a", std::vector{0, 0}, json);
  write_fixed("s", std::vector{100, 100}, json);
  json.object("r").value(0, "a").value(0, "k").end().object("o").value(0, "a").value(100, "k").end();
}

}  // namespace

Result<std::string> lottie_text(const Model& model, const Take& take, int height) {
  if (auto ok = check_take(model, take); !ok) return ok.error();
  const auto* view = std::get_if<OutlineView>(&model.view);
  if (!view)
    return Error{"the model's outputs are no outline to draw; a body's motion goes into a .glb, a lamp into a .c"};
  if (height < 16 || height > 8192) {
    return Error{"the height is " + std::to_string(height) + " pixels, expected 16 to 8192"};
  }
  const Frame frame = frame_of(take, height);
  JsonText json;
  json.object().value("5.7.0", "v").value(take.rate_hz, "fr").value(0, "ip").value(take.frames, "op");
  json.value(frame.width, "w").value(frame.height, "h").value(0, "ddd").list("assets").end();
  json.list("layers").object().value(0, "ddd").value(1, "ind").value(kShapeLayer, "ty").value("outline", "nm");
  json.value(1, "sr").object("ks");
  write_transform(json);
  json.end().value(0, "ip").value(take.frames, "op").value(0, "st").list("shapes");
  json.object().value("gr", "ty").value("shape", "nm").list("it");
  json.object().value("sh", "ty").value("path", "nm").object("ks").value(1, "a").list("k");
  const std::size_t last = take.frames - (take.loop ? 0 : 1);
  for (std::size_t key = 0; key < last; ++key) write_key(*view, take, key, frame, json);
  json.object().value(last, "t").end();
  json.end().end().end();
  json.object().value("fl", "ty").value("fill", "nm");
  write_fixed("c", std::vector{1.0, 0.68, 0.25, 1.0}, json);
  json.object("o").value(0, "a").value(100, "k").end().value(1, "r").end();
  json.object().value("tr", "ty");
  write_transform(json);
  json.end().end().end().end().end().end().end();
  return json.text();
}

}  // namespace wisp
