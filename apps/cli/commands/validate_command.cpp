// `wisp validate`: a model held against a recording or a clip.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "commands/commands.hpp"
#include "films/outline_film.hpp"
#include "flags/capture_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_validation.hpp"
#include "reports/blow_out_learning.hpp"
#include "reports/clip_figures.hpp"
#include "reports/figures_json.hpp"
#include "reports/outline_learning.hpp"
#include "reports/switched_validation.hpp"
#include "reports/validate_chain.hpp"
#include "reports/validation_figures.hpp"
#include "wisp/learn/outline_shape.hpp"
#include "wisp/learn/validation.hpp"
#include "wisp/learn/wind_gain.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

// A recording and, where there is one, the clip whose frames its rows are.
struct Subject {
  Recording recording;
  ClipFrames clip;
  std::optional<CaptureReport> report;  // where it was captured just now
};

Result<Subject> subject_of(const std::string& path, const Model& model, const Arguments& arguments,
                           Terminal& terminal) {
  Subject subject;
  if (is_table(path)) {
    auto recording = read_table(path, arguments);
    if (!recording) return recording.error();
    subject.recording = std::move(*recording);
    if (arguments.has("clip")) subject.clip.path = arguments.text("clip");
  } else {
    auto clip =
        capture_clip(path, arguments, terminal, {std::get<OutlineView>(model.view).knots, model.training.underside});
    if (!clip) return clip.error();
    for (const std::string& warning : clip->report.warnings) terminal.warn(warning);
    subject.recording = std::move(clip->recording);
    subject.report = std::move(clip->report);
    subject.clip.path = path;
  }
  if (arguments.has("rate")) subject.clip.rate_hz = arguments.number("rate");
  if (arguments.has("frames")) subject.clip.first_frame = arguments.samples("frames").first - 1;
  if (arguments.has("range")) subject.clip.first_frame += arguments.samples("range").first - 1;
  auto part = in_range(std::move(subject.recording), arguments, "range");
  if (!part) return part.error();
  subject.recording = std::move(*part);
  return subject;
}

Result<std::vector<int>> judged_steps(const Arguments& arguments) {
  std::vector<int> steps;
  for (const std::string& word : arguments.names("steps")) {
    const int step = word == "inf" ? kFreeRun : std::atoi(word.c_str());
    const bool valid =
        word == "inf" || (step >= 1 && step <= 100000 && word.find_first_not_of("0123456789") == std::string::npos);
    if (!valid)
      return Error{"--steps: found \"" + word + "\", expected numbers from 1 to 100000, or inf, separated by commas"};
    steps.push_back(step);
  }
  return steps;
}

// A row's outline in the picture; empty where it has none.
std::vector<Point> polyline_in_picture(const OutlineCurve& curve, const OutlineLayout& layout,
                                       const Recording& recording, std::size_t row) {
  std::vector<double> control;
  for (std::size_t channel : layout.outputs) control.push_back(recording.channels[channel].samples[row]);
  if (std::any_of(control.begin(), control.end(), [](double value) { return std::isnan(value); })) return {};
  // A pixel's centre is at whole numbers for capture and at halves for drawing.
  std::vector<Point> points;
  for (const OutlinePoint& point : curve.polyline(control)) {
    points.push_back({static_cast<float>(point[0] + 0.5), static_cast<float>(point[1] + 0.5)});
  }
  return points;
}

OutlineRows outline_rows(const Judged& judged, const Recording& recording) {
  const OutlineCurve curve(judged.layout.knots);
  const PredictedOutlines& shown = judged.shown();
  OutlineRows rows;
  rows.simulated_label = shown_as(shown);
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    rows.captured.push_back(polyline_in_picture(curve, judged.layout, recording, row));
    rows.simulated.push_back(polyline_in_picture(curve, judged.layout, shown.recording, row));
  }
  return rows;
}

// The strip shows twelve moments an eighth of a second apart, where the outline moves most.
std::vector<std::size_t> strip_rows(const Judged& judged, const Recording& recording) {
  constexpr std::size_t kColumns = 12;
  const auto apart = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(recording.rate_hz / 8)));
  const std::size_t length = (kColumns - 1) * apart + 1;
  const auto tip = recording.channels[judged.layout.outputs[2 * (judged.layout.points / 2)]].samples;
  std::size_t best = 0;
  double most = -1;
  for (std::size_t begin = 0; begin + length <= tip.size(); begin += apart) {
    double motion = 0;
    bool whole = true;
    for (std::size_t row = begin + apart; row < begin + length; row += apart) {
      whole = whole && !std::isnan(tip[row]) && !std::isnan(tip[row - apart]);
      motion += std::abs(tip[row] - tip[row - apart]);
    }
    if (!whole || motion <= most) continue;
    most = motion;
    best = begin;
  }
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < kColumns && best + k * apart < recording.rows(); ++k) rows.push_back(best + k * apart);
  return rows;
}

