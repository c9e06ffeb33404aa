#include "learn/chain/gusts/gust_report.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "record/number_text.hpp"

namespace wisp::chain {
namespace {

void add_direction(const std::string& id, const GustDirection& direction, const std::string& label,
                   ReportSection& section) {
  section.entries.push_back({id + ".median", direction.median, label + "direction off by, median", "degrees"});
  section.entries.push_back({id + ".mean", direction.mean, label + "direction off by, mean", "degrees"});
  section.entries.push_back({id + ".mean_clear",
                             direction.mean_clear,
                             label + "direction off by, clear gusts",
                             "degrees",
                             {},
                             "mean over gusts whose displacement stands out of chance"});
}

// A y that is not finite breaks a line.
void add_break(ReportSeries& out) {
  out.x.push_back(out.x.back());
  out.y.push_back(std::numeric_limits<double>::quiet_NaN());
}

// The parts of a way, from its first place, in which the wind blows, or in which it does not; broken in between.
void add_way(const std::vector<Triple>& way, const std::vector<bool>& blows, bool in_wind, ReportSeries& out) {
  const auto point = [&](std::size_t row) {
    out.x.push_back(100 * (way[row][0] - way.front()[0]));
    out.y.push_back(100 * (way[row][1] - way.front()[1]));
  };
  bool drawing = false;
  for (std::size_t row = 0; row + 1 < way.size(); ++row) {
    if (blows[row] == in_wind) {
      if (!drawing) point(row);
      point(row + 1);
    } else if (drawing) {
      add_break(out);
    }
    drawing = blows[row] == in_wind;
  }
  if (drawing) add_break(out);
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

void add_side(const std::string& id, const std::vector<std::vector<Triple>>& ways, const std::vector<Triple>& calm,
              const std::vector<bool>& blows, ReportSection& section) {
  const auto series = [&](const char* what, const char* label) {
    return ReportSeries{id + "." + what, label, "x, cm", "y, cm", {}, {}};
  };
  const std::vector<Triple> mean = mean_of(ways);
  for (const bool in_wind : {false, true}) {
    ReportSeries clones = series(in_wind ? "clones_in_wind" : "clones", "");
    for (const auto& way : ways) add_way(way, blows, in_wind, clones);
    section.series.push_back(std::move(clones));
  }
  ReportSeries still = series("calm", "without wind");
  add_way(calm, std::vector<bool>(calm.size(), false), false, still);
  section.series.push_back(std::move(still));
  for (const bool in_wind : {true, false}) {
    ReportSeries whole = series(in_wind ? "mean_in_wind" : "mean", in_wind ? "while the wind blows" : "after it");
    add_way(mean, blows, in_wind, whole);
    section.series.push_back(std::move(whole));
  }
}

}  // namespace

ReportSection gusts_section(const GustFigures& figures) {
  ReportSection section{"Gusts: the response against those held out"};
  section.entries = {
      {"gusts.learned", figures.gusts_learned, "gusts learned from", ""},
      {"gusts.judged", figures.gusts_judged, "gusts held out", ""},
      {"gusts.fit_percent", figures.fit_percent, "displacement fits by", "%", {}, "mean over clones"},
      {"gusts.velocity_fit_percent", figures.velocity_fit_percent, "velocity fits by", "%"},
      {"gusts.direction_degrees", figures.direction_degrees, "direction off by, median", "degrees"},
      {"gusts.direction_degrees_mean", figures.direction_degrees_mean, "direction off by, mean", "degrees"}};
  return section;
}

ReportSection gusts_section(const GustPlayFigures& figures) {
  ReportSection section{"Gusts, played from where each calm fall is at the onset"};
  auto& entries = section.entries;
  entries = {
      {"gusts.gusts", figures.gusts, "gusts", ""},
      {"gusts.clear_gusts", figures.clear_gusts, "clear ones", "", {}, "whose displacement stands out of chance"},
      {"gusts.clones", figures.clones, "clones of each", ""},
      {"gusts.fit_percent", figures.fit_percent, "displacement fits by", "%", {}, "mean over clones"},
      {"gusts.velocity_fit_percent", figures.velocity_fit_percent, "velocity fits by", "%"}};
  add_direction("gusts.direction_degrees", figures.direction, "", section);
  entries.push_back({"gusts.halves.fit_percent",
                     figures.halves_fit_percent,
                     "half the clones: displacement fits by",
                     "%",
                     {},
                     "the other half's, as recorded"});
  add_direction("gusts.halves.direction_degrees", figures.halves_direction, "half the clones: ", section);
  entries.push_back({"gusts.largest_displacement", figures.largest_displacement, "carried at most", "m"});
  entries.push_back({"gusts.largest_recorded_displacement", figures.largest_recorded_displacement, "  recorded", "m"});
  entries.push_back({"gusts.left_after", figures.left_after, "left after two seconds", "m/s"});
  entries.push_back({"gusts.diverges", figures.diverges, "diverges", ""});
  return section;
}

ReportSection scene_section(const GustScene& scene, std::size_t number) {
  const double degrees = std::atan2(scene.strongest[1], scene.strongest[0]) * 180 / std::acos(-1.0);
  ReportSection section{"gust " + std::to_string(scene.gust + 1) + ", " +
                        number_text(std::hypot(scene.strongest[0], scene.strongest[1]), 2) + " m/s towards " +
                        std::to_string(std::lround(degrees)) + "°"};
  const std::string id = "gusts-above." + std::to_string(number);
  add_side(id + ".recorded", scene.recorded, scene.recorded_calm, scene.blows, section);
  add_side(id + ".played", scene.played, scene.played_calm, scene.blows, section);
  return section;
}

}  // namespace wisp::chain
