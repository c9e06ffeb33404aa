// Lottie animations: Lottie Animation Community, specification 1.0.1, sections "Layers", "Shapes" and "Properties".

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/json_text.hpp"
#include "export/outline.hpp"
#include "wisp/export/export.hpp"

namespace wisp {
namespace {

using namespace exporting;

constexpr int kShapeLayer = 4;
constexpr double kDrop = 0.6;  // length of the tangents of the drop below the base, as a share of the base's width

// Position and scale of the outline in the picture.
struct Frame {
  double left = 0, top = 0, scale = 1;
  int width = 0, height = 0;
};

// Returns a picture frame that contains the first instance's outlines in all frames, their drops and a margin.
Frame frame_of(const Take& take, int height) {
  constexpr double kRoom = 0.05;
  double low[2] = {1e30, 0}, high[2] = {-1e30, -1e30};
  for (std::size_t frame = 0; frame < take.frames; ++frame) {
    const auto row = take.at(frame, 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      low[i % 2] = std::min<double>(low[i % 2], row[i]);
      high[i % 2] = std::max<double>(high[i % 2], row[i]);
    }
    low[1] = std::min(low[1], row[1] - kDrop * std::abs(row[row.size() - 2] - row[0]));
  }
  Frame frame{.height = height};
  frame.scale = height / (std::max(1e-6, high[1] - low[1]) * (1 + 2 * kRoom));
  const double room = kRoom * height;
  frame.width = std::max(16, static_cast<int>(std::ceil((high[0] - low[0]) * frame.scale + 2 * room)));
  frame.left = room - low[0] * frame.scale;
  frame.top = room + high[1] * frame.scale;
  return frame;
}

// Writes one path: vertices with their incoming and outgoing tangents.
void write_path(const std::vector<double>& knots, std::span<const float> control, const Frame& frame, JsonText& json) {
  auto points = bezier_points(knots, control);
  for (auto& point : points) point = {frame.left + frame.scale * point[0], frame.top - frame.scale * point[1]};
  const auto between = [](const std::array<double, 2>& from, const std::array<double, 2>& to) {
    return std::hypot(to[0] - from[0], to[1] - from[1]);
  };
  const double drop = kDrop * between(points.front(), points.back());
  const auto write = [&](const char* key, int step) {
    json.list(key);
    for (std::size_t k = 0; k < points.size(); k += 3) {
      // Below the base the path closes as a drop around the wick: both sides continue in their final directions.
      const bool closing = step < 0 ? k == 0 : k + 1 == points.size();
      const std::size_t beside = (step < 0) != closing ? k - 1 : k + 1;
      const double share = closing ? -drop / std::max(1e-6, between(points[k], points[beside])) : 1;
      json.list();
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double value = step == 0 ? points[k][axis] : share * (points[beside][axis] - points[k][axis]);
        json.value(std::round(value * 1000) / 1000);
      }
      json.end();
    }
    json.end();
  };
  write("v", 0);
  write("i", -1);
  write("o", 1);
  json.value(true, "c");
}

// Writes the path with linear keys, one per frame, each with start and end values for old players, the last with none.
void write_keys(const OutlineView& view, const Take& take, const Frame& frame, JsonText& json) {
  json.object().value("sh", "ty").value("path", "nm").object("ks").value(1, "a").list("k");
  const std::size_t last = take.frames - (take.loop || take.frames == 1 ? 0 : 1);
  for (std::size_t key = 0; key < last; ++key) {
    json.object().value(key, "t");
    json.object("o").values(std::vector{0}, "x").values(std::vector{0}, "y").end();
    json.object("i").values(std::vector{1}, "x").values(std::vector{1}, "y").end();
    for (const std::size_t end : {0, 1}) {
      json.list(end == 0 ? "s" : "e").object();
      write_path(view.knots, take.at((key + end) % take.frames, 0), frame, json);
      json.end().end();
    }
    json.end();
  }
  json.object().value(last, "t").end();
  json.end().end().end();
}

template <class Values>
void write_fixed(const char* key, const Values& values, JsonText& json) {
  json.object(key).value(0, "a").values(values, "k").end();
}

// Writes a transform that scales about a point, in percent.
void write_transform(JsonText& json, std::array<double, 2> about = {0, 0}, std::array<double, 2> scale = {100, 100}) {
  write_fixed("p", about, json);
  write_fixed("a", about, json);
  write_fixed("s", scale, json);
  json.object("r").value(0, "a").value(0, "k").end().object("o").value(0, "a").value(100, "k").end();
}

// A gradient stop: position, sRGB colour, opacity.
struct Stop {
  double at, red, green, blue, opacity;
};

// A filled outline, scaled about a point.
struct Part {
  const char* name;
  bool radial;
  std::array<double, 2> from, to, about, scale;
  std::vector<Stop> stops;
};

// Writes a gradient fill: colours of all stops, then their opacities.
void write_gradient(const Part& part, JsonText& json) {
  json.object().value("gf", "ty").value("fill", "nm").value(part.radial ? 2 : 1, "t").value(1, "r");
  json.object("o").value(0, "a").value(100, "k").end();
  write_fixed("s", part.from, json);
  write_fixed("e", part.to, json);
  json.object("h").value(0, "a").value(0, "k").end().object("a").value(0, "a").value(0, "k").end();
  std::vector<double> numbers;
  for (const Stop& stop : part.stops) numbers.insert(numbers.end(), {stop.at, stop.red, stop.green, stop.blue});
  for (const Stop& stop : part.stops) numbers.insert(numbers.end(), {stop.at, stop.opacity});
  json.object("g").value(part.stops.size(), "p");
  write_fixed("k", numbers, json);
  json.end().end();
}

// Colours of the flipbook's flame from below its base to its tip, as tools/flame_picture.py prints them.
const std::vector<Stop> kBody = {
    {0, 0.248, 0.416, 1, 0.371},     {0.107, 0.248, 0.416, 1, 0.371}, {0.179, 0.547, 0.445, 1, 0.35},
    {0.25, 1, 0.463, 0.353, 0.677},  {0.33, 1, 0.577, 0.154, 0.927},  {0.464, 1, 0.852, 0.52, 0.978},
    {0.643, 1, 0.875, 0.585, 0.978}, {0.821, 1, 0.839, 0.481, 0.978}, {1, 1, 0.607, 0.163, 0.939}};
constexpr std::array kCores{std::array{44.0, 70.0}, std::array{62.0, 80.0}, std::array{80.0, 90.0}};  // scales, percent

// Returns the parts, topmost first: nested copies of the outline, which together are a bright core without an edge,
// then the body, blue and translucent at the base, orange at the tip.
std::vector<Part> parts_of(const Take& take, const Frame& frame) {
  double x = 0, y = 0, height = 0;  // mean base and mean height of the tip
  const double share = 1 / static_cast<double>(take.frames);
  for (std::size_t k = 0; k < take.frames; ++k) {
    const auto row = take.at(k, 0);
    double tip = row[1];
    for (std::size_t i = 1; i < row.size(); i += 2) tip = std::max<double>(tip, row[i]);
    x += share * (row[0] + row[row.size() - 2]) / 2;
    y += share * (row[1] + row[row.size() - 1]) / 2;
    height += share * (tip - row[1]);
  }
  const double left = frame.left + frame.scale * x, base = frame.top - frame.scale * y, scale = frame.scale * height;
  const auto at = [&](double along) { return std::array{std::round(left), std::round(base - along * scale)}; };
  std::vector<Part> parts;
  for (const auto& size : kCores) {
    const std::vector<Stop> fade = {{0, 1, 0.97, 0.85, 0.6}, {0.5, 1, 0.97, 0.85, 0.5}, {1, 1, 0.97, 0.85, 0}};
    parts.push_back({"core", true, at(0.5), at(0.5 + size[1] / 180), at(0.42), size, fade});
  }
  parts.push_back({"body", false, at(-0.12), at(1), {0, 0}, {100, 100}, kBody});
  return parts;
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
  for (const Part& part : parts_of(take, frame)) {
    json.object().value("gr", "ty").value(part.name, "nm").list("it");
    write_keys(*view, take, frame, json);
    write_gradient(part, json);
    json.object().value("tr", "ty");
    write_transform(json, part.about, part.scale);
    json.end().end().end();
  }
  json.end().end().end().end();
  return json.text();
}

}  // namespace wisp
