#include "reports/arx_validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reports/clip_figures.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMaxOutputs = 4, kMaxInputs = 16;
constexpr std::size_t kMaxRows = 1000;       // maximum rows of a plot: more rows than pixels are illegible
constexpr std::size_t kPredictedRows = 200;  // rows of a plot of predictions: few enough to show the interval's width
constexpr double kFar = 1.5;  // zeros beyond this |z| are only counted in the title: drawn, they would shrink the plot

// Series of a report, by their ids.
class Figures {
 public:
  Figures(const Model& model, const Report& report) : model_(model), report_(report) {}

  const ReportSeries* find(const std::string& id) const {
    for (const ReportSection& section : report_.sections) {
      for (const ReportSeries& series : section.series) {
        if (series.id == id) return &series;
      }
    }
    return nullptr;
  }
  const ReportSeries* find(const char* id, std::size_t output) const { return find(id + place(output)); }
  const ReportSeries* find(const char* id, std::size_t output, std::size_t input) const {
    return find(id + place(output) + place(input));
  }

  std::size_t outputs() const { return std::min(model_.outputs.size(), kMaxOutputs); }
  std::size_t inputs() const { return std::min(model_.inputs.size(), kMaxInputs); }

  // Returns the suffix of a figure's file name: the output's name without '/', or none if the model has one output.
  std::string of_output(std::size_t output) const {
    std::string suffix = model_.outputs.size() == 1 ? "" : "-" + name(output);
    std::ranges::replace(suffix, '/', '-');
    return suffix;
  }
  const std::string& name(std::size_t output) const { return model_.outputs[output].name; }

 private:
  static std::string place(std::size_t index) { return "." + std::to_string(index); }

  const Model& model_;
  const Report& report_;
};

PlotSeries unit_circle() {
  PlotSeries circle{.colour = Colour{150, 150, 150}, .width = 1};
  for (int k = 0; k <= 180; ++k) {
    circle.x.push_back(std::cos(2 * std::numbers::pi * k / 180));
    circle.y.push_back(std::sin(2 * std::numbers::pi * k / 180));
  }
  return circle;
}

// Returns poles as crosses, their conventional marks.
PlotSeries crosses(const ReportSeries& places) {
  constexpr double kArm = 0.04;
  PlotSeries series{.label = "poles ×", .width = 1.6};
  for (std::size_t p = 0; p < places.x.size(); ++p) {
    for (double sign : {1.0, -1.0}) {
      for (double end : {-kArm, kArm}) {
        series.x.push_back(places.x[p] + end);
        series.y.push_back(places.y[p] + sign * end);
      }
      series.x.push_back(kBreak);
      series.y.push_back(kBreak);
    }
  }
  return series;
}

Plot pole_plot(const std::string& title, const ReportSeries& poles, const ReportSeries* zeros) {
  Plot plot{.title = title, .x = {.label = "real part"}, .y = {.label = "imaginary part"}, .equal_units = true};
  plot.series = {unit_circle(), crosses(poles)};
  PlotSeries rings{.label = "zeros", .shape = SeriesShape::kPoints, .marker = Marker::kRing, .marker_size = 8};
  for (std::size_t z = 0; zeros && z < zeros->x.size(); ++z) {
    if (std::hypot(zeros->x[z], zeros->y[z]) > kFar) continue;
    rings.x.push_back(zeros->x[z]);
    rings.y.push_back(zeros->y[z]);
  }
  const std::size_t far = zeros ? zeros->x.size() - rings.x.size() : 0;
  if (far > 0) plot.title += " (" + std::to_string(far) + (far == 1 ? " zero" : " zeros") + " beyond |z| = 1.5)";
  if (!rings.x.empty()) plot.series.push_back(std::move(rings));
  return plot;
}

PlotSheet pole_sheet(const Figures& figures, const ReportSeries& poles) {
  PlotSheet sheet{
      .columns = static_cast<int>(std::max<std::size_t>(1, figures.inputs())), .plot_width = 380, .plot_height = 400};
  if (figures.inputs() == 0) sheet.plots.push_back(pole_plot("Poles", poles, nullptr));
  for (std::size_t i = 0; i < figures.outputs(); ++i) {
    for (std::size_t k = 0; k < figures.inputs(); ++k) {
      const ReportSeries *zeros = figures.find("zeros", i, k), *own = figures.find("poles", i, k);
      sheet.plots.push_back(pole_plot(zeros ? zeros->label : "Poles", own ? *own : poles, zeros));
    }
  }
  double reach = 1.1;  // end of the axes of all panels, so that the panels are comparable
  for (const Plot& plot : sheet.plots) {
    for (std::size_t z = 0; plot.series.size() > 2 && z < plot.series[2].x.size(); ++z) {
      reach = std::max({reach, 1.1 * std::abs(plot.series[2].x[z]), 1.1 * std::abs(plot.series[2].y[z])});
    }
  }
  for (Plot& plot : sheet.plots) {
    plot.x.lowest = plot.y.lowest = -reach;
    plot.x.highest = plot.y.highest = reach;
  }
  return sheet;
}

