#include "reports/clip_figures.hpp"

#include <algorithm>

#include "wisp/capture/media/clip_wind.hpp"
#include "wisp/capture/media/sound.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

PlotSheet histogram_sheet(const CaptureReport& report) {
  Plot plot{.title = "Brightness of the " + std::string(channel_name(report.channel)) + " channel",
            .x = {.label = "brightness", .lowest = 0.0, .highest = 255.0},
            .y = {.label = "pixels", .logarithmic = true}};
  PlotSeries bars{.shape = SeriesShape::kBars};
  for (std::size_t level = 0; level < report.histogram.size(); ++level) {
    bars.x.push_back(static_cast<double>(level));
    bars.y.push_back(static_cast<double>(report.histogram[level]));
  }
  plot.series.push_back(std::move(bars));
  plot.marks.push_back({.at = report.threshold, .label = "threshold"});
  return {.plots = {std::move(plot)}, .plot_width = 560};
}

// Sound as a picture sees it: the lowest and highest sample of every few milliseconds.
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

Result<void> write_sound_figure(const fs::path& folder, const fs::path& clip, const CaptureReport& report) {
  Envelope envelope;
  const auto heard = stream_sound(clip, [&](const SoundInfo& info, std::span<const float> samples) {
    envelope.feed(info, samples);
    return true;
  });
  if (!heard) return heard.error();
  if (!*heard || (*heard)->silent()) return {};
  const auto wind = hear_wind(clip, report.rate_hz, report.frames);
  if (!wind) return wind.error();
  Plot raw{.title = "Sound", .x = {.label = "seconds"}, .y = {.label = "amplitude"}};
  raw.series.push_back(std::move(envelope.series));
  Plot level{.title = "Root mean square, frame by frame",
             .x = {.label = "seconds"},
             .y = {.label = "amplitude", .lowest = 0.0}};
  PlotSeries rms;
  for (const WindFrame& frame : wind->frames) {
    rms.x.push_back(static_cast<double>(frame.index) / report.rate_hz);
    rms.y.push_back(frame.rms);
  }
  level.series.push_back(std::move(rms));
  level.marks.push_back({.at = wind->background, .vertical = false, .label = "background"});
  return write_figure(folder, "sound", {.plots = {std::move(raw), std::move(level)}, .plot_width = 560});
}

}  // namespace

Result<void> write_figure(const fs::path& folder, const std::string& name, const PlotSheet& sheet) {
  for (const char* extension : {".png", ".svg"}) {
    if (auto ok = write_plots(folder / (name + extension), sheet); !ok) return ok;
  }
  return {};
}

Result<void> write_clip_figures(const fs::path& folder, const fs::path& clip, const CaptureReport& report) {
  if (auto ok = write_figure(folder, "brightness", histogram_sheet(report)); !ok) return ok;
  if (fs::is_directory(clip)) return {};
  return write_sound_figure(folder, clip, report);
}

}  // namespace wisp::cli