Result<void> draw(const Judged& judged, const Model& model, const Subject& subject, const Arguments& arguments,
                  Terminal& terminal) {
  if (arguments.has("overlay")) {
    const auto rows = outline_rows(judged, subject.recording);
    if (auto ok = write_overlay(arguments.text("overlay"), subject.clip, subject.recording, rows, terminal); !ok)
      return ok;
    terminal.say("wrote " + arguments.text("overlay"));
  }
  if (arguments.has("film-strip")) {
    const auto played_layout = outline_layout(judged.found.played);
    if (!played_layout) return played_layout.error();
    const StripContent content{
        .rows = strip_rows(judged, subject.recording),
        .recording = &subject.recording,
        .synthesized = &judged.found.played,
        .layout = judged.layout,
        .synthesized_layout = *played_layout,
        .pixels_per_unit = judged.found.pixels_per_unit,
        .synthesized_caption = model.inputs.empty() ? "synthesized" : "synthesized from the same wind"};
    if (auto ok = write_film_strip(arguments.text("film-strip"), subject.clip, content); !ok) return ok;
    terminal.say("wrote " + arguments.text("film-strip"));
  }
  if (!arguments.has("figures")) return {};
  const std::string& folder = arguments.text("figures");
  if (auto ok = write_validation_figures(folder, model, subject.recording, judged); !ok) return ok;
  if (subject.report) {
    if (auto ok = write_clip_figures(folder, subject.clip.path, *subject.report); !ok) return ok;
  }
  terminal.say("wrote figures to " + folder);
  return {};
}

Json bounded_json(const Bounded& measure) {
  return {{"value", number(measure.value)}, {"floor", number(measure.floor)}, {"ceiling", number(measure.ceiling)}};
}

Json fidelity_json(const Fidelity& fidelity) {
  Json json = {{"log_spectral_distance", bounded_json(fidelity.log_spectral_distance)},
               {"autocorrelation_distance", bounded_json(fidelity.autocorrelation_distance)},
               {"wasserstein_value", bounded_json(fidelity.wasserstein_value)},
               {"wasserstein_speed", bounded_json(fidelity.wasserstein_speed)},
               {"energy_distance", bounded_json(fidelity.energy_distance)},
               {"energy_p_value", number(fidelity.energy_p_value)},
               {"verbatim_seconds", number(fidelity.verbatim_seconds)},
               {"channels", Json::array()}};
  for (const ChannelFidelity& channel : fidelity.channels) {
    json["channels"].push_back({{"name", channel.name},
                                {"sd_real", number(channel.sd_real)},
                                {"sd_synthesized", number(channel.sd_synthesized)},
                                {"log_spectral_distance", bounded_json(channel.log_spectral_distance)}});
  }
  return json;
}

// What dynamics add, and what the sensor takes away.
void report_bounds(const OutlineValidation& found, Terminal& terminal) {
  Json& result = terminal.result();
  if (found.static_gain) {
    const StaticGain& gain = *found.static_gain;
    result["static_gain"] = {{"tip_fit_percent", number(gain.fit_percent)},
                             {"delay_seconds", number(gain.delay_seconds)}};
    terminal.say("  a static gain with the best delay (" + shown(1000 * gain.delay_seconds) + " ms): tip fit " +
                 shown(gain.fit_percent) + " %");
  }
  if (found.true_input) {
    const TrueInputFigures& truth = *found.true_input;
    result["true_input"] = {{"tip_fit_percent", number(truth.tip_fit_percent)}, {"overlap", number(truth.overlap)}};
    terminal.say("  free simulation from the input as it truly was: tip fit " + shown(truth.tip_fit_percent) +
                 " %, outline overlap " + shown(truth.overlap));
  }
}