// Returns a curve, with its band if the report has one.
PlotSeries curve_of(const Figures& figures, const ReportSeries& series, const std::string& band) {
  PlotSeries curve{.x = series.x, .y = series.y};
  const ReportSeries* low = figures.find(series.id + ".low");
  const ReportSeries* high = figures.find(series.id + ".high");
  if (!low || !high) return curve;
  curve.label = band;
  curve.low = low->y;
  curve.high = high->y;
  curve.interval = IntervalShape::kBand;
  return curve;
}

Plot plot_of(const Figures& figures, const ReportSeries& series, const std::string& title) {
  Plot plot{.title = title, .x = {.label = series.x_label}, .y = {.label = series.y_label}};
  plot.series.push_back(curve_of(figures, series, title.empty() ? "" : "with its 95 % band"));
  return plot;
}

PlotSheet step_sheet(const Figures& figures, std::size_t output) {
  PlotSheet sheet{.columns = static_cast<int>(std::min<std::size_t>(3, figures.inputs())), .plot_width = 520};
  for (std::size_t k = 0; k < figures.inputs(); ++k) {
    const ReportSeries* step = figures.find("step", output, k);
    if (step) sheet.plots.push_back(plot_of(figures, *step, "Step response: " + step->label));
  }
  return sheet;
}

PlotSheet frequency_sheet(const Figures& figures, std::size_t output) {
  PlotSheet sheet{.columns = static_cast<int>(figures.inputs()), .plot_width = 460, .plot_height = 260};
  for (const char* part : {"amplitude", "phase"}) {
    for (std::size_t k = 0; k < figures.inputs(); ++k) {
      const ReportSeries* found = figures.find(part, output, k);
      if (!found) continue;
      const bool amplitude = part[0] == 'a';
      Plot plot = plot_of(figures, *found, amplitude ? "Frequency response: " + found->label : "");
      plot.x.logarithmic = true;
      plot.y.logarithmic = amplitude;
      sheet.plots.push_back(std::move(plot));
    }
  }
  return sheet;
}

Plot correlation_plot(const ReportSeries& correlations, const ReportSeries& bound) {
  Plot plot{.title = correlations.label,
            .x = {.label = correlations.x_label, .whole_numbers = true},
            .y = {.label = correlations.y_label}};
  PlotSeries stems{.width = 2}, heads{.shape = SeriesShape::kPoints, .marker = Marker::kDot, .marker_size = 4};
  double reach = 2 * bound.y.front();
  for (std::size_t k = 0; k < correlations.x.size(); ++k) {
    const double lag = correlations.x[k], value = correlations.y[k];
    stems.x.insert(stems.x.end(), {lag, lag, kBreak});
    stems.y.insert(stems.y.end(), {0, value, kBreak});
    heads.x.push_back(lag);
    heads.y.push_back(value);
    reach = std::max(reach, std::abs(value));
  }
  heads.colour = stems.colour = Colour{31, 90, 166};
  plot.series = {std::move(stems), std::move(heads)};
  plot.y.lowest = -1.1 * reach;
  plot.y.highest = 1.1 * reach;
  const double first = bound.x.front(), last = bound.x.back(), size = bound.y.front();
  plot.series.push_back({.label = bound.label,
                         .x = {first, last, kBreak, first, last},
                         .y = {size, size, kBreak, -size, -size},
                         .colour = Colour{190, 40, 40},
                         .dash = Dash::kDashed});
  return plot;
}

PlotSheet residual_sheet(const Figures& figures) {
  PlotSheet sheet{.columns = static_cast<int>(1 + figures.inputs()), .plot_width = 420, .plot_height = 260};
  for (std::size_t i = 0; i < figures.outputs(); ++i) {
    std::vector<const ReportSeries*> all{figures.find("residual." + std::to_string(i) + ".white")};
    for (std::size_t k = 0; k < figures.inputs(); ++k) all.push_back(figures.find("residual", i, k));
    for (const ReportSeries* found : all) {
      const ReportSeries* bound = found ? figures.find(found->id + ".bound") : nullptr;
      if (bound) sheet.plots.push_back(correlation_plot(*found, *bound));
    }
  }
  return sheet;
}

