// `wisp capture outline`, its preset `wisp capture flame`, `capture brightness`, `capture wind` and `capture fall`:
// each converts a clip to a recording; `brightness` also takes a photodiode's table, and `wind` a sound file.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <span>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "flags/recipe_flags.hpp"
#include "flags/recordings.hpp"
#include "terminal.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {
namespace {

// Whether --output names a folder: several clips, a final slash, or it exists (a wildcard may match a single clip).
bool goes_to_folder(const Arguments& arguments) {
  std::error_code none;
  const std::filesystem::path output(arguments.text("output"));
  return arguments.positionals().size() > 1 || !output.has_filename() || std::filesystem::is_directory(output, none);
}

// Creates the folder and returns one path in it per clip, with the clip's name.
// Errors: two clips with the same name; `folder` is a table's name or cannot be created.
Result<std::vector<std::filesystem::path>> tables_in(const std::string& folder, const std::vector<std::string>& clips) {
  if (is_table(folder)) {
    return Error{"--output " + folder + " is the name of one recording, expected a folder for those of " +
                 std::to_string(clips.size()) + " clips"};
  }
  std::vector<std::filesystem::path> tables;
  for (const std::string& clip : clips) {
    const std::filesystem::path path(clip), name = path.has_filename() ? path.stem() : path.parent_path().filename();
    tables.push_back(std::filesystem::path(folder) / (name.string() + ".csv"));
    const auto same = std::find(tables.begin(), tables.end() - 1, tables.back());
    if (same == tables.end() - 1) continue;
    return Error{clip + " and " + clips[static_cast<std::size_t>(same - tables.begin())] +
                 " would both be written as " + tables.back().string() + ": rename one of them"};
  }
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (!std::filesystem::is_directory(folder)) return Error{folder + ": cannot be made a folder: " + code.message()};
  return tables;
}

Result<void> run_many(const ClipCapture& options, const Arguments& arguments, Terminal& terminal) {
  const auto& clips = arguments.positionals();
  const std::string& folder = arguments.text("output");
  const auto tables = tables_in(folder, clips);
  if (!tables) return tables.error();
  if (auto ok = check_present(arguments); !ok) return ok;
  ReportTable written{"clips", "", {{"clip", ""}, {"recording", ""}, {"usable", ""}, {"reason", ""}}, {}};
  for (std::size_t k = 0; k < clips.size(); ++k) {
    const auto clip = capture(clips[k], options, terminal.progress());
    if (!clip) {
      if (leave_out(clips[k], clip.error(), arguments, terminal)) continue;
      return clip.error();
    }
    if (auto ok = write_csv((*tables)[k], clip->recording); !ok) return ok;
    for (const std::string& warning : clip->report.warnings) terminal.warn(clips[k] + ": " + warning);
    terminal.verdict(clips[k], clip->report);
    const ReportVerdict verdict = clip->report.verdict.value_or(ReportVerdict{});
    written.rows.push_back({clips[k], (*tables)[k].string(), verdict.usable, verdict.reason});
  }
  if (written.rows.empty()) return Error{"none of the clips can be used"};
  terminal.say("wrote " + std::to_string(written.rows.size()) + " recordings to " + folder);
  terminal.add(std::move(written));
  terminal.add("output", folder);
  return {};
}

// Captures one film or, with --angles, several films of one flame.
Result<Captured> captured(const ClipCapture& options, const Arguments& arguments, Terminal& terminal) {
  if (!arguments.has("angles")) return capture(arguments.positional(), options, terminal.progress());
  std::vector<double> angles;
  for (const std::string& word : arguments.names("angles")) {
    char* end = nullptr;
    angles.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0' || word.empty()) return Error{"--angles: found \"" + word + "\", expected degrees, such as 0,90"};
  }
  if (auto ok = check_present(arguments); !ok) return ok.error();
  const std::vector<std::filesystem::path> films(arguments.positionals().begin(), arguments.positionals().end());
  return capture_views(films, angles, options, terminal.progress());
}

Result<void> run_capture(const Arguments& arguments, Terminal& terminal) {
  const auto options = capture_options(arguments);
  if (!options) return options.error();
  if (!arguments.has("angles") && goes_to_folder(arguments)) return run_many(*options, arguments, terminal);
  const auto clip = captured(*options, arguments, terminal);
  if (!clip) return clip.error();
  const std::string& path = arguments.text("output");
  if (auto ok = write_csv(path, clip->recording); !ok) return ok;
  terminal.show(clip->report);
  terminal.say("wrote " + path);
  terminal.add("output", path);
  terminal.add("seconds", terminal.seconds());
  return {};
}

// Returns the mean of the samples that are not missing; NaN if all are.
double mean_of(std::span<const double> samples) {
  double sum = 0, rows = 0;
  for (const double value : samples) {
    if (std::isnan(value)) continue;
    sum += value;
    rows += 1;
  }
  return sum / rows;
}

// Returns the number of samples during which a lamp or an amplifier starts up: the leading samples below all samples
// after the first second. 0 if the first sample is at least half of the mean, or if the trace lasts at most a second.
std::size_t start_up_samples(std::span<const double> light, double rate_hz) {
  const auto second = std::min(light.size(), static_cast<std::size_t>(std::max(1.0, rate_hz)));
  if (second == light.size() || !(light.front() < 0.5 * mean_of(light))) return 0;
  const double least = std::accumulate(light.begin() + static_cast<std::ptrdiff_t>(second), light.end(), HUGE_VAL,
                                       [](double a, double b) { return std::fmin(a, b); });  // passes over NaN
  return static_cast<std::size_t>(std::find_if(light.begin(), light.begin() + static_cast<std::ptrdiff_t>(second),
                                               [&](double x) { return x >= least; }) -
                                  light.begin());
}

// Returns the light of a clip, or a photodiode's trace, normalised to mean 1.
Result<Recording> brightness_of(const Arguments& arguments, Terminal& terminal) {
  const std::string& path = arguments.positional();
  if (!is_table(path)) {
    if (auto ok = refuse(arguments, {"channel", "columns"}, "is of a table, and " + path + " is a clip"); !ok)
      return ok.error();
    Arguments of_clip = arguments;
    of_clip.set("channel", "luma");
    auto options = capture_options(of_clip);
    const auto stated = csv_options(arguments);  // --rate or --dt
    if (!options || !stated) return options ? stated.error() : options.error();
    options->rate_hz = stated->rate_hz;
    std::vector<std::string> warnings;
    auto captured = capture_brightness(path, *options, terminal.progress(), &warnings);
    for (const std::string& warning : warnings) terminal.warn(path + ": " + warning);
    return captured;
  }
  if (auto ok = refuse(arguments, {"region", "frames"}, of_clips(path)); !ok) return ok.error();
  const std::string& name = arguments.text("channel");
  auto recording = read_table(path, arguments, {.outputs = {name}});
  if (!recording) return recording;
  const auto channel = find_channel(*recording, name);
  if (!channel) return Error{path + ": --channel " + name + " has several columns; name one, such as " + name + "1"};
  Channel light = std::move(recording->channels[*channel]);
  if (const std::size_t count = start_up_samples(light.samples, recording->rate_hz); count > 0) {
    std::fill_n(light.samples.begin(), count, std::nan(""));
    terminal.warn(path + ": left out its first " + std::to_string(count) + " samples, in which the light starts up");
  }
  const double mean = mean_of(light.samples);
  if (!(mean > 0)) return Error{path + ": its light is not above 0 on average; is the column right, and dark at 0?"};
  for (double& value : light.samples) value /= mean;
  light.name = "brightness";
  light.unit.clear();
  recording->channels = {std::move(light)};
  return recording;
}

Result<void> run_brightness(const Arguments& arguments, Terminal& terminal) {
  const auto recording = brightness_of(arguments, terminal);
  if (!recording) return recording.error();
  const std::string& path = arguments.text("output");
  if (auto ok = write_csv(path, *recording); !ok) return ok;
  terminal.add("frames", recording->rows());
  terminal.add("rate_hz", recording->rate_hz);
  terminal.add("output", path);
  terminal.say("wrote " + path + ": " + std::to_string(recording->rows()) + " rows, " + shown(recording->rate_hz, 5) +
               " a second");
  return {};
}

Result<void> run_wind(const Arguments& arguments, Terminal& terminal) {
  const auto options = capture_options(arguments);
  if (!options) return options.error();
  const auto recording = capture_wind(arguments.positional(), options->rate_hz, options->wind);
  if (!recording) return recording.error();
  const std::string& path = arguments.text("output");
  if (auto ok = write_csv(path, *recording); !ok) return ok;
  const std::vector<double>& wind = recording->channels.front().samples;
  const auto blown = std::count_if(wind.begin(), wind.end(), [](double value) { return value > 0; });
  terminal.add("frames", recording->rows());
  terminal.add("rate_hz", recording->rate_hz);
  terminal.add("heard", static_cast<double>(blown) / static_cast<double>(wind.size()));
  terminal.add("output", path);
  terminal.say("wrote " + path + ": " + std::to_string(wind.size()) + " rows, " + shown(recording->rate_hz, 5) +
               " a second, wind in " + std::to_string(100 * blown / static_cast<std::ptrdiff_t>(wind.size())) +
               " % of them");
  return {};
}

Result<void> run_fall(const Arguments& arguments, Terminal& terminal) {
  const auto clip = capture_options(arguments);
  if (!clip) return clip.error();
  const FallOptions options{.height_metres = arguments.has("height") ? arguments.number("height") : 0,
                            .region = clip->region,
                            .frames = clip->frames,
                            .rate_hz = clip->rate_hz};
  const auto falls = capture_falls(arguments.positional(), options, terminal.progress());
  if (!falls) return falls.error();
  const std::string& path = arguments.text("output");
  if (auto ok = write_csv(path, falls->recording); !ok) return ok;
  terminal.show(falls->report);
  terminal.say("wrote " + path);
  terminal.add("output", path);
  return {};
}

Command capturing(std::string name, const std::string& flame, std::string summary, std::vector<Example> examples) {
  const Flag output{"output",
                    Kind::kOutput,
                    "REC.csv",
                    "",
                    "where to write the recording; of several clips, and of one where it is there, a folder, in which "
                    "each has its own name",
                    {},
                    true};
  const Flag skip{"skip-bad", Kind::kSwitch, "", "",
                  "of several: leave bad clips out, listing them, instead of stopping"};
  return {std::move(name),
          std::move(summary),
          {{"CLIP", "video files, or folders of numbered images", true}},
          flags_of({{output}, capture_flags(flame), {skip}}),
          std::move(examples),
          run_capture};
}

}  // namespace

