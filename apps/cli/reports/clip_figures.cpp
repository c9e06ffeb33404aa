#include "reports/clip_figures.hpp"

#include <algorithm>
#include <span>

#include "wisp/capture/capture.hpp"
#include "wisp/capture/media/sound.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

double figure(const Report& report, std::string_view id) {
  return std::visit(
      [](const auto& value) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) return static_cast<double>(value);
        return 0.0;
      },
      static_cast<const ReportValue::Base&>(report.find(id)->value));
}

PlotSheet histogram_sheet(const Report& captured) {
  PlotSheet sheet{.plot_width = 560};
  for (const ReportSection& section : captured.sections) {
    for (const ReportSeries& series : section.series) {
      Plot plot{.title = series.label,
                .x = {.label = series.x_label, .lowest = 0.0, .highest = 255.0},
                .y = {.label = series.y_label, .logarithmic = true}};
      plot.series.push_back({.x = series.x, .y = series.y, .shape = SeriesShape::kBars});
      plot.marks.push_back({.at = figure(captured, "threshold"), .label = "threshold"});
      sheet.plots.push_back(std::move(plot));
    }
  }
  return sheet;
}

// Envelope of a sound: the lowest and highest sample of every few milliseconds.
class Envelope {
 public:
  void feed(const SoundInfo& info, std::span<const float> samples) {
    constexpr double kBinSeconds = 0.004;
    const auto bin =
        static_cast<std::size_t>(std::max(1.0, kBinSeconds * info.rate_hz)) * static_cast<std::size_t>(info.channels);
    for (float sample : samples) {
      low_ = std::min(low_, sample);
      high_ = std::max(high_, sample);
      if (++count_ % bin == 0) close(static_cast<double>(count_) / info.channels / info.rate_hz);
    }
  }

  PlotSeries series;

 private:
  void close(double seconds) {
    for (float edge : {low_, high_}) {
      series.x.push_back(seconds);
      series.y.push_back(edge);
    }
    low_ = 1;
    high_ = -1;
  }

  float low_ = 1;
  float high_ = -1;
  std::size_t count_ = 0;
};

Result<void> write_sound_figure(const fs::path& folder, const fs::path& clip, std::size_t skipped,
                                const Report& captured) {
  Envelope envelope;
  const auto heard = stream_sound(clip, [&](const SoundInfo& info, std::span<const float> samples) {
    envelope.feed(info, samples);
    return true;
  });
  if (!heard) return heard.error();
  if (!*heard || (*heard)->silent()) return {};
  const double rate_hz = figure(captured, "rate_hz");
  const auto wind = hear_wind(clip, rate_hz, skipped + static_cast<std::size_t>(figure(captured, "frames")));
  if (!wind) return wind.error();
  Plot raw{.title = "Sound", .x = {.label = "time, s"}, .y = {.label = "amplitude"}};
  raw.series.push_back(std::move(envelope.series));
  Plot level{.title = "Root mean square, frame by frame",
             .x = {.label = "time, s"},
             .y = {.label = "amplitude", .lowest = 0.0}};
  PlotSeries rms;
  for (const WindFrame& frame : std::span(wind->frames).subspan(std::min(skipped, wind->frames.size()))) {
    rms.x.push_back(static_cast<double>(frame.index) / rate_hz);
    rms.y.push_back(frame.rms);
  }
  level.series.push_back(std::move(rms));
  level.marks.push_back({.at = wind->background, .vertical = false, .label = "background"});
  return write_figure(folder, "sound", {.plots = {std::move(raw), std::move(level)}, .plot_width = 560});
}

}  // namespace

Result<void> write_figure(const fs::path& folder, const std::string& name, const PlotSheet& sheet) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  for (const char* extension : {".png", ".svg"}) {
    if (auto ok = write_plots(folder / (name + extension), sheet); !ok) return ok;
  }
  return {};
}

Result<void> write_clip_figures(const fs::path& folder, const fs::path& clip, std::size_t skipped,
                                const Report& captured) {
  if (auto ok = write_figure(folder, "brightness", histogram_sheet(captured)); !ok) return ok;
  if (fs::is_directory(clip)) return {};
  return write_sound_figure(folder, clip, skipped, captured);
}

}  // namespace wisp::cli
