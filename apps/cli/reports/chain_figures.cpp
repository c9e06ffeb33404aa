#include "reports/chain_figures.hpp"

#include <string>
#include <string_view>

#include "reports/clip_figures.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::cli {
namespace {

constexpr Colour kModeColours[] = {{31, 119, 180}, {214, 96, 20},  {44, 140, 44},   {190, 40, 40},
                                   {130, 90, 180}, {120, 80, 60},  {210, 100, 170}, {90, 90, 90},
                                   {150, 150, 20}, {20, 160, 170}, {0, 0, 0},       {240, 170, 60}};
constexpr Colour kStill{40, 60, 110};
constexpr Colour kBlown{30, 140, 60};

// How a series is drawn, by the last word of its id.
void style(std::string_view what, PlotSeries& series) {
  if (what == "events") {
    series.shape = SeriesShape::kPoints;
    series.colour = Colour{0, 0, 0};
    series.marker = Marker::kRing;
  } else if (what.starts_with("mode_")) {
    series.width = 2;
    series.colour = kModeColours[std::stoul(std::string(what.substr(5))) % std::size(kModeColours)];
  } else if (what.starts_with("clones")) {
    series.width = 0.6;
    series.colour = what == "clones" ? Colour{205, 205, 205} : Colour{190, 222, 190};
  } else if (what == "calm") {
    series.width = 1.4;
    series.colour = kStill;
    series.dash = Dash::kDashed;
  } else if (what.starts_with("mean")) {
    series.width = 3;
    series.colour = what == "mean" ? kStill : kBlown;
  } else {
    series.width = 1;
  }
}

// The series of the sections whose id is `panel` or begins with it and a dot.
Plot plot_of(const Report& report, const std::string& panel, const std::string& title) {
  Plot plot{.title = title, .equal_units = true};
  for (const ReportSection& section : report.sections) {
    for (const ReportSeries& series : section.series) {
      if (series.id != panel && !series.id.starts_with(panel + ".")) continue;
      plot.x.label = series.x_label;
      plot.y.label = series.y_label;
      plot.series.push_back({.label = series.label, .x = series.x, .y = series.y});
      style(std::string_view(series.id).substr(std::min(series.id.size(), panel.size() + 1)), plot.series.back());
    }
  }
  return plot;
}

void add_pair(const Report& report, const std::string& figure, const char* second, const std::string& before,
              PlotSheet& sheet) {
  Plot a = plot_of(report, figure + ".recorded", before + "recorded");
  Plot b = plot_of(report, figure + "." + second, second);
  share_axes(a, b);
  sheet.plots.push_back(std::move(a));
  sheet.plots.push_back(std::move(b));
}

}  // namespace

Result<void> write_chain_figures(const std::filesystem::path& folder, const Report& report) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  const std::pair<const char*, const char*> figures[] = {{"falls-side", "Falls seen from the side"},
                                                         {"falls-above", "Falls seen from above"},
                                                         {"segments", "One fall, cut at its events"}};
  for (const auto& [name, title] : figures) {
    PlotSheet sheet{.title = title};
    add_pair(report, name, "synthesized", "", sheet);
    if (sheet.plots.front().series.empty()) continue;
    if (auto ok = write_figure(folder, name, sheet); !ok) return ok;
  }
  PlotSheet gusts{
      .title = "Gusts seen from above, from the onset to 0.3 s after the wind", .columns = 2, .plot_height = 340};
  for (const ReportSection& section : report.sections) {
    if (section.series.empty() || !section.series.front().id.starts_with("gusts-above.")) continue;
    const std::string& id = section.series.front().id;
    add_pair(report, id.substr(0, id.find('.', id.find('.') + 1)), "played", section.title + ": ", gusts);
  }
  return gusts.plots.empty() ? Result<void>() : write_figure(folder, "gusts-above", gusts);
}

}  // namespace wisp::cli