Command capture_outline_command() {
  return capturing("capture outline", "0",
                   "Finds the outline of a moving thing in a clip, frame by frame, and writes it as a recording.",
                   {{"wisp capture outline flag.mp4 --dark --points 12 -o flag.csv", "A dark flag on a light ground"},
                    {"wisp capture outline frames/ --rate 30 -o flame.csv", "A folder of numbered images"}});
}

Command capture_flame_command() {
  Command command = capturing(
      "capture flame", "1", "Finds the outline of a flame in a clip: `capture outline` with a flame's settings.",
      {{"wisp capture flame candle.mp4 -o candle.csv", "The outline of a candle's flame, eight control points"},
       {"wisp capture flame candle.mp4 --points 16 --frames 1:300 -o candle.csv",
        "Finer, and only the first 300 frames"},
       {"wisp capture flame one.mp4 two.mp4 -o recordings", "Several clips: recordings/one.csv, recordings/two.csv"},
       {"wisp capture flame front.mp4 side.mp4 --angles 0,90 -o candle.csv",
        "One flame, filmed by two level cameras a quarter turn apart"}});
  command.flags.push_back({"angles", Kind::kNames, "DEG,DEG", "",
                           "the films are of one flame, by level cameras so many degrees round it, anticlockwise from "
                           "above: one body is written"});
  return command;
}

