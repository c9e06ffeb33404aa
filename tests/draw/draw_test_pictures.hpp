#pragma once
// Outlines, folders and outside programs that the drawing tests share.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "draw/flame/flame_layers.hpp"
#include "paths.hpp"
#include "wisp/draw/flame.hpp"

namespace wisp {

/// A calm flame, `lean` model units aside at the tip: a drop of height 1 in model units.
inline std::vector<Point> drop_outline(float lean = 0, float height = 1, float width = 0.28F) {
  std::vector<Point> points;
  constexpr int kSteps = 80;
  for (int k = 0; k <= kSteps; ++k) {
    const float angle = 3.14159265F * static_cast<float>(k) / kSteps;
    const float y = height * std::pow(std::sin(angle), 2.0F);
    const float side = -std::cos(angle);
    const float half = 0.5F * width * (0.35F + 1.3F * y / height * (1 - y / height) * 2);
    points.push_back({half * side * (1 - std::pow(y / height, 6.0F)) + lean * y * y / height, y});
  }
  return points;
}

inline float brightness_at(const Image& image, int x, int y) {
  const Colour colour = image.at(x, y);
  return 0.2126F * colour.red + 0.7152F * colour.green + 0.0722F * colour.blue;
}

/// One candle over what the picture holds.
inline void draw_flame(Image& image, std::span<const Point> outline, const FlameScene& scene,
                       const FlameStyle& style = {}) {
  const Flame flame{outline, scene};
  draw_flames(image, {&flame, 1}, style);
}

/// The room of LiveFlames without its flames, by all pixels.
inline void draw_room(Image& image, std::span<const Flame> flames, const FlameStyle& style = {}) {
  using namespace drawing;
  std::vector<Stand> stands;
  for (const Flame& flame : flames) {
    const Candle candle = prepared(flame, image.width(), image.height());
    stands.push_back(stand_of(candle.scene, clamped(style), candle.lamp));
  }
  Room room(image.width(), image.height());
  LightField codes = room.lit(stands);
  const Tone& tone = Tone::get();
  for (Plane* plane : {&codes.red, &codes.green, &codes.blue}) {
    for (float& value : plane->values) value = tone.code(value);
  }
  std::vector<float> scratch(static_cast<std::size_t>(codes.width()) + 2), dither(image.width());
  Row row(image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) dither[x] = rounding_at(x, y);
    spread(codes, Between(y, codes.height()), scratch, row, image.width());
    write_codes(row, dither.data(), image.row(y).data(), 0, image.width());
  }
}

/// A folder of the test's own, removed at its end.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name) : path_(std::filesystem::path(WISP_BINARY_DIR) / ("draw-" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

/// What a program writes to its standard output.
inline std::string output_of(const std::string& command) {
  struct Close {
    void operator()(std::FILE* pipe) const { ::pclose(pipe); }
  };
  const std::unique_ptr<std::FILE, Close> pipe(::popen(command.c_str(), "r"));
  std::string text;
  std::array<char, 65536> part{};
  for (std::size_t got = 0; pipe && (got = std::fread(part.data(), 1, part.size(), pipe.get())) > 0;) {
    text.append(part.data(), got);
  }
  return text;
}

inline bool has_program(const std::string& name) { return !output_of("command -v " + name + " 2>/dev/null").empty(); }

}  // namespace wisp
