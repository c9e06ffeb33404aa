#include "reports/outline_learning.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "flags/capture_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/curve_learning.hpp"
#include "reports/figures_json.hpp"

namespace wisp::cli {
namespace {

Json cost_json(const Cost& cost) {
  return {{"multiply_adds_per_frame", cost.multiply_adds_per_frame},
          {"operations_per_frame", cost.operations_per_frame}};
}

Json channels_json(const OutlineFit& fit) {
  Json channels = Json::array();
  const OutlineSummary& summary = fit.summary;
  for (std::size_t k = 0; k < fit.model.outputs.size(); ++k) {
    const OutlineResidual& residual = summary.residuals[k];
    Json channel = {{"name", fit.model.outputs[k].name},
                    {"residual_sd", number(residual.sd)},
                    {"residual_sd_ci95", {number(residual.sd_ci95[0]), number(residual.sd_ci95[1])}},
                    {"fit_percent", by_steps(summary.learned.steps, summary.learned.channels[k].fit_percent)}};
    channel["held_out_fit_percent"] =
        summary.held_out ? by_steps(summary.held_out->steps, summary.held_out->channels[k].fit_percent) : Json(nullptr);
    channels.push_back(std::move(channel));
  }
  return channels;
}

std::optional<int> number_unless_auto(const Arguments& arguments, std::string_view flag) {
  if (arguments.text(flag) == "auto") return std::nullopt;
  return arguments.integer(flag);
}

const char* criterion_name(OutlineCriterion by) {
  switch (by) {
    case OutlineCriterion::kGiven:
      return "given";
    case OutlineCriterion::kFpe:
      return "fpe";
    case OutlineCriterion::kHeldOutStep:
      return "held_out_step";
    case OutlineCriterion::kHeldOutFreeRun:
      return "held_out_free_run";
  }
  return "";
}

Json choice_json(const OutlineChoice& choice) {
  Json json = {{"order", choice.taken().order},
               {"delay", choice.taken().delay},
               {"by", criterion_name(choice.by)},
               {"reason", choice.reason},
               {"candidates", Json::array()}};
  if (choice.by == OutlineCriterion::kGiven) return json;
  for (const OutlineCandidate& one : choice.candidates) {
    json["candidates"].push_back(
        {{"order", one.order}, {"delay", one.delay}, {"fpe", number(one.fpe)}, {"error", number(one.error)}});
  }
  return json;
}

Json j_json(const OutlineFigures& figures) {
  Json j = Json::object();
  for (std::size_t k = 0; k < figures.steps.size(); ++k) {
    const std::string name = figures.steps[k] == kFreeRun ? "inf" : std::to_string(figures.steps[k]);
    j[name] = json_of(figures.j[k]);
  }
  return j;
}

void describe(const OutlineFit& fit, Terminal& terminal) {
  const OutlineSummary& summary = fit.summary;
  const OutlineFigures& judged = summary.held_out ? *summary.held_out : summary.learned;
  std::string inputs;
  for (const OutlineInput& input : summary.inputs) inputs += (inputs.empty() ? "" : ", ") + input.name;
  terminal.say(std::to_string(summary.points) + " control points at " + shown(summary.rate_hz, 5) +
               " frames a second, inputs: " + (inputs.empty() ? "none (a flicker model)" : inputs));
  terminal.say("learned from " + std::to_string(summary.rows_learned) + " frames, " +
               std::to_string(summary.rows_held_out) + " held out");
  if (summary.choice.by != OutlineCriterion::kGiven) terminal.say(summary.choice.reason);
  for (const InputAlignment& one : summary.alignment) terminal.say(one.note());
  terminal.say(std::string(summary.held_out ? "held out" : "learned") + ", one step ahead: tip fit " +
               shown(at_steps(judged, judged.tip_fit_percent, 1)) + " %, outline overlap " +
               shown(at_steps(judged, judged.overlap, 1)) +
               "; five steps: " + shown(at_steps(judged, judged.tip_fit_percent, 5)) + " %");
  if (!summary.inputs.empty()) {
    terminal.say("free simulation from the input alone: tip fit " +
                 shown(at_steps(judged, judged.tip_fit_percent, kFreeRun)) + " %, outline overlap " +
                 shown(at_steps(judged, judged.overlap, kFreeRun)));
  }
  if (!summary.curve_choice.reason.empty()) terminal.say(summary.curve_choice.reason);
  for (std::size_t k = 0; k < summary.curves.size(); ++k) {
    terminal.say("curve of " + summary.inputs[k].name + ": " + curve_text(summary.curves[k].curve));
  }
  terminal.say("spectral radius " + shown(summary.stable.radius, 4) + (summary.stable.changed ? " (made stable)" : "") +
               ", held at its range in " + shown(100 * summary.held_share, 2) + " % of steps");
  terminal.say("cost " + std::to_string(summary.cost.multiply_adds_per_frame) + " multiply-adds a frame; " +
               std::to_string(summary.cost.operations_per_frame) + " operations with noise and outline");
  terminal.say(std::string(summary.usable.verdict ? "usable: " : "not usable: ") + summary.usable.reason);
}

}  // namespace

Json by_steps(const std::vector<int>& steps, const std::vector<double>& values) {
  Json out = Json::object();
  for (std::size_t k = 0; k < steps.size() && k < values.size(); ++k) {
    out[steps[k] == kFreeRun ? "inf" : std::to_string(steps[k])] = number(values[k]);
  }
  return out;
}

std::vector<double> mean_per_step(const std::vector<std::vector<double>>& per_step) {
  std::vector<double> means;
  for (const auto& values : per_step) {
    double sum = 0;
    for (double value : values) sum += value;
    means.push_back(values.empty() ? 0 : sum / static_cast<double>(values.size()));
  }
  return means;
}

double at_steps(const OutlineFigures& figures, const std::vector<double>& values, int steps) {
  for (std::size_t k = 0; k < figures.steps.size() && k < values.size(); ++k) {
    if (figures.steps[k] == steps) return values[k];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Flag align_flag() {
  return {"align",
          Kind::kChoice,
          "A",
          "auto",
          "auto: an input that comes after the motion that it causes is moved; off: as recorded",
          {"auto", "off"}};
}

std::vector<Flag> outline_flags() {
  return {
      {"order",
       Kind::kIntegerOrWord,
       "N|auto",
       "0",
       "lags of outputs and inputs in every equation; 0: 3 where residuals are drawn, else 4; auto searches 1 to 32 on "
       "what is held out",
       {"auto"}},
      {"delay",
       Kind::kIntegerOrWord,
       "N|auto",
       "0",
       "frames until an input acts; auto searches up to a quarter of a second",
       {"auto"}},
      align_flag(),
      {"gain",
       Kind::kChoice,
       "G",
       "auto",
       "the winds of several recordings on one scale, as one microphone hears them (one), each on its own (own), or as "
       "held-out data say (auto)",
       {"auto", "one", "own"}},
      {"coupling",
       Kind::kChoice,
       "C",
       "auto",
       "what feeds each other: nothing (coordinate), a point's two coordinates, neighbouring points, all points; auto: "
       "coordinate where residuals are drawn, else point",
       {"auto", "coordinate", "point", "band", "full"}},
      {"one-sided", Kind::kSwitch, "", "", "inputs as they are: no sign, no mirror image"},
      {"holdout", Kind::kNumber, "SHARE", "0.3", "the last part of each recording, kept for judging"},
      {"noise",
       Kind::kChoice,
       "N",
       "auto",
       "what shakes the outline: independent (each channel by itself), residual or matched (shared shocks), drawn (the "
       "residuals themselves, played again where the input is as it was); auto: drawn from 10 s on with an input, else "
       "matched",
       {"auto", "independent", "residual", "matched", "drawn"}},
      {"seed", Kind::kInteger, "N", "1", "of the trial runs"},
      {"skip-bad", Kind::kSwitch, "", "", "leave bad recordings out, listing them, instead of stopping at the first"},
  };
}

std::optional<bool> wanted_gain(const Arguments& arguments) {
  if (arguments.text("gain") == "auto") return std::nullopt;
  return arguments.text("gain") == "one";
}

void report_gain(const WindGain& gain, Terminal& terminal) {
  terminal.result()["gain"] = nullptr;
  if (gain.factors.empty()) return;
  terminal.result()["gain"] = {{"one", gain.one},
                               {"factors", gain.factors},
                               {"held_out_error", {{"one", number(gain.one_error)}, {"own", number(gain.own_error)}}},
                               {"reason", gain.reason}};
  terminal.say(gain.reason);
}

Json alignment_json(const std::vector<InputAlignment>& alignment) {
  Json json = Json::array();
  for (const InputAlignment& one : alignment) {
    json.push_back({{"recording", one.source},
                    {"input", one.input},
                    {"motion", one.motion},
                    {"offset_seconds", number(one.found.offset_seconds)},
                    {"offset_ci95", {number(one.found.low_seconds), number(one.found.high_seconds)}},
                    {"usable", one.found.usable},
                    {"reason", one.found.reason},
                    {"frames_moved", one.frames_moved}});
  }
  return json;
}

Result<OutlineOptions> outline_options(const Arguments& arguments, std::string name) {
  OutlineOptions options;
  options.order = number_unless_auto(arguments, "order");
  options.delay = number_unless_auto(arguments, "delay");
  options.align = arguments.text("align") == "auto";
  const std::string& coupling = arguments.text("coupling");
  if (coupling == "coordinate") options.coupling = OutlineCoupling::kCoordinate;
  if (coupling == "point") options.coupling = OutlineCoupling::kPoint;
  if (coupling == "band") options.coupling = OutlineCoupling::kBand;
  if (coupling == "full") options.coupling = OutlineCoupling::kFull;
  const std::string& noise = arguments.text("noise");
  if (noise == "independent") options.noise = OutlineNoise::kIndependent;
  if (noise == "residual") options.noise = OutlineNoise::kResidual;
  if (noise == "matched") options.noise = OutlineNoise::kMatched;
  if (noise == "drawn") options.noise = OutlineNoise::kDrawn;
  options.one_sided = arguments.on("one-sided");
  options.input_curve = curve_knots_of(arguments);
  options.holdout = arguments.number("holdout");
  options.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  options.name = std::move(name);
  return options;
}

Result<std::vector<Recording>> outline_recordings(const std::vector<std::string>& paths, const Arguments& arguments,
                                                  Terminal& terminal) {
  std::vector<Recording> recordings;
  SharedCurve curve;
  for (const std::string& path : paths) {
    auto recording = [&]() -> Result<Recording> {
      if (is_table(path)) return read_table(path, arguments);
      // Clips that are learned from together need one kind of curve: that of the first.
      auto clip = capture_clip(path, arguments, terminal, curve);
      if (!clip) return clip.error();
      for (const std::string& warning : clip->report.warnings) terminal.warn(path + ": " + warning);
      if (!clip->wind_heard && !std::filesystem::is_directory(path)) {
        terminal.warn(path + ": wind " + clip->wind_note + "; without it only flicker can be learned");
      }
      return std::move(clip->recording);
    }();
    if (recording) {
      if (curve.knots.empty()) {
        const auto layout = outline_layout(*recording);
        if (layout) curve = {layout->knots, follows_underside(*recording)};
      }
      recordings.push_back(std::move(*recording));
    } else if (arguments.on("skip-bad")) {
      terminal.warn("left out: " + recording.error().message);
      terminal.result()["skipped"].push_back({{"file", path}, {"reason", recording.error().message}});
    } else {
      return recording.error();
    }
  }
  if (recordings.empty()) return Error{"none of the recordings can be used"};
  return recordings;
}

void report_outline(const OutlineFit& fit, Terminal& terminal) {
  const OutlineSummary& summary = fit.summary;
  const OutlineFigures& judged = summary.held_out ? *summary.held_out : summary.learned;
  Json& result = terminal.result();
  result["rate_hz"] = number(summary.rate_hz);
  result["inputs"] = Json::array();
  for (const OutlineInput& input : summary.inputs) {
    result["inputs"].push_back({{"name", input.name}, {"unit", input.unit}, {"scale", number(input.scale)}});
  }
  result["points"] = summary.points;
  result["na"] = json_of(summary.orders.na);
  result["nb"] = json_of(summary.orders.nb);
  result["nk"] = json_of(summary.orders.nk);
  result["order_and_delay"] = choice_json(summary.choice);
  result["alignment"] = alignment_json(summary.alignment);
  std::vector<std::string> names;
  for (const OutlineInput& input : summary.inputs) names.push_back(input.name);
  result["input_curve"] = curve_json(summary.curve_choice, names, summary.curves);
  result["samples"] = {{"learned", summary.rows_learned}, {"held_out", summary.rows_held_out}};
  result["channels"] = channels_json(fit);
  result["J"] = by_steps(judged.steps, mean_per_step(judged.j));
  result["J_per_point"] = j_json(judged);
  result["tip"] = {
      {"fit_percent", by_steps(summary.learned.steps, summary.learned.tip_fit_percent)},
      {"held_out_fit_percent",
       summary.held_out ? by_steps(summary.held_out->steps, summary.held_out->tip_fit_percent) : Json(nullptr)}};
  result["overlap"] = number(at_steps(judged, judged.overlap, kFreeRun));
  result["overlap_by_steps"] = by_steps(judged.steps, judged.overlap);
  result["fpe"] = number(summary.fpe);
  result["stable"] = json_of(summary.stable);
  result["held_share"] = number(summary.held_share);
  result["cost"] = cost_json(summary.cost);
  result["usable"] = json_of(summary.usable);
  describe(fit, terminal);
}

}  // namespace wisp::cli
