#include "wisp/capture/capture.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "capture/capture_clip.hpp"
#include "model/bspline.hpp"
#include "record/loudness.hpp"
#include "record/verdict.hpp"

namespace wisp {
namespace {

constexpr double kClippedShare = 0.01;  // of samples at full scale: beyond it the wind's peaks are cut off

Result<ClipCaptureOptions> clip_options(const std::filesystem::path& path, const ClipCapture& options) {
  if (options.points < 4 || options.points > 64) {
    return Error{path.string() + ": points is " + std::to_string(options.points) + ", expected 4 to 64"};
  }
  ClipCaptureOptions out;
  out.outline.points = options.points;
  out.outline.channel = options.channel;
  out.outline.dark = options.dark;
  out.outline.flame = options.flame;
  out.outline.region = options.region;
  if (options.curve) {
    out.outline.points = static_cast<int>(options.curve->knots.size()) - kSplineDegree - 1;
    out.outline.knots = options.curve->knots;
    out.outline.underside = options.curve->underside;
  }
  out.video.rate_hz = options.rate_hz;
  out.video.frames = options.frames;
  return out;
}

Result<void> check_frames(const std::filesystem::path& path, const std::optional<FrameRange>& frames,
                          std::size_t rows) {
  const auto last = frames ? frames->first - 1 + static_cast<std::int64_t>(rows) : 0;
  if (!frames || last >= frames->last) return {};
  return Error{path.string() + ": frames " + std::to_string(frames->first) + ":" + std::to_string(frames->last) +
               " reach beyond its end, frame " + std::to_string(last)};
}

// The wind of the captured frames. The sound is heard from the clip's start, whichever frames are captured, so that its
// background is known.
Result<ClipWind> wind_of(const std::filesystem::path& path, const ClipCapture& options, const CaptureReport& picture) {
  if (std::filesystem::is_directory(path)) {
    ClipWind none;
    none.note = "not heard: images have no sound";
    return none;
  }
  const auto skipped = options.frames ? static_cast<std::size_t>(options.frames->first - 1) : 0;
  auto wind = hear_wind(path, picture.rate_hz, skipped + picture.frames);
  if (wind && !wind->frames.empty()) {
    wind->frames.erase(wind->frames.begin(), wind->frames.begin() + static_cast<std::ptrdiff_t>(skipped));
  }
  return wind;
}

void join_wind(const ClipWind& wind, WindMeasure measure, Recording& recording) {
  if (wind.frames.empty()) return;
  const bool rms = measure == WindMeasure::kRms;
  Channel channel{wind_channel_name(measure), rms ? "full scale" : "1", Role::kInput, {}};
  for (const WindFrame& frame : wind.frames) channel.samples.push_back(wind_value(frame, measure));
  if (!rms && wind.one_rms > 0) set_one_rms(recording, channel.name, wind.one_rms);
  recording.channels.insert(recording.channels.begin(), std::move(channel));
}

// A stretch without an outline that begins in or just after wind, and ends with the flame back, is a flame that was
// blown out and lit again. Wind of half the strong one puts a flame out at the earliest.
constexpr double kBlowing = 0.5, kLookedBack = 0.6, kMinOut = 0.2;  // of wind 1; seconds; seconds

void excuse_blown_out(const ClipWind& wind, const Recording& recording, CaptureReport& picture) {
  if (wind.frames.empty()) return;
  const std::vector<double>& outline = recording.channels[*find_channel(recording, "p0.x")].samples;
  const auto rows_of = [&](double seconds) { return static_cast<std::size_t>(seconds * picture.rate_hz); };
  const auto blows = [&](std::size_t before) {
    for (std::size_t row = before - std::min(before, rows_of(kLookedBack)); row < before; ++row) {
      if (row < wind.frames.size() && wind_value(wind.frames[row], WindMeasure::kSpeed) >= kBlowing) return true;
    }
    return false;
  };
  std::size_t rows = 0, times = 0, seen = outline.size();
  for (std::size_t row = 0; row < outline.size(); ++row) {
    if (std::isnan(outline[row])) continue;
    const bool absent = seen < row && row - seen - 1 > rows_of(kMinOut);
    if (absent && blows(seen + 1)) {
      rows += row - seen - 1;
      ++times;
    }
    seen = row;
  }
  excuse_absence(picture, rows, times);
}

void warn_of_sound(const std::filesystem::path& path, const ClipWind& wind, Report& report) {
  if (wind.frames.empty()) {
    if (!std::filesystem::is_directory(path)) {
      report.warnings.push_back("wind " + wind.note + "; without it only flicker can be learned");
    }
  } else if (wind.uncovered > 0) {
    report.warnings.push_back("the sound ends " + std::to_string(wind.uncovered) +
                              " frames before the picture; the wind there is missing");
  }
  if (wind.clipped_share > kClippedShare) {
    report.warnings.push_back("the sound is clipped; record it more quietly for a truer wind");
  }
}

ReportSection frames_section(const CaptureReport& picture) {
  ReportSection section{"Frames"};
  section.entries = {
      {"frames", picture.frames, "frames", ""},
      {"tracked", picture.tracked, "tracked", "", {}, "frames with an outline of their own"},
      {"duplicates", picture.duplicates, "duplicates", "", {}, "frames that repeat the one before"},
      {"filled", picture.filled, "filled", "", {}, "interpolated between their neighbours"},
      {"flames", picture.flames, "flames seen", ""},
      {"out_at", picture.out_at ? ReportValue(*picture.out_at + 1) : ReportValue(), "out from frame", ""},
      {"", picture.dropped.size(), "dropped", "", {}, "frames without an outline"}};
  ReportTable dropped{"dropped", "", {{"frame", "frame"}, {"reason", "reason"}}, {}};
  for (const DroppedFrame& frame : picture.dropped) dropped.rows.push_back({frame.frame, frame.reason});
  section.tables.push_back(std::move(dropped));
  section.entries.push_back({"rate_hz", picture.rate_hz, "rate", "frames a second"});
  return section;
}

ReportSection outline_section(const CaptureReport& picture) {
  ReportSection section{"Outline"};
  section.entries = {
      {"points", picture.points, "control points", ""},
      {"threshold", picture.threshold, "threshold", "", {}, "brightness at the edge, 0 black to 255 white"},
      {"channel", std::string(channel_name(picture.channel)), "colour channel", ""},
      {"separation", picture.separation, "separation", "", {}, "of thing and ground, 0 to 1"},
      {"residual_px", picture.residual, "distance of edge from curve", "px", {}, "root mean square"},
      {"knots_placed", picture.knots_placed, "", ""}};
  ReportSeries brightness{"brightness",
                          "Brightness of the " + std::string(channel_name(picture.channel)) + " channel",
                          "brightness",
                          "pixels",
                          std::vector<double>(picture.histogram.size()),
                          {picture.histogram.begin(), picture.histogram.end()}};
  std::iota(brightness.x.begin(), brightness.x.end(), 0.0);
  section.series.push_back(std::move(brightness));
  return section;
}

ReportSection wind_section(const ClipWind& wind) {
  return {"Wind",
          {{"wind.heard", !wind.frames.empty(), "", ""},
           {"wind.background", wind.background, "", ""},
           {"wind.reason", wind.note, "wind", ""}}};
}

}  // namespace

std::optional<SharedCurve> curve_of(const Recording& recording) {
  SharedCurve curve;
  int points = 0;
  while (find_channel(recording, "p" + std::to_string(points) + ".x")) ++points;
  if (points < 4) return std::nullopt;
  const auto knots = numbers_attribute(recording, "knots");
  if (!knots) return std::nullopt;
  curve.knots = *knots ? **knots : uniform_knots(points);
  if (curve.knots.size() != static_cast<std::size_t>(points + kSplineDegree + 1) || !valid_knots(curve.knots)) {
    return std::nullopt;
  }
  if (const auto underside = find_attribute(recording, "underside")) curve.underside = *underside == "1";
  return curve;
}

Result<SharedCurve> curve_of(const Model& model) {
  const auto* outline = std::get_if<OutlineView>(&model.view);
  if (outline == nullptr)
    return Error{model.name + ": is not a model of an outline, so no clip can be captured for it"};
  return SharedCurve{outline->knots, model.training.underside};
}

Result<Captured> capture(const std::filesystem::path& path, const ClipCapture& options, const Progress& progress) {
  const auto clip = clip_options(path, options);
  if (!clip) return clip.error();
  auto picture = capture_outline(path, *clip, progress);
  if (!picture) return picture.error();
  if (auto ok = check_frames(path, options.frames, picture->recording.rows()); !ok) return ok.error();
  const auto wind = wind_of(path, options, picture->report);
  if (!wind) return wind.error();
  Captured out{std::move(picture->recording), {}};
  excuse_blown_out(*wind, out.recording, picture->report);
  out.report.verdict = ReportVerdict{picture->report.usable, picture->report.reason};
  set_verdict(out.recording, picture->report.usable, picture->report.reason);
  join_wind(*wind, options.wind, out.recording);
  out.report.warnings = std::move(picture->report.warnings);
  warn_of_sound(path, *wind, out.report);
  out.report.sections = {frames_section(picture->report), outline_section(picture->report), wind_section(*wind)};
  return out;
}

Result<std::vector<Captured>> capture_all(std::span<const std::filesystem::path> paths, ClipCapture options,
                                          const Progress& progress) {
  std::vector<Captured> out;
  for (const std::filesystem::path& path : paths) {
    auto clip = capture(path, options, progress);
    if (!clip) return clip.error();
    if (!options.curve) options.curve = curve_of(clip->recording);
    out.push_back(*std::move(clip));
  }
  return out;
}

}  // namespace wisp
