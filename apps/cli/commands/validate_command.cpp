// `wisp validate`: judges a model on a recording or a clip.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "commands/commands.hpp"
#include "films/leaf_film.hpp"
#include "films/looped.hpp"
#include "films/validation_pictures.hpp"
#include "flags/arx_flags.hpp"
#include "flags/capture_flags.hpp"
#include "flags/motion_flags.hpp"
#include "flags/recipe_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_validation.hpp"
#include "reports/clip_figures.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

Result<ValidationSubject> subject_of(const std::string& path, const Model& model, const Arguments& arguments,
                                     Terminal& terminal) {
  ValidationSubject subject;
  if (is_table(path)) {
    auto ok = refuse(arguments, {"channel", "flame", "dark", "region", "wind-measure"}, of_clips(path));
    if (ok && !arguments.has("clip")) ok = refuse(arguments, {"frames"}, of_clips(path) + ", or give --range");
    if (!ok) return ok.error();
    auto recording = read_table(path, arguments);
    if (!recording) return recording.error();
    subject.recording = std::move(*recording);
  } else {
    auto options = capture_options(arguments);
    if (!options) return options.error();
    auto of_table =
        refuse(arguments, {"clip", "inputs", "outputs", "columns", "dt"}, "is of a table, and " + path + " is a clip");
    if (!of_table) return of_table.error();
    const auto curve = curve_of(model);
    if (!curve) return curve.error();
    options->curve = *curve;
    auto clip = capture(path, *options, terminal.progress());
    if (!clip) return clip.error();
    for (const std::string& warning : clip->report.warnings) terminal.warn(warning);
    subject.recording = std::move(clip->recording);
    subject.captured = std::move(clip->report);
  }
  const std::string named = arguments.has("clip") ? arguments.text("clip") : "";
  subject.clip = clip_of(subject.recording, subject.captured ? path : named);
  if (arguments.has("rate")) subject.clip.rate_hz = arguments.number("rate");
  if (arguments.has("frames")) subject.clip.first_frame = arguments.samples("frames").first - 1;
  if (arguments.has("range")) subject.clip.first_frame += arguments.samples("range").first - 1;
  auto part = in_range(std::move(subject.recording), arguments, "range");
  if (!part) return part.error();
  subject.recording = std::move(*part);
  return subject;
}

ValidationPictures wanted_pictures(const Arguments& arguments) {
  const auto path = [&](const char* flag) { return arguments.has(flag) ? arguments.text(flag) : std::string(); };
  return {path("overlay"), path("film-strip"), path("figures")};
}

// ---- Plots of a chain's validation ----

constexpr Colour kModeColours[] = {{31, 119, 180}, {214, 96, 20},  {44, 140, 44},   {190, 40, 40},
                                   {130, 90, 180}, {120, 80, 60},  {210, 100, 170}, {90, 90, 90},
                                   {150, 150, 20}, {20, 160, 170}, {0, 0, 0},       {240, 170, 60}};
constexpr Colour kStill{40, 60, 110};
constexpr Colour kBlown{30, 140, 60};

// Sets the style of a series by the part of its id after the panel's name.
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

// Returns a plot of the series whose id is `panel` or begins with `panel` and a dot.
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