// Returns rows [first, first + rows) of a curve and its band.
PlotSeries rows_of(PlotSeries series, std::size_t first, std::size_t rows) {
  for (auto* values : {&series.x, &series.y, &series.low, &series.high}) {
    const std::size_t begin = std::min(first, values->size()), end = std::min(begin + rows, values->size());
    *values = std::vector<double>(values->begin() + static_cast<std::ptrdiff_t>(begin),
                                  values->begin() + static_cast<std::ptrdiff_t>(end));
  }
  return series;
}

// Plots measured and simulated outputs, or measured and predicted ones, by `id`.
PlotSheet tracking_sheet(const Figures& figures, const char* id) {
  PlotSheet sheet{.columns = 1, .plot_width = 900, .plot_height = 260};
  const bool simulated = std::string_view(id) == "simulated";
  for (std::size_t i = 0; i < figures.outputs(); ++i) {
    const ReportSeries* found = figures.find(id, i);
    const ReportSeries* measured = figures.find("measured", i);
    if (!found || !measured) continue;
    const auto is_there = [](double y) { return std::isfinite(y); };
    const auto first =
        static_cast<std::size_t>(std::find_if(found->y.begin(), found->y.end(), is_there) - found->y.begin());
    const std::size_t from = simulated ? 0 : first, rows = simulated ? kMaxRows : kPredictedRows;
    Plot plot{.title = figures.name(i) + (simulated ? "" : ", " + found->label),
              .x = {.label = found->x_label},
              .y = {.label = found->y_label}};
    if (simulated && rows < found->y.size()) plot.title += ", the first " + std::to_string(rows) + " rows";
    PlotSeries own = rows_of(curve_of(figures, *found, "predicted, with the model's 95 % interval"), from, rows);
    PlotSeries truth = rows_of({.label = measured->label, .x = measured->x, .y = measured->y}, from, rows);
    if (simulated) {
      own.label = found->label;
      own.dash = Dash::kDashed;
      plot.series = {std::move(truth), std::move(own)};
    } else {
      truth.shape = SeriesShape::kPoints;
      truth.marker = Marker::kDot;
      truth.marker_size = 4;
      plot.series = {std::move(own), std::move(truth)};
    }
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

// Plots the prediction error against the number of steps, with the error that the model itself expects.
PlotSheet error_sheet(const Figures& figures) {
  PlotSheet sheet{.columns = static_cast<int>(std::min<std::size_t>(3, figures.outputs()))};
  for (std::size_t i = 0; i < figures.outputs(); ++i) {
    const ReportSeries* error = figures.find("error", i);
    if (!error) continue;
    Plot plot{.title = "Prediction error of " + figures.name(i),
              .x = {.label = error->x_label, .whole_numbers = true},
              .y = {.label = error->y_label, .lowest = 0.0}};
    plot.series.push_back({.label = error->label, .x = error->x, .y = error->y, .marker = Marker::kDot});
    for (const auto& [more, dash] : {std::pair{".model", Dash::kDashed}, {".inf", Dash::kDotted}}) {
      const ReportSeries* found = figures.find(error->id + more);
      if (found) plot.series.push_back({.label = found->label, .x = found->x, .y = found->y, .dash = dash});
    }
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

}  // namespace

Result<void> write_arx_figures(const fs::path& folder, const Model& model, const Report& report, Terminal& terminal) {
  const Figures figures(model, report);
  std::vector<std::pair<std::string, PlotSheet>> sheets{{"simulation", tracking_sheet(figures, "simulated")},
                                                        {"prediction", tracking_sheet(figures, "predicted")},
                                                        {"prediction-error", error_sheet(figures)},
                                                        {"residuals", residual_sheet(figures)}};
  if (const ReportSeries* poles = figures.find("poles")) sheets.push_back({"poles-zeros", pole_sheet(figures, *poles)});
  for (std::size_t i = 0; i < figures.outputs(); ++i) {
    sheets.push_back({"step" + figures.of_output(i), step_sheet(figures, i)});
    sheets.push_back({"frequency" + figures.of_output(i), frequency_sheet(figures, i)});
  }
  for (const auto& [name, sheet] : sheets) {
    if (sheet.plots.empty()) continue;
    if (auto ok = write_figure(folder, name, sheet); !ok) return ok;
  }
  const auto warn = [&](std::size_t drawn, std::size_t all, const std::string& what) {
    if (drawn == all) return;
    terminal.warn("figures are drawn of the first " + std::to_string(drawn) + " of " + std::to_string(all) + " " +
                  what + "; learn the others by --" + what + " to see theirs");
  };
  warn(figures.outputs(), model.outputs.size(), "outputs");
  warn(figures.inputs(), model.inputs.size(), "inputs");
  return {};
}

}  // namespace wisp::cli
