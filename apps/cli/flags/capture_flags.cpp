#include "flags/capture_flags.hpp"

#include <charconv>

#include "wisp/capture/media/clip_wind.hpp"
#include "wisp/model/bspline.hpp"
#include "wisp/record/loudness.hpp"

namespace wisp::cli {
namespace {

Result<Region> parse_region(std::string_view text) {
  int parts[4] = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int k = 0; k < 4; ++k) {
    const auto [next, code] = std::from_chars(at, end, parts[k]);
    const bool separated = k == 3 ? next == end : next != end && *next == ',';
    if (code != std::errc() || !separated || parts[k] < 0) {
      return Error{"--region: found \"" + std::string(text) +
                   "\", expected X,Y,WIDTH,HEIGHT in pixels, such as 100,50,320,240"};
    }
    at = next + 1;
  }
  if (parts[2] == 0 || parts[3] == 0) return Error{"--region " + std::string(text) + " has no area"};
  return Region{parts[0], parts[1], parts[2], parts[3]};
}

Result<ClipCaptureOptions> options_from(const Arguments& arguments) {
  ClipCaptureOptions options;
  if (arguments.has("points")) options.outline.points = arguments.integer("points");
  if (options.outline.points < 4 || options.outline.points > 64) {
    return Error{"--points is " + std::to_string(options.outline.points) + ", expected 4 to 64"};
  }
  options.outline.channel = channel_from_name(arguments.text("channel"));
  options.outline.dark = arguments.on("dark");
  if (arguments.has("flame")) options.outline.flame = arguments.integer("flame");
  if (options.outline.flame < 0) {
    return Error{"--flame is " + std::to_string(options.outline.flame) + ", expected 0 or more"};
  }
  if (arguments.has("region")) {
    const auto region = parse_region(arguments.text("region"));
    if (!region) return region.error();
    options.outline.region = *region;
  }
  if (arguments.has("frames")) {
    const SampleRange frames = arguments.samples("frames");
    options.video.frames = FrameRange{static_cast<std::int64_t>(frames.first), static_cast<std::int64_t>(frames.last)};
  }
  if (arguments.has("rate")) options.video.rate_hz = arguments.number("rate");
  return options;
}

WindMeasure wind_measure(const Arguments& arguments) {
  const std::string& word = arguments.text("wind-measure");
  return word == "rms" ? WindMeasure::kRms : word == "heard" ? WindMeasure::kHeard : WindMeasure::kSpeed;
}

void add_wind(const ClipWind& wind, WindMeasure measure, CapturedClip& clip) {
  clip.wind_heard = !wind.frames.empty();
  clip.wind_background = wind.background;
  clip.wind_note = wind.note;
  if (wind.uncovered > 0 && clip.wind_heard) {
    clip.report.warnings.push_back("the sound ends " + std::to_string(wind.uncovered) +
                                   " frames before the picture; the wind there is missing");
  }
  if (wind.clipped_share > 0.01)
    clip.report.warnings.push_back("the sound is clipped; record it more quietly for a truer wind");
  if (!clip.wind_heard) return;
  Channel channel{.name = wind_channel_name(measure), .unit = "1", .role = Role::kInput, .samples = {}};
  if (measure == WindMeasure::kRms) channel.unit = "full scale";
  for (const WindFrame& frame : wind.frames) channel.samples.push_back(wind_value(frame, measure));
  if (measure != WindMeasure::kRms && wind.one_rms > 0) set_one_rms(clip.recording, channel.name, wind.one_rms);
  clip.recording.channels.insert(clip.recording.channels.begin(), std::move(channel));
}

}  // namespace

std::vector<Flag> capture_flags() {
  return {
      {"points", Kind::kInteger, "N", "8", "control points of the outline, 4 to 64"},
      {"channel",
       Kind::kChoice,
       "C",
       "auto",
       "brightness to look at: auto takes the one in which the flame stands out best",
       {"auto", "luma", "red", "green", "blue"}},
      {"flame", Kind::kInteger, "K", "1", "which of several flames, 1 the largest; 0: what moves, flame or not"},
      {"dark", Kind::kSwitch, "", "", "the thing is dark on a light ground"},
      {"region", Kind::kText, "X,Y,W,H", "", "look only here, in pixels from the top left"},
      {"frames", Kind::kSamples, "A:B", "", "only these frames, 1-based and inclusive"},
      {"rate", Kind::kNumber, "HZ", "", "frames a second of a folder of images; overrides a video's own"},
      {"wind-measure",
       Kind::kChoice,
       "M",
       "speed",
       "what is made of the sound: speed (of what sounds like wind), heard (speed, other sounds too), rms (plain)",
       {"speed", "heard", "rms"}},
  };
}

Result<CapturedClip> capture_clip(const std::filesystem::path& path, const Arguments& arguments, Terminal& terminal,
                                  SharedCurve curve) {
  auto options = options_from(arguments);
  if (!options) return options.error();
  if (!curve.knots.empty()) {
    options->outline.points = static_cast<int>(curve.knots.size()) - kSplineDegree - 1;
    options->outline.knots = std::move(curve.knots);
    options->outline.underside = curve.underside;
  }
  auto captured = wisp::capture_outline(path, *options, [&](std::int64_t done, std::int64_t expected) {
    terminal.progress("capturing", expected > 0 ? static_cast<double>(done) / static_cast<double>(expected) : -1);
    return true;
  });
  if (!captured) return captured.error();
  if (options->video.frames &&
      captured->recording.rows() < arguments.samples("frames").last - arguments.samples("frames").first + 1) {
    return Error{path.string() + ": --frames " + arguments.text("frames") + " reaches beyond its end, frame " +
                 std::to_string(arguments.samples("frames").first - 1 + captured->recording.rows())};
  }
  CapturedClip clip{std::move(captured->recording), std::move(captured->report), false, 0, ""};
  if (std::filesystem::is_directory(path)) {
    clip.wind_note = "not heard: images have no sound";
    return clip;
  }
  // The sound is heard from the clip's start, whichever frames were asked for, so that its background is known.
  const auto skipped = options->video.frames ? static_cast<std::size_t>(options->video.frames->first - 1) : 0;
  auto wind = hear_wind(path, clip.report.rate_hz, skipped + clip.recording.rows());
  if (!wind) return wind.error();
  if (!wind->frames.empty())
    wind->frames.erase(wind->frames.begin(), wind->frames.begin() + static_cast<std::ptrdiff_t>(skipped));
  add_wind(*wind, wind_measure(arguments), clip);
  return clip;
}

}  // namespace wisp::cli