void report(const OutlineValidation& found, Terminal& terminal) {
  Json& result = terminal.result();
  const OutlineFigures& figures = found.figures;
  result["rows"] = figures.rows;
  result["channels"] = Json::array();
  for (const OutlineChannelFigures& channel : figures.channels) {
    result["channels"].push_back({{"name", channel.name},
                                  {"fit_percent", by_steps(figures.steps, channel.fit_percent)},
                                  {"whiteness_p", number(channel.whiteness_p)}});
  }
  result["points"] = Json::array();
  for (std::size_t p = 0; !figures.j.empty() && p < figures.j.front().size(); ++p) {
    Json point = {{"fit_percent", Json::object()}, {"J", Json::object()}};
    for (std::size_t k = 0; k < figures.steps.size(); ++k) {
      const std::string ahead = figures.steps[k] == kFreeRun ? "inf" : std::to_string(figures.steps[k]);
      point["fit_percent"][ahead] = number(figures.point_fit_percent[k][p]);
      point["J"][ahead] = number(figures.j[k][p]);
    }
    result["points"].push_back(std::move(point));
  }
  result["alignment"] = alignment_json(found.alignment);
  result["J"] = by_steps(figures.steps, mean_per_step(figures.j));
  result["tip"] = {{"fit_percent", by_steps(figures.steps, figures.tip_fit_percent)}};
  result["overlap"] = number(at_steps(figures, figures.overlap, kFreeRun));
  result["overlap_by_steps"] = by_steps(figures.steps, figures.overlap);
  result["fidelity"] = found.fidelity ? fidelity_json(*found.fidelity) : Json(nullptr);
  result["held_share"] = number(found.held_share);
  result["crossed_share"] = number(found.crossed_share);
  for (const InputAlignment& one : found.alignment) terminal.say(one.note());
  terminal.say(std::to_string(figures.rows) + " frames judged");
  for (std::size_t k = 0; k < figures.steps.size(); ++k) {
    const std::string ahead =
        figures.steps[k] == kFreeRun ? "free simulation" : std::to_string(figures.steps[k]) + " ahead";
    terminal.say("  " + ahead + ": tip fit " + shown(figures.tip_fit_percent[k]) + " %, outline overlap " +
                 shown(figures.overlap[k]));
  }
  report_bounds(found, terminal);
  if (!found.fidelity) return;
  const Bounded& spectrum = found.fidelity->log_spectral_distance;
  const Bounded& energy = found.fidelity->energy_distance;
  terminal.say("synthesized against recorded: log-spectral distance " + shown(spectrum.value) +
               " dB (two halves of the recording: " + shown(spectrum.floor) +
               ", shuffled frames: " + shown(spectrum.ceiling) + ")");
  terminal.say("  normalised energy distance " + shown(energy.value) + " (halves " + shown(energy.floor) +
               ", shuffled " + shown(energy.ceiling) + ")");
}

// The rows of --truth that are the subject's.
Result<std::optional<Recording>> truth_for(const Subject& subject, const Arguments& arguments) {
  if (!arguments.has("truth")) return std::optional<Recording>();
  const auto truth = read_table(arguments.text("truth"), arguments);
  if (!truth) return truth.error();
  const std::size_t first = std::min(subject.clip.first_frame, truth->rows());
  return std::optional(slice(*truth, first, std::min(truth->rows(), first + subject.recording.rows())));
}

// Puts what the training's microphone heard on the model's scale, and says so: what the same wind is called elsewhere
// is easily overlooked.
Result<void> take_gain(const Model& model, bool own_scale, Subject& subject, Terminal& terminal) {
  const auto factor = own_scale ? Result<double>(1.0) : factor_to_trained_gain(model, subject.recording);
  if (!factor) return factor.error();
  terminal.result()["gain"] = number(*factor);
  if (own_scale) return {};
  auto heard = at_trained_gain(model, std::move(subject.recording));
  if (!heard) return heard.error();
  subject.recording = *std::move(heard);
  if (std::abs(*factor - 1) < 0.02) return {};
  terminal.say("its wind is taken times " + shown(*factor, 3) +
               ", as the training's microphone would call it; --own-gain where another one heard it");
  return {};
}

