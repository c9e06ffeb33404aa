// `wisp validate`: a model judged on a recording or a clip.

#include <algorithm>
#include <optional>

#include "commands/commands.hpp"
#include "films/validation_pictures.hpp"
#include "flags/capture_flags.hpp"
#include "flags/motion_flags.hpp"
#include "flags/outline_flags.hpp"
#include "flags/recordings.hpp"
#include "flags/steps_flag.hpp"
#include "reports/arx_validation.hpp"
#include "reports/validate_chain.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

Result<ValidationSubject> subject_of(const std::string& path, const Model& model, const Arguments& arguments,
                                     Terminal& terminal) {
  ValidationSubject subject;
  if (is_table(path)) {
    auto recording = read_table(path, arguments);
    if (!recording) return recording.error();
    subject.recording = std::move(*recording);
    if (arguments.has("clip")) subject.clip.path = arguments.text("clip");
  } else {
    auto options = capture_options(arguments);
    if (!options) return options.error();
    const auto curve = curve_of(model);
    if (!curve) return curve.error();
    options->curve = *curve;
    auto clip = capture(path, *options, terminal.progress());
    if (!clip) return clip.error();
    for (const std::string& warning : clip->report.warnings) terminal.warn(warning);
    subject.recording = std::move(clip->recording);
    subject.captured = std::move(clip->report);
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

ValidationPictures wanted_pictures(const Arguments& arguments) {
  const auto path = [&](const char* flag) { return arguments.has(flag) ? arguments.text(flag) : std::string(); };
  return {path("overlay"), path("film-strip"), path("figures")};
}

Result<void> run_validate(const Arguments& arguments, Terminal& terminal) {
  const auto& positionals = arguments.positionals();
  const auto model = read_model(positionals[0]);
  if (!model) return model.error();
  const auto steps = steps_in(arguments);
  if (!steps) return steps.error();
  if (std::holds_alternative<ChainModel>(model->dynamics)) return validate_chain(*model, arguments, terminal);
  if (!std::holds_alternative<OutlineView>(model->view)) return validate_plain(*model, *steps, arguments, terminal);
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
      align_flag(),
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
    if (flag.name != "points") flags.push_back(std::move(flag));  // the model says how many
  }
  return {
      "validate",
      "Judges a model on a recording: prediction, free simulation, fidelity, pictures.",
      {{"MODEL", "the model, a .wisp file"},
       {"REC_OR_CLIP",
        "a recording (.csv), or a clip; of a plain ARX model several recordings; of a segment chain a recording and "
        "its "
        "twin that differs only in its wind, where REC.calm.csv beside REC.csv is found by itself",
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
