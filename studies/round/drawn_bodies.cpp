// Bodies that are drawn: what geometry alone costs, from films of two or three level cameras.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "film_round.hpp"
#include "simulate/candle/virtual_camera.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/capture/capture.hpp"
#include "wisp/draw/video_writer.hpp"

namespace {

using namespace wisp;
using verify::value_or_abort;

constexpr double kDrawnRate = 60, kDrawnSeconds = 6, kDrawnPixelsPerMm = 7.5, kCellMm = 0.25, kTallMm = 34;
constexpr int kColumns = 200, kRows = 240;

struct Section {
  double x, z, radius;
};

double height_at(double t) { return kTallMm * (1 + 0.07 * std::sin(9 * t + 0.8 * t * t) + 0.03 * std::sin(23 * t)); }

// A flame's shape that leans and bends, every way round.
Section section_at(double y, double t) {
  const double up = std::clamp(y / height_at(t), 0.0, 1.0);
  const double lean = 11 * up * up * std::sin(2.1 * t),
               bend = 3 * std::sin(std::numbers::pi * up) * std::sin(5.3 * t + 1);
  const double towards = 0.9 * t + 0.5 * std::sin(1.3 * t);
  const double wide = up < 0.3 ? std::sqrt(1 - 0.5 * std::pow(1 - up / 0.3, 2)) : 1 - std::pow((up - 0.3) / 0.7, 2);
  return {lean * std::cos(towards) - bend * std::sin(towards), lean * std::sin(towards) + bend * std::cos(towards),
          4.2 * std::max(0.0, wide)};
}

void film(const std::string& path, double azimuth, double start) {
  VirtualCamera camera =
      value_or_abort(VirtualCamera::create({.width = 480, .seed = static_cast<std::uint64_t>(azimuth) + 7}));
  VideoWriter writer =
      value_or_abort(VideoWriter::create(path, {.width = 480, .height = 480, .rate_hz = kDrawnRate, .crf = 12}));
  const double c = std::cos(azimuth * std::numbers::pi / 180), s = std::sin(azimuth * std::numbers::pi / 180);
  RigLight light{kColumns, kRows, kCellMm, kColumns / 2 * kCellMm, 2, {}, {}};
  light.blue.assign(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
  for (int frame = 0; frame < static_cast<int>(kDrawnSeconds * kDrawnRate); ++frame) {
    const double t = start + frame / kDrawnRate;
    light.soot.assign(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
    for (int j = 0; j < kRows; ++j) {
      const double y = (j + 0.5) * kCellMm - light.wick_y_mm;
      if (y < 0 || y > height_at(t)) continue;
      const Section at = section_at(y, t);
      const double middle = at.x * c - at.z * s + light.wick_x_mm;
      for (int i = 0; i < kColumns; ++i) {
        const double inside = at.radius - std::abs((i + 0.5) * kCellMm - middle);
        light.soot[static_cast<std::size_t>(j) * kColumns + i] =
            static_cast<float>(std::clamp(0.5 + inside / 0.5, 0.0, 1.0));
      }
    }
    if (auto ok = writer.write(Image::from_rgb(camera.picture(light, static_cast<std::uint64_t>(frame)), 480, 480));
        !ok)
      std::abort();
  }
  if (auto ok = writer.finish(); !ok) std::abort();
}

}  // namespace

int drawn_bodies() {
  int status = 0;
  const auto folder = std::filesystem::temp_directory_path() / "wisp_drawn";
  std::filesystem::create_directories(folder);
  std::printf("angles | axis, %% of the height | radius, %% | began, s (true) | verdict\n");
  for (const std::vector<double>& angles : {std::vector<double>{0, 90}, {0, 40}, {0, 60, 120}}) {
    std::vector<std::filesystem::path> films;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      films.push_back(folder / (std::to_string(static_cast<int>(angles[k])) + ".mp4"));
      film(films.back().string(), angles[k], k == 0 ? 0 : 0.508 * static_cast<double>(k));
    }
    const Captured captured = value_or_abort(capture_views(films, angles, FlameCapture{}));
    const auto& table = captured.report.sections[0].tables[0];
    const double began = std::get<double>(table.rows.back()[3]), last = 0.508 * static_cast<double>(angles.size() - 1);
    const std::size_t first = static_cast<std::size_t>(std::ceil(began * kDrawnRate));
    constexpr double base = 0;  // mm: the film shows the body down to where it begins
    double axis = 0, radius = 0, count = 0;
    for (std::size_t row = 0; row < captured.recording.rows(); ++row) {
      const double t = static_cast<double>(first + row) / kDrawnRate;
      for (const double share : {0.15, 0.3, 0.45, 0.6, 0.75, 0.85}) {
        const double y = share * height_at(t);
        const auto cut = cut_at(captured.recording, row, (y - base) * kDrawnPixelsPerMm);
        if (!cut) continue;
        const Section truth = section_at(y, t), foot = section_at(0, t);
        axis += std::pow(cut->x / kDrawnPixelsPerMm - truth.x + foot.x, 2) +
                std::pow(cut->z / kDrawnPixelsPerMm - truth.z + foot.z, 2);
        radius += std::pow(cut->radius / kDrawnPixelsPerMm - truth.radius, 2);
        count += 1;
      }
    }
    axis = 100 * std::sqrt(axis / count) / kTallMm;
    radius = 100 * std::sqrt(radius / count) / kTallMm;
    for (std::size_t k = 0; k < angles.size(); ++k) std::printf("%s%.0f", k ? ", " : "", angles[k]);
    std::printf(" | %.2f | %.2f | %.3f (%.3f) | %s\n", axis, radius, began, last,
                captured.report.verdict->reason.c_str());
    if (axis > 3 || radius > 5) status = 1;
  }
  return status;
}
