#include "flags/capture_flags.hpp"

#include <algorithm>
#include <charconv>

#include "flags/recordings.hpp"

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

WindMeasure wind_measure(const Arguments& arguments) {
  const std::string& word = arguments.text("wind-measure");
  return word == "rms" ? WindMeasure::kRms : word == "heard" ? WindMeasure::kHeard : WindMeasure::kSpeed;
}

}  // namespace

std::vector<Flag> capture_flags(const std::string& flame) {
  return {
      ranged({"points", Kind::kInteger, "N", "8", "control points of the outline"}, 4, 64),
      {"channel",
       Kind::kChoice,
       "C",
       "auto",
       "brightness to look at: auto takes the one in which the flame stands out best",
       {"auto", "luma", "red", "green", "blue"}},
      {"flame", Kind::kInteger, "K", flame, "which of several flames, 1 the largest; 0: what moves, flame or not"},
      {"dark", Kind::kSwitch, "", "", "the thing is dark on a light ground"},
      {"region", Kind::kText, "X,Y,W,H", "", "look only here, in pixels from the top left"},
      {"frames", Kind::kSamples, "A:B", "", "only these frames, 1-based and inclusive"},
      ranged({"rate", Kind::kNumber, "HZ", "", "frames a second of a folder of images; overrides a video's own"}, 0.01,
             1e5),
      {"wind-measure",
       Kind::kChoice,
       "M",
       "speed",
       "what is made of the sound: speed (of what sounds like wind), heard (speed, other sounds too), rms (plain)",
       {"speed", "heard", "rms"}},
  };
}

Result<ClipCapture> capture_options(const Arguments& arguments) {
  ClipCapture options;
  // Commands that find no outline lack some of these flags.
  if (arguments.has("points")) options.points = arguments.integer("points");
  if (arguments.has("channel")) options.channel = channel_from_name(arguments.text("channel"));
  options.dark = arguments.on("dark");
  if (arguments.has("flame")) options.flame = arguments.integer("flame");
  if (arguments.has("region")) {
    const auto region = parse_region(arguments.text("region"));
    if (!region) return region.error();
    options.region = *region;
  }
  if (arguments.has("frames")) {
    const SampleRange frames = arguments.samples("frames");
    options.frames = FrameRange{static_cast<std::int64_t>(frames.first), static_cast<std::int64_t>(frames.last)};
  }
  if (arguments.has("rate")) options.rate_hz = arguments.number("rate");
  if (arguments.has("rate") && !(options.rate_hz > 0))
    return Error{"--rate: found \"" + arguments.text("rate") + "\", expected frames a second above 0"};
  if (arguments.has("wind-measure")) options.wind = wind_measure(arguments);
  return options;
}

Result<void> check_present(const Arguments& arguments) {
  for (const std::string& path : arguments.positionals()) {
    std::error_code none;
    if (arguments.on("skip-bad") || std::filesystem::exists(path, none)) continue;
    return Error{path + ": no such file; check the path"};
  }
  return {};
}

std::string of_clips(const std::string& table) {
  return "is of a clip, and " + table + " is a table; give the clip, or leave it out";
}

Result<std::vector<Recording>> outline_recordings(const std::vector<std::string>& paths, const Arguments& arguments,
                                                  Terminal& terminal) {
  auto options = capture_options(arguments);
  if (!options) return options.error();
  if (std::ranges::all_of(paths, [](const std::string& path) { return is_table(path); })) {
    auto ok = refuse(arguments, {"points", "channel", "flame", "dark", "region", "wind-measure"}, of_clips(paths[0]));
    if (!ok) return ok.error();
  }
  const auto recording_of = [&](const std::string& path) -> Result<Recording> {
    if (is_table(path)) {
      auto table = read_table(path, arguments);
      return table ? in_range(*std::move(table), arguments, "frames") : std::move(table);
    }
    auto clip = capture(path, *options, terminal.progress());
    if (!clip) return clip.error();
    for (const std::string& warning : clip->report.warnings) terminal.warn(path + ": " + warning);
    terminal.verdict(path, clip->report);
    return std::move(clip->recording);
  };
  if (auto ok = check_present(arguments); !ok) return ok.error();
  return read_all(paths, arguments, terminal, [&](const std::string& path) {
    auto recording = recording_of(path);
    const auto curve = recording ? curve_of(*recording) : std::nullopt;
    const int points = curve ? static_cast<int>(curve->knots.size()) - 4 : options->points;
    if (arguments.given("points") && points != options->points) {
      recording = Error{"--points " + arguments.text("points") + ": " + path + " has " + std::to_string(points) +
                        " control points, expected as many in every recording: leave one of the two out"};
    } else if (!options->curve) {
      options->curve = curve;
    }
    return recording;
  });
}

}  // namespace wisp::cli