// Draws the series of a chain's report into a folder (created if missing), each sheet as PNG and SVG. For falls:
// recorded and synthesized ones side by side, from the side and from above, and one of each with its events marked, the
// synthesized one's segments coloured by mode. For gusts, as in the paper's figure 8: one row per gust, with the
// recorded falls on the left and the model's on the right; thin lines are clones, thick ones their means, green where
// the wind blows; dashed is the mean without wind. Errors: the folder cannot be made, a file cannot be written.
Result<void> write_chain_figures(const std::filesystem::path& folder, const Report& report) {
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

// Writes a film with recorded falls on the left and the model's on the right.
Result<void> film(const Model& model, const Recording& real, const Arguments& arguments, Terminal& terminal) {
  const auto* pose = std::get_if<PoseView>(&model.view);
  if (!pose) return Error{"--film is for poses; this model has positions only"};
  LeafFilmOptions options;
  if (pose->half_width > 0 && pose->half_length > 0) {
    options.style.length = static_cast<float>(2 * pose->half_width);
    options.style.width = static_cast<float>(2 * pose->half_length);
  }
  const auto all = episodes(real);
  std::size_t rows = 0;
  for (const Episode& episode : all) rows = std::max(rows, episode.size());
  const auto taken = take(model, {.seconds = static_cast<double>(rows) / model.rate_hz,
                                  .instances = std::min(static_cast<int>(all.size()), options.max_leaves),
                                  .seed = static_cast<std::uint64_t>(arguments.integer("seed"))});
  if (!taken) return taken.error();
  const Recording made = recording_of(model, *taken, 0, arguments.text("seed"));
  const LeafPanel panels[] = {{&real, "recorded"}, {&made, "synthesized"}};
  if (auto ok = write_leaf_films(arguments.text("film"), panels, options, terminal); !ok) return ok;
  terminal.say("wrote " + arguments.text("film"));
  return {};
}

Result<void> check_chain_flags(const Arguments& arguments) {
  auto ok = refuse(arguments, {"overlay", "film-strip", "clip"},
                   "is for outlines; this model is a segment chain (--film films falls)");
  if (ok)
    ok = refuse(arguments, {"steps", "initial"}, "is for models that predict rows, which a segment chain does not");
  return ok && arguments.has("film") ? check_film_name(arguments.text("film")) : ok;
}

// Reads the recording and its calm twin: the third argument or, if the recording is of a pair, REC.calm.csv beside it.
Result<std::vector<Recording>> read_recordings(const Arguments& arguments, double rate_hz) {
  const auto& paths = arguments.positionals();
  if (paths.size() > 3) return Error{paths[3] + ": is one file too many, expected a recording and its twin"};
  auto whole = read_table(paths[1], arguments, motion_table(arguments, rate_hz));
  if (!whole) return whole.error();
  auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  std::vector<Recording> all;
  all.push_back(std::move(*recording));
  std::string twin = paths.size() > 2 ? paths[2] : "";
  if (find_attribute(all.front(), "pair") && twin.empty()) {
    twin = std::filesystem::path(paths[1]).replace_extension(".calm.csv").string();
    if (!std::filesystem::exists(twin)) {
      return Error{all.front().source + ": is one of a pair, and there is no " + twin +
                   ", expected its twin as a third argument"};
    }
  }
  if (twin.empty()) return all;
  auto other = read_table(twin, arguments, motion_table(arguments, rate_hz));
  if (other) other = in_range(*std::move(other), arguments, "range");
  if (!other) return other.error();
  all.push_back(std::move(*other));
  return all;
}

// Compares a chain's falls with recorded ones, or its response to gusts with that of a pair of recordings, and draws
// both. Errors: the recording can't be read or compared, a flag that only outlines have.
Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal) {
  if (auto ok = check_chain_flags(arguments); !ok) return ok;
  const auto recordings = read_recordings(arguments, model.rate_hz);
  if (!recordings) return recordings.error();
  const ValidationOptions options{.seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  const auto report = validate(model, *recordings, options, terminal.progress());
  if (!report) return report.error();
  terminal.show(*report);
  if (arguments.has("film")) {
    if (auto ok = film(model, recordings->front(), arguments, terminal); !ok) return ok;
  }
  if (!arguments.has("figures")) return {};
  if (auto ok = write_chain_figures(arguments.text("figures"), *report); !ok) return ok;
  terminal.say("wrote figures to " + arguments.text("figures"));
  return {};
}

Result<void> run_validate(const Arguments& arguments, Terminal& terminal) {
  const auto& positionals = arguments.positionals();
  const auto model = read_model(positionals[0]);
  if (!model) return model.error();
  const auto steps = steps_in(arguments);
  if (!steps) return steps.error();
  auto of_films =
      refuse(arguments, {"frames", "channel", "flame", "dark", "region", "wind-measure", "own-gain", "align"},
             "is for models of outlines, which this model is not; rows are chosen by --range");
  if (!std::holds_alternative<OutlineView>(model->view) && !of_films) return of_films;
  if (std::holds_alternative<ChainModel>(model->dynamics)) return validate_chain(*model, arguments, terminal);
  if (!std::holds_alternative<OutlineView>(model->view)) return validate_plain(*model, *steps, arguments, terminal);
  auto filmed = refuse(arguments, {"film"}, "is for segment chains of poses; this model is of an outline");
  if (filmed) filmed = refuse(arguments, {"initial"}, "is for plain models; this model is of an outline");
  if (!filmed) return filmed;
  if (arguments.has("film-strip") && std::filesystem::path(arguments.text("film-strip")).extension() == ".svg")
    return Error{"--film-strip " + arguments.text("film-strip") + ": a strip has pixels, expected a name in .png"};
  if (positionals.size() > 2) {
    return Error{positionals[2] + ": is one file too many, only plain ARX models are judged on several"};
  }
  auto subject = subject_of(positionals[1], *model, arguments, terminal);
  if (!subject) return subject.error();
  const ValidationOptions options{.steps = *steps,
                                  .own_input_scale = arguments.on("own-gain"),
                                  .align = arguments.text("align") == "auto",
                                  .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  const auto found = validate_outline(*model, subject->recording, options, terminal.progress());
  if (!found) return found.error();
  terminal.show(found->report);
  return draw_validation(*found, *model, *subject, wanted_pictures(arguments), terminal);
}

}  // namespace

Command validate_command() {
  std::vector<Flag> of_outlines = recipe_flags(OutlineRecipe{});
  std::vector<Flag> flags = {
      {"range", Kind::kSamples, "A:B", "", "rows to judge on, 1-based and inclusive"},
      {"steps", Kind::kNames, "K,…", "1,5,15,inf", "steps ahead; inf is free simulation from the input alone"},
      initial_flag(),
      {"overlay", Kind::kOutput, "OUT.mp4", "", "write the clip with captured and simulated outlines drawn over it"},
      {"film-strip", Kind::kOutput, "OUT.png", "", "write a film strip: recorded above, synthesized below"},
      {"film", Kind::kOutput, "OUT.mp4", "",
       "film recorded and synthesized falls side by side (segment chains of poses)"},
      {"figures", Kind::kOutput, "DIR", "", "write plots there, as PNG and SVG"},
      {"clip", Kind::kPath, "CLIP", "", "the clip that the recording was captured from, for the pictures"},
      {"own-gain", Kind::kSwitch, "", "",
       "input 1 is this recording's own 95th percentile: another microphone, another gain"},
      flag_named(of_outlines, "align"),
      {"seed", Kind::kInteger, "N", "1", "of the synthesized life"},
      {"inputs", Kind::kNames, "A,B", "",
       "columns that are the model's inputs, in its order, where they have other names"},
      {"outputs", Kind::kNames, "C,D", "",
       "columns that are the model's outputs, in its order, where they have other names"},
      {"columns", Kind::kNames, "A,B,…", "", "names of all columns of a plain table, in their order"},
      {"dt", Kind::kNumber, "S", "", "seconds between samples of a plain table; default: as the model's"},
  };
  for (Flag& flag : motion_flags()) flags.push_back(std::move(flag));
  for (Flag& flag : capture_flags("1")) {
    if (flag.name != "points") flags.push_back(std::move(flag));  // the model determines the number of points
  }
  return {
      "validate",
      "Judges a model on a recording: prediction, free simulation, fidelity, pictures.",
      {{"MODEL", "the model, a .wisp file"},
       {"REC_OR_CLIP",
        "a recording (.csv), or a clip; of a plain ARX model several recordings; of a segment chain a recording and "
        "its twin that differs only in its wind, where REC.calm.csv beside REC.csv is found by itself",
        true}},
      std::move(flags),
      {{"wisp validate flame.wisp other.mp4 --overlay overlay.mp4 --film-strip strip.png",
        "On a clip that it has not seen"},
       {"wisp validate leaf.wisp others.csv --figures figures --film falls.mp4", "A leaf's falls on unseen ones"},
       {"wisp validate leaf.wisp gusts.csv gusts.calm.csv --figures figures",
        "What gusts do to it, from `wisp simulate leaf --pairs`"},
       {"wisp validate dryer.wisp hairdryer.csv --dt 0.08 --range 501:1000 --steps 1,10,inf",
        "An ARX model on unseen rows"}},
      run_validate,
  };
}

}  // namespace wisp::cli