Command capture_brightness_command() {
  const std::vector<Flag> flags = {
      {"output", Kind::kOutput, "REC.csv", "", "where to write the recording", {}, true},
      {"region", Kind::kText, "X,Y,W,H", "", "of a clip: look only here, in pixels from the top left"},
      {"frames", Kind::kSamples, "A:B", "", "of a clip: only these frames, 1-based and inclusive"},
      {"channel", Kind::kText, "NAME", "brightness", "of a table: the column of light"},
  };
  return {"capture brightness",
          "Measures the light of a clip, frame by frame, or takes a photodiode's trace, linear and of mean 1.",
          {{"CLIP_OR_TRACE", "a video file, a folder of numbered images, or a table"}},
          flags_of({flags, table_flags()}),
          {{"wisp capture brightness candle.mp4 --region 300,100,200,400 -o light.csv", "A candle's light"},
           {"wisp capture brightness photodiode.csv --columns time,brightness --rate 100 -o light.csv",
            "A photodiode's trace"}},
          run_brightness};
}

Command capture_wind_command() {
  std::vector<Flag> of_clips = capture_flags("0");
  return {"capture wind",
          "Hears the wind in a sound file, or in a film's sound, and writes it as a recording.",
          {{"SOUND", "a sound file, or a film with sound"}},
          {{"output", Kind::kOutput, "REC.csv", "", "where to write the recording", {}, true},
           ranged({"rate", Kind::kNumber, "HZ", "60", "rows a second"}, 1, 1000),
           flag_named(of_clips, "wind-measure")},
          {{"wisp capture wind breath.wav -o wind.csv", "The wind of a breath, 60 rows a second"}},
          run_wind};
}

Command capture_fall_command() {
  return {"capture fall",
          "Tracks something light that is dropped before a plain wall, and writes its falls, an episode each.",
          {{"CLIP", "a video file, or a folder of numbered images"}},
          {{"output", Kind::kOutput, "REC.csv", "", "where to write the recording", {}, true},
           ranged({"height", Kind::kNumber, "METRES", "",
                   "how much of the wall the picture's height shows; without it, 1 m is taken"},
                  0.01, 100),
           {"region", Kind::kText, "X,Y,W,H", "", "look only here, in pixels from the top left"},
           {"frames", Kind::kSamples, "A:B", "", "only these frames, 1-based and inclusive"},
           {"rate", Kind::kNumber, "HZ", "",
            "frames a second that were filmed: of a folder of images, or of a film in slow motion"}},
          {{"wisp capture fall paper.mp4 --height 2.1 -o falls.csv", "A strip of paper, dropped again and again"},
           {"wisp capture fall slow.mp4 --rate 240 --height 2.1 -o falls.csv", "Filmed in slow motion"}},
          run_fall};
}

}  // namespace wisp::cli