// Whether flames die by the rule where they died, and live where they lived.
Result<void> report_blow_outs(const Model& model, const Recording& recording, bool own_scale, Terminal& terminal) {
  auto judged = judged_extinction(model, recording, own_scale);
  if (!judged) return judged.error();
  const Json& found = terminal.result()["extinction"] = *std::move(judged);
  if (found.is_null()) return {};
  terminal.say("blow-out: " + found["died"].dump() + " of " + found["deaths"].dump() + " deaths, " +
               found["spared"].dump() + " of " + found["gusts"].dump() + " gusts survived by the model's rule too");
  for (const char* mode : {"dying", "catching"}) {
    const Json& judged_mode = found[mode];
    if (judged_mode["events"] == 0) continue;
    terminal.say(std::string(mode) + ": its size is " + shown(judged_mode["error"].get<double>(), 2) + " off in " +
                 judged_mode["events"].dump() + " of them, " + shown(judged_mode["default_error"].get<double>(), 2) +
                 " by the default's duration");
  }
  return {};
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto& positionals = arguments.positionals();
  const auto model = read_model(positionals[0]);
  if (!model) return model.error();
  const auto steps = judged_steps(arguments);
  if (!steps) return steps.error();
  if (std::holds_alternative<ChainModel>(model->dynamics)) return validate_chain(*model, arguments, terminal);
  if (positionals.size() > 2) return Error{positionals[2] + ": is one file too many, only segment chains take a twin"};
  if (std::holds_alternative<SwitchedArxModel>(model->dynamics))
    return validate_switched(*model, *steps, arguments, terminal);
  if (!std::holds_alternative<OutlineView>(model->view)) return validate_plain(*model, *steps, arguments, terminal);
  auto subject = subject_of(positionals[1], *model, arguments, terminal);
  if (!subject) return subject.error();
  const auto truth = truth_for(*subject, arguments);
  if (!truth) return truth.error();
  OutlineValidationOptions options{.steps = *steps,
                                   .own_input_scale = arguments.on("own-gain"),
                                   .align = arguments.text("align") == "auto",
                                   .truth = *truth ? &**truth : nullptr,
                                   .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  if (auto ok = take_gain(*model, options.own_input_scale, *subject, terminal); !ok) return ok;
  const auto burning = burning_part(*model, subject->recording);
  if (!burning) return burning.error();
  auto found = validate_outline(*model, *burning, options);
  if (!found) return found.error();
  for (const std::string& warning : found->warnings) terminal.warn(warning);
  const auto layout = outline_layout(subject->recording);
  if (!layout) return layout.error();
  const Judged judged{*layout, std::move(*found)};
  report(judged.found, terminal);
  if (auto ok = report_blow_outs(*model, subject->recording, options.own_input_scale, terminal); !ok) return ok;
  return draw(judged, *model, *subject, arguments, terminal);
}

}  // namespace

Command validate_command() {
  std::vector<Flag> flags = {
      {"range", Kind::kSamples, "A:B", "", "rows to judge on, 1-based and inclusive"},
      {"steps", Kind::kNames, "K,…", "1,5,15,inf", "steps ahead; inf is free simulation from the input alone"},
      {"initial",
       Kind::kChoice,
       "STATE",
       "measured",
       "where free simulation of a plain model starts: from measured samples, from rest (zero), or from what fits best",
       {"measured", "zero", "estimated"}},
      {"overlay", Kind::kPath, "OUT.mp4", "", "write the clip with captured and simulated outlines drawn over it"},
      {"film-strip", Kind::kPath, "OUT.png", "", "write a film strip: recorded above, synthesized below"},
      {"film", Kind::kPath, "OUT.mp4", "",
       "film recorded and synthesized falls side by side (segment chains of poses)"},
      {"figures", Kind::kPath, "DIR", "", "write plots there, as PNG and SVG"},
      {"clip", Kind::kPath, "CLIP", "", "the clip that the recording was captured from, for the pictures"},
      {"own-gain", Kind::kSwitch, "", "",
       "input 1 is this recording's own 95th percentile: another microphone, another gain"},
      align_flag(),
      {"truth", Kind::kPath, "REC.csv", "", "the inputs as they truly were: simulates from those too, to compare"},
      {"seed", Kind::kInteger, "N", "1", "of the synthesized life"},
      {"inputs", Kind::kNames, "A,B", "", "columns of a plain table that are inputs"},
      {"outputs", Kind::kNames, "C,D", "", "columns of a plain table that are outputs"},
      {"dt", Kind::kNumber, "S", "", "seconds between samples of a plain table"},
  };
  for (Flag& flag : capture_flags()) {
    if (flag.name != "points") flags.push_back(std::move(flag));  // the model says how many
  }
  return {
      "validate",
      "Holds a model against a recording: prediction, free simulation, likeness, pictures.",
      {{"MODEL", "the model, a .wisp file"},
       {"REC_OR_CLIP", "a recording (.csv), or a clip"},
       {"TWIN",
        "where the recording is one of a pair that differs only in its wind: the other one; REC.calm.csv beside "
        "REC.csv "
        "is found by itself",
        false, true}},
      std::move(flags),
      {{"wisp validate flame.wisp other.mp4 --overlay overlay.mp4 --film-strip strip.png",
        "On a clip that it has not seen"},
       {"wisp validate leaf.wisp others.csv --figures figures --film falls.mp4", "A leaf's falls on unseen ones"},
       {"wisp validate leaf.wisp gusts.csv gusts.calm.csv --figures figures",
        "What gusts do to it, from `wisp simulate leaf --pairs`"},
       {"wisp validate dryer.wisp hairdryer.csv --dt 0.08 --range 501:1000 --steps 1,10,inf",
        "An ARX model on unseen rows"}},
      run,
  };
}

}  // namespace wisp::cli
