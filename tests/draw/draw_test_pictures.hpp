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

#include "paths.hpp"
#include "wisp/draw/image.hpp"

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
