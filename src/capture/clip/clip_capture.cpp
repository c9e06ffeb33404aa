#include "wisp/capture/clip/clip_capture.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/verdict.hpp"
#include "capture/clip/clip_ear.hpp"
#include "model/bspline.hpp"
#include "record/loudness.hpp"
#include "record/verdict.hpp"

namespace wisp {
namespace {

OutlineCaptureOptions outline_options(const ClipSource& source, const ClipCapture& options) {
  OutlineCaptureOptions out;
  out.points = options.points;
  out.channel = options.channel;
  out.dark = options.dark;
  out.flame = options.flame;
  out.region = options.region;
  if (options.curve) {
    out.points = static_cast<int>(options.curve->knots.size()) - kSplineDegree - 1;
    out.knots = options.curve->knots;
    out.underside = options.curve->underside;
  }
  out.rate_hz = source.rate_hz;
  if (options.frames) out.first_frame = static_cast<std::size_t>(options.frames->first);
  out.source = source.name;
  return out;
}

constexpr double kClippedShare = 0.01;  // share of samples at full scale above which a warning is given

// The flame counts as blown out and relit if its outline is missing for more than kMinOut seconds, beginning at most
// kLookedBack seconds after wind of at least kBlowing, and returns. Less wind extinguishes no flame.
constexpr double kBlowing = 0.5, kLookedBack = 0.6, kMinOut = 0.2;

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
  std::size_t rows = 0, times = 0, gone = 0, seen = outline.size();
  for (std::size_t row = 0; row < outline.size(); ++row) {
    if (std::isnan(outline[row])) {
      gone += is_flagged(recording, kLostRows, row) ? 0 : 1;
      continue;
    }
    if (seen < row && gone > rows_of(kMinOut) && blows(seen + 1)) {
      rows += gone;
      ++times;
    }
    seen = row, gone = 0;
  }
  excuse_absence(picture, rows, times);
}

void warn_of_sound(const ClipSource& source, const ClipWind& wind, Report& report) {
  if (wind.frames.empty()) {
    if (!source.pictures) report.warnings.push_back("wind " + wind.note + "; without it only flicker can be learned");
  } else if (wind.uncovered > 0) {
    report.warnings.push_back("the sound ends " + std::to_string(wind.uncovered) +
                              " frames before the picture; the wind there is missing");
  }
  if (wind.holes > 0) {
    report.warnings.push_back("the sound does not reach " + std::to_string(wind.holes) +
                              " frames at its beginning or in holes; the wind there is missing");
  }
  if (wind.clipped_share > kClippedShare) {
    report.warnings.push_back("the sound is clipped; record it more quietly for a truer wind");
  }
}

// Returns why a clip with usable outlines is unusable because of its frames' times or its sound; none if it is usable.
std::optional<std::string> missed_times(const ClipWind& wind, const ClipTimes& times) {
  float worst = 0;
  for (const float offset : times.offsets) worst = std::max(worst, std::abs(offset));
  const double frames = static_cast<double>(std::max<std::size_t>(1, wind.frames.size()));
  const Criterion criteria[] = {
      {worst, Bound::kAtMost, 3,
       "its frames come up to {figure} places from where they should be, at most {limit} can be interpolated; film at "
       "a fixed rate"},
      {wind.frames.empty() ? 0.0 : times.shortened, Bound::kAtMost, 0,
       "its picture has holes of more than 2 s ({figure}), and the wind after them is not where it was; cut the film "
       "there with --frames",
       0},
      {100 * static_cast<double>(wind.uncovered + wind.holes) / frames, Bound::kAtMost, 50,
       "its sound is missing for {figure} % of the frames, at most {limit} % may be; film with sound throughout", 0},
      {100 * wind.clipped_share, Bound::kAtMost, 20,
       "{figure} % of its sound is clipped, at most {limit} % may be; record it more quietly", 0}};
  return first_missed(criteria);
}

// Interpolates outlines at grid times between neighbouring frames (not filled rows), unless all lie on the grid.
void put_in_place(std::span<const float> offsets, Recording& recording) {
  if (std::all_of(offsets.begin(), offsets.end(), [](float rows) { return std::abs(rows) < 0.1F; })) return;
  const std::vector<double> outline = recording.channels[0].samples;
  const std::vector<std::uint8_t>& filled = recording.flags[0].rows;
  const auto time = [&](std::size_t row) {
    return static_cast<double>(row) + (row < offsets.size() ? static_cast<double>(offsets[row]) : 0.0);
  };
  for (std::size_t begin = 0, end = 0; begin < outline.size(); begin = end + 1) {
    std::vector<std::size_t> own;
    for (end = begin; end < outline.size() && !std::isnan(outline[end]); ++end) {
      if (filled[end] == 0 && (own.empty() || time(end) > time(own.back()))) own.push_back(end);
    }
    if (own.size() < 2) continue;
    for (Channel& channel : recording.channels) {
      const std::vector<double> before = channel.samples;
      std::size_t k = 1;
      for (std::size_t row = begin; row < end; ++row) {
        while (k + 1 < own.size() && time(own[k]) < static_cast<double>(row)) ++k;
        const double from = time(own[k - 1]), to = time(own[k]);
        const double share = std::clamp((static_cast<double>(row) - from) / (to - from), 0.0, 1.0);
        channel.samples[row] = before[own[k - 1]] + share * (before[own[k]] - before[own[k - 1]]);
      }
    }
  }
}

ReportSection frames_section(const CaptureReport& picture) {
  ReportSection section{"Frames"};
  section.entries = {{"frames", picture.frames, "frames", ""},
                     {"tracked", picture.tracked, "tracked", "", {}, "frames with an outline of their own"},
                     {"duplicates", picture.duplicates, "duplicates", "", {}, "frames that repeat the one before"},
                     {"filled", picture.filled, "filled", "", {}, "interpolated between their neighbours"},
                     {"flames", picture.flames, "flames seen", ""},
                     {"out_at", picture.out_at ? ReportValue(*picture.out_at + picture.first_frame) : ReportValue(),
                      "out from frame", ""},
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

ReportSection facts_section(const CaptureReport& picture) {
  ReportSection section{"Facts"};
  section.entries = {{"likely.flame", picture.likely_flame, "", ""}, {"likely.right", picture.likely_right, "", ""}};
  ReportTable facts{"facts", "", {{"fact", ""}, {"value", ""}, {"against_flame", ""}, {"against_right", ""}}, {}};
  for (const WeighedFact& fact : weighed_facts(picture)) {
    facts.rows.push_back({fact.name, fact.value, fact.against_flame, fact.against_right});
  }
  section.tables.push_back(std::move(facts));
  return section;
}

ReportSection wind_section(const ClipWind& wind) {
  return {"Wind",
          {{"wind.heard", !wind.frames.empty(), "", ""},
           {"wind.background", wind.background, "", ""},
           {"wind.reason", wind.note, "wind", ""}}};
}

}  // namespace

void join_wind(const ClipWind& wind, WindMeasure measure, Recording& recording) {
  if (wind.frames.empty()) return;
  const bool rms = measure == WindMeasure::kRms;
  Channel channel{wind_channel_name(measure), rms ? "full scale" : "1", Role::kInput, {}};
  for (const WindFrame& frame : wind.frames) channel.samples.push_back(wind_value(frame, measure));
  if (!rms && wind.one_rms > 0) set_one_rms(recording, channel.name, wind.one_rms);
  recording.channels.insert(recording.channels.begin(), std::move(channel));
}

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

LiveCapture::LiveCapture(ClipSource source, const ClipCapture& options)
    : source_(std::move(source)),
      measure_(options.wind),
      skipped_(options.frames ? static_cast<std::size_t>(options.frames->first - 1) : 0),
      picture_(outline_options(source_, options)) {}

LiveCapture::LiveCapture(LiveCapture&&) noexcept = default;
LiveCapture& LiveCapture::operator=(LiveCapture&&) noexcept = default;
LiveCapture::~LiveCapture() = default;

Result<LiveCapture> LiveCapture::create(const ClipSource& source, const ClipCapture& options) {
  if (options.points < 4 || options.points > 64) {
    return Error{source.name + ": points is " + std::to_string(options.points) + ", expected 4 to 64"};
  }
  if (!(source.rate_hz > 0)) return Error{source.name + ": states no frame rate; give it as --rate"};
  return LiveCapture(source, options);
}

Result<void> LiveCapture::hear(const SoundFormat& format, double begin, std::span<const float> samples) {
  if (!ear_) {
    auto ear = ClipEar::create(format, source_.rate_hz);
    if (!ear) {
      return Error{source_.name + ": its sound cannot be used: " + ear.error().message +
                   "; give the film without it, as by ffmpeg -i IN -c copy -an OUT"};
    }
    ear_ = std::make_unique<ClipEar>(std::move(*ear));
  }
  ear_->feed(begin, samples);
  return {};
}

// Returns the wind of the captured frames. Sound is analysed from the clip's start, whichever frames are captured, so
// that the background level is known.
Result<ClipWind> LiveCapture::wind_of(std::size_t rows) const {
  if (!ear_) {
    ClipWind none;
    none.note = source_.pictures ? "not heard: images have no sound" : "not heard: the clip has no sound track";
    return none;
  }
  auto wind = ear_->finish(skipped_ + rows, skipped_);
  if (!wind) return Error{source_.name + ": its sound cannot be used: " + wind.error().message};
  return wind;
}

Result<Captured> LiveCapture::finish(const ClipTimes& times) {
  auto picture = picture_.finish();
  if (!picture) return picture.error();
  put_in_place(times.offsets, picture->recording);
  const auto wind = wind_of(picture->report.frames);
  if (!wind) return wind.error();
  Captured out{std::move(picture->recording), {}};
  excuse_blown_out(*wind, out.recording, picture->report);
  const auto missed = picture->report.usable ? missed_times(*wind, times) : std::nullopt;
  out.report.verdict = ReportVerdict{picture->report.usable && !missed, missed ? *missed : picture->report.reason};
  set_verdict(out.recording, out.report.verdict->usable, out.report.verdict->reason);
  join_wind(*wind, measure_, out.recording);
  out.report.warnings = std::move(picture->report.warnings);
  warn_of_sound(source_, *wind, out.report);
  out.report.sections = {frames_section(picture->report), outline_section(picture->report),
                         facts_section(picture->report), wind_section(*wind)};
  return out;
}

}  // namespace wisp
