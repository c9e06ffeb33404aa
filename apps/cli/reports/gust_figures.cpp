#include "reports/gust_figures.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "reports/clip_figures.hpp"
#include "terminal.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::cli {
namespace {

constexpr Colour kClone{205, 205, 205};
constexpr Colour kCloneInWind{190, 222, 190};
constexpr Colour kStill{40, 60, 110};
constexpr Colour kBlown{30, 140, 60};

// Every way begins where its own clone does, so that clones can be compared.
PlotSeries track_of(const std::vector<Triple>& way, const std::vector<bool>& blows, Colour in_wind, Colour else_where) {
  PlotSeries track;
  for (std::size_t row = 0; row < way.size(); ++row) {
    track.x.push_back(100 * (way[row][0] - way.front()[0]));
    track.y.push_back(100 * (way[row][1] - way.front()[1]));
    track.colours.push_back(blows[row] ? in_wind : else_where);
  }
  return track;
}

std::vector<Triple> mean_of(const std::vector<std::vector<Triple>>& ways) {
  std::vector<Triple> mean(ways.front().size());
  for (const auto& way : ways) {
    for (std::size_t row = 0; row < mean.size(); ++row) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        mean[row][axis] += (way[row][axis] - way.front()[axis]) / static_cast<double>(ways.size());
      }
    }
  }
  return mean;
}

PlotSeries key(const std::string& label, Colour colour, Dash dash) {
  return {.label = label, .x = {0}, .y = {std::nan("")}, .colour = colour, .width = 2.4, .dash = dash};
}

Plot plot_of(const std::string& title, const GustScene& scene, const std::vector<std::vector<Triple>>& ways,
             const std::vector<Triple>& calm) {
  Plot plot{.title = title, .x = {.label = "x, cm"}, .y = {.label = "y, cm"}, .equal_units = true};
  for (const auto& way : ways) {
    plot.series.push_back(track_of(way, scene.blows, kCloneInWind, kClone));
    plot.series.back().width = 0.6;
  }
  PlotSeries still = track_of(calm, std::vector<bool>(calm.size(), false), kStill, kStill);
  still.width = 1.4;
  still.dash = Dash::kDashed;
  PlotSeries mean = track_of(mean_of(ways), scene.blows, kBlown, kStill);
  mean.width = 3;
  plot.series.push_back(std::move(still));
  plot.series.push_back(std::move(mean));
  plot.series.push_back(key("while the wind blows", kBlown, Dash::kSolid));
  plot.series.push_back(key("after it", kStill, Dash::kSolid));
  plot.series.push_back(key("without wind", kStill, Dash::kDashed));
  return plot;
}

// Its number, and the wind at its strongest.
std::string name_of(const GustScene& scene) {
  const double degrees = std::atan2(scene.strongest[1], scene.strongest[0]) * 180 / std::acos(-1.0);
  return "gust " + std::to_string(scene.gust + 1) + ", " +
         shown(std::hypot(scene.strongest[0], scene.strongest[1]), 2) + " m/s towards " +
         std::to_string(std::lround(degrees)) + "°";
}

}  // namespace

Result<void> write_gust_figure(const std::filesystem::path& folder, std::span<const GustScene> scenes) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  PlotSheet sheet{.title = "Gusts seen from above: " + std::to_string(scenes.front().recorded.size()) +
                           " clones of a fall, from the onset to 0.3 s after the wind",
                  .columns = 2,
                  .plot_height = 340};
  for (const GustScene& scene : scenes) {
    const std::string name = name_of(scene);
    Plot a = plot_of(name + ": recorded", scene, scene.recorded, scene.recorded_calm);
    Plot b = plot_of("the model's own play", scene, scene.played, scene.played_calm);
    share_axes(a, b);
    sheet.plots.push_back(std::move(a));
    sheet.plots.push_back(std::move(b));
  }
  return write_figure(folder, "gusts-above", sheet);
}

}  // namespace wisp::cli
