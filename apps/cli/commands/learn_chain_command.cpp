// `wisp learn chain` and its preset `wisp learn leaf`: a segment chain from recordings of something that moves.

#include <array>
#include <chrono>
#include <filesystem>

#include "commands/commands.hpp"
#include "flags/flag_ranges.hpp"
#include "flags/recordings.hpp"
#include "reports/chain_json.hpp"
#include "reports/chain_recordings.hpp"
#include "reports/figures_json.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/chain.hpp"
#include "wisp/learn/gust_response.hpp"
#include "wisp/learn/motion.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

int number_or_auto(const Arguments& arguments, std::string_view flag) {
  return arguments.text(flag) == "auto" ? 0 : arguments.integer(flag);
}

Result<void> check_flags(const Arguments& arguments) {
  static constexpr std::array kRanges = {
      FlagRange{"modes", 1, 256},      FlagRange{"history", 1, 16},  FlagRange{"best-of", 0, 256},
      FlagRange{"blend", 0, 0.5},      FlagRange{"shortest", 0, 60}, FlagRange{"debounce", 0, 100},
      FlagRange{"smooth", 0, 10001},   FlagRange{"holdout", 0, 0.9}, FlagRange{"restarts", 1, 10000},
      FlagRange{"most-bytes", 1, 1e9},
  };
  return check_ranges(arguments, kRanges);
}

Result<ChainOptions> options_from(const Arguments& arguments) {
  if (auto ok = check_flags(arguments); !ok) return ok.error();
  ChainOptions options;
  options.name = std::filesystem::path(arguments.text("output")).stem().string();
  auto event = parse_event(arguments.text("event"));
  if (!event) return Error{"--event: " + event.error().message};
  auto features = parse_features(arguments.text("features"));
  if (!features) return Error{"--features: " + features.error().message};
  options.segmentation = {.event = std::move(*event),
                          .least_seconds = arguments.number("shortest"),
                          .debounce = arguments.number("debounce")};
  options.features = *features;
  options.features.heading_free = arguments.text("frame") == "heading";
  options.modes = number_or_auto(arguments, "modes");
  options.history = number_or_auto(arguments, "history");
  auto realisation = parse_realisation(arguments.text("realise"));
  if (!realisation) return Error{"--realise: " + realisation.error().message};
  options.realisation = *realisation;
  options.store.breadth = arguments.integer("best-of");
  options.store.most_bytes = static_cast<std::size_t>(arguments.integer("most-bytes"));
  options.blend_share = arguments.number("blend");
  options.holdout = arguments.number("holdout");
  options.restarts = arguments.integer("restarts");
  options.smooth_rows = arguments.integer("smooth");
  options.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  return options;
}

// Full axes of the leaf, where its maker has said them.
Result<void> take_size(const std::vector<Recording>& recordings, ChainOptions& options) {
  const auto size = numbers_attribute(recordings.front(), "leaf_length_width_density");
  if (!size) return size.error();
  if (!*size || (*size)->size() < 2) return {};
  options.half_width = (**size)[0] / 2;
  options.half_length = (**size)[1] / 2;
  if (options.half_width > 0 && options.half_length > 0) return {};
  return Error{recordings.front().source + ": \"# leaf_length_width_density\" begins with " + shown((**size)[0]) + " " +
               shown((**size)[1]) + ", expected a length and a width above 0, in metres"};
}

// What learning says is wrong, with the file that it is about.
Error about(const std::vector<Recording>& recordings, const ChainOptions& options, const Error& error) {
  const std::string& first = recordings.front().source;
  for (const Recording& recording : recordings) {
    if (error.message.starts_with(recording.source)) return error;
  }
  const auto motion = motion_of(recordings, options.smooth_rows);
  const auto cut = motion ? segment(*motion, recordings, options.segmentation) : Result<Segmentation>(motion.error());
  if (cut && static_cast<double>(cut->segments.size()) * (1 - options.holdout) < options.modes) {
    return {first + ": has " + std::to_string(cut->segments.size()) +
            " segments in all, expected at least as many as " + "--modes " + std::to_string(options.modes) +
            " when a share of " + shown(options.holdout) + " is held out: record for longer, or ask for fewer modes"};
  }
  return {first + ": " + error.message};
}

// Falls that repeat each other judge nothing.
void warn_of_repeats(const std::vector<Recording>& falls, ChainFit& fit, Terminal& terminal) {
  const Repeats repeats = repeats_in(falls);
  if (repeats.repeated == 0) return;
  terminal.result()["repeated_episodes"] = repeats.repeated;
  terminal.warn(falls.front().source + ": " + std::to_string(repeats.repeated) + " of " +
                std::to_string(repeats.episodes) +
                " episodes repeat another row by row, expected each once: likeness to what was held out says little");
  if (repeats.episodes - repeats.repeated > 1) return;
  fit.model.training.usable = {
      false, "all " + std::to_string(repeats.episodes) + " episodes are the same: record falls that differ"};
}

// Recordings that differ only in their wind, by the value of `pair` that they share.
struct Sorted {
  std::vector<Recording> falls;
  std::vector<Recording> paired;
};

Sorted sorted(std::vector<Recording> recordings) {
  Sorted out;
  for (Recording& recording : recordings) {
    (find_attribute(recording, "pair") ? out.paired : out.falls).push_back(std::move(recording));
  }
  return out;
}

// The response to gusts, from a windy recording and its calm twin.
Result<void> take_gusts(const std::vector<Recording>& paired, ChainFit& fit, Terminal& terminal) {
  if (paired.empty()) return {};
  if (paired.size() != 2 || *find_attribute(paired[0], "pair") != *find_attribute(paired[1], "pair") ||
      is_calm(paired[0]) == is_calm(paired[1])) {
    return Error{paired.front().source + ": is one of " + std::to_string(paired.size()) +
                 " recordings with the attribute pair, expected two of one pair, one of them calm: give both, "
                 "or neither"};
  }
  const bool first_calm = is_calm(paired[0]);
  auto gusts = learn_gusts(paired[first_calm ? 1 : 0], paired[first_calm ? 0 : 1], {});
  if (!gusts) return gusts.error();
  std::get<ChainModel>(fit.model.dynamics).gust = std::move(gusts->response);
  fit.model.inputs = std::move(gusts->inputs);
  fit.model.training.inputs.assign(fit.model.inputs.size(), {});  // metres a second
  for (const Recording& one : paired)
    fit.model.training.sources.push_back(std::filesystem::path(one.source).filename().string());
  if (const auto sound = check(fit.model); !sound) {
    return Error{paired[first_calm ? 1 : 0].source + ": " + sound.error().message + " from more gusts than its " +
                 std::to_string(gusts->figures.gusts_learned)};
  }
  const GustFigures& figures = gusts->figures;
  terminal.result()["gusts"] = {{"learned", figures.gusts_learned},
                                {"judged", figures.gusts_judged},
                                {"fit_percent", number(figures.fit_percent)},
                                {"velocity_fit_percent", number(figures.velocity_fit_percent)},
                                {"direction_degrees", number(figures.direction_degrees)},
                                {"direction_degrees_mean", number(figures.direction_degrees_mean)}};
  fit.model.training.figures.push_back({"gust_fit_percent", figures.fit_percent});
  fit.model.training.figures.push_back({"gust_direction_degrees", figures.direction_degrees});
  terminal.say("gusts: the mean displacement of " + std::to_string(figures.gusts_judged) + " held-out gusts fits by " +
               shown(figures.fit_percent) + " %, direction within " + shown(figures.direction_degrees) +
               " degrees (median)");
  return {};
}

void report(const ChainFit& fit, Terminal& terminal) {
  const ChainSummary& summary = fit.summary;
  Json& result = terminal.result();
  result["segments"] = summary.segments;
  result["stored"] = summary.stored;
  result["stretches"] = {{"learned", summary.stretches_learned}, {"held_out", summary.stretches_held_out}};
  result["modes"] = summary.modes;
  result["mode_sizes"] = summary.mode_sizes;
  result["history"] = summary.history;
  result["initial"] = json_of(summary.initial);
  result["transitions"] = matrix_json(summary.transitions, summary.modes);
  result["mean_segment_seconds"] = number(summary.mean_segment_seconds);
  result["silhouette"] = number(summary.silhouette);
  result["log_likelihood"] = {{"chosen", number(summary.log_likelihood)},
                              {"0", number(summary.log_likelihood_0)},
                              {"1", number(summary.log_likelihood_1)},
                              {"2", number(summary.log_likelihood_2)}};
  terminal.say(std::to_string(summary.segments) + " segments of " + shown(summary.mean_segment_seconds) + " s in " +
               std::to_string(summary.modes) + " modes, " + std::to_string(summary.stored) +
               " of them stored; histories of up to " + std::to_string(summary.history));
  terminal.say("held-out log-likelihood a segment: " + shown(summary.log_likelihood, 4) + "; without history " +
               shown(summary.log_likelihood_0, 4) + ", order 1 " + shown(summary.log_likelihood_1, 4) + ", order 2 " +
               shown(summary.log_likelihood_2, 4));
  for (int from = 0; from < summary.modes; ++from) {
    std::string row = "  from " + std::to_string(from) + ":";
    for (int to = 0; to < summary.modes; ++to) {
      char cell[16];
      std::snprintf(cell, sizeof cell, " %6.3f",
                    summary.transitions[static_cast<std::size_t>(from * summary.modes + to)]);
      row += cell;
    }
    terminal.say(row);
  }
}

// How like the stretches that were held out, or, where none were, those that were learned from.
void judge(ChainFit& fit, const ChainOptions& options, Terminal& terminal) {
  ChainFidelityOptions judging{
      .segmentation = options.segmentation, .smooth_rows = options.smooth_rows, .seed = options.seed};
  const auto& real = fit.held_out.empty() ? fit.learned : fit.held_out;
  const auto fidelity = chain_fidelity(fit.model, real, judging);
  if (!fidelity) {
    terminal.warn("likeness was not measured: " + fidelity.error().message);
    terminal.result()["fidelity"] = nullptr;
    return;
  }
  const double verbatim = longest_verbatim_seconds(fit.model, fit.origin, 20000, options.seed);
  terminal.result()["fidelity"] = fidelity_json(*fidelity);
  terminal.result()["fidelity"]["verbatim_seconds"] = number(verbatim);
  terminal.result()["join_defect"] = join_defect_json(fidelity->join_defect);
  say_fidelity(*fidelity, terminal);
  terminal.say("longest stretch copied from one recording: " + shown(verbatim) + " s");
  add_figures(*fidelity, fit.model.training);
  fit.model.training.figures.push_back({"verbatim_seconds", verbatim});
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  auto options = options_from(arguments);
  if (!options) return options.error();
  if (auto ok = check_writable(arguments.text("output")); !ok) return ok;
  auto recordings = read_motions(arguments.positionals(), arguments, terminal);
  if (!recordings) return recordings.error();
  const Sorted data = sorted(std::move(*recordings));
  if (data.falls.empty()) {
    return Error{data.paired.front().source + ": is one of a pair, which only tells what wind does; expected " +
                 "recordings of calm falls beside it"};
  }
  if (auto ok = take_size(data.falls, *options); !ok) return ok;
  auto fit = learn_chain(data.falls, *options);
  if (!fit) return about(data.falls, *options, fit.error());
  fit->model.training.program = "wisp " WISP_VERSION;
  for (const std::string& warning : fit->summary.warnings) terminal.warn(warning);
  warn_of_repeats(data.falls, *fit, terminal);
  report(*fit, terminal);
  judge(*fit, *options, terminal);
  if (auto ok = take_gusts(data.paired, *fit, terminal); !ok) return ok;
  const auto cost = cost_of(fit->model);
  if (!cost) return cost.error();
  terminal.result()["cost"] = *cost;
  terminal.result()["usable"] = json_of(fit->model.training.usable);
  terminal.result()["seed"] = options->seed;
  if (auto ok = write_learned(arguments.text("output"), fit->model); !ok) return ok;
  terminal.result()["output"] = arguments.text("output");
  terminal.result()["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Usable& usable = fit->model.training.usable;
  terminal.say(std::string(usable.verdict ? "usable: " : "not usable: ") + usable.reason);
  return {};
}

std::vector<Flag> flags(const std::string& event, const std::string& features) {
  std::vector<Flag> all = {
      {"output", Kind::kPath, "M.wisp", "", "where to write the model", {}, true},
      {"event", Kind::kText, "SPEC", event,
       "where motion is cut: zero:, min: or max: of a channel, or of speed, horizontal_speed, forward_speed"},
      {"features", Kind::kNames, "LIST", features,
       "what tells segments apart: velocity, length, direction, spin, tilt, duration"},
      {"frame",
       Kind::kChoice,
       "world|heading",
       "heading",
       "whether directions are the world's, or a segment's own, so that the chain does not learn which way was north",
       {"world", "heading"}},
      {"modes", Kind::kIntegerOrWord, "K|auto", "6", "how many kinds of segment", {"auto"}},
      {"history",
       Kind::kIntegerOrWord,
       "H|auto",
       "auto",
       "how many modes back the next one depends on; auto: as many as unseen recordings profit from",
       {"auto"}},
      {"realise",
       Kind::kChoice,
       "HOW",
       "segments",
       "how a mode is played: by its segments; as a spline that varies as they do; as a linear system with noise, or a "
       "differential equation (ode), of its velocities; or as a chain of its own",
       {"segments", "spline", "linear", "ode", "chain"}},
      {"best-of", Kind::kInteger, "N", "4",
       "a segment is followed by one of its N best-joining ones of the mode; 0: by any of the mode"},
      {"blend", Kind::kNumber, "SHARE", "0.5", "most of a segment that a join fades over, 0 to 0.5; 0: not at all"},
      {"shortest", Kind::kNumber, "S", "0.04", "seconds; events nearer to the one before do not count"},
      {"debounce", Kind::kNumber, "D", "0.1",
       "standard deviations that the signal must move beyond an event on both sides"},
      {"smooth", Kind::kInteger, "ROWS", "0", "rows that velocities are taken over, where positions are noisy"},
      {"most-bytes", Kind::kInteger, "N", "850000", "of stored segments; what is more is left out at random"},
      {"holdout", Kind::kNumber, "SHARE", "0.2", "share of the stretches kept for judging"},
      {"restarts", Kind::kInteger, "N", "10", "starts of the clustering; the best is taken"},
      {"seed", Kind::kInteger, "N", "1", "of all chance"},
      {"inputs", Kind::kNames, "A,B", "", "columns of a plain table that are inputs"},
      {"outputs", Kind::kNames, "C,D", "", "columns of a plain table that are outputs"},
  };
  for (Flag& flag : recording_flags()) all.push_back(std::move(flag));
  return all;
}

constexpr const char* kRecordings =
    "recordings with pos.x, pos.y, pos.z (metres, z up) and, where known, q.w, q.x, q.y, q.z; two that share the "
    "attribute pair, one windy and one calm, teach the response to gusts";

}  // namespace

Command learn_chain_command() {
  return {
      "learn chain",
      "Learns a chain of segments from recordings of something that moves: cut at events, sorted into modes, counted.",
      {{"REC", kRecordings, true}},
      flags("min:horizontal_speed", "velocity,length,direction"),
      {{"wisp learn chain falls.csv -o disc.wisp --event min:horizontal_speed --smooth 7",
        "Tracks of falling paper: positions only"}},
      run,
  };
}

Command learn_leaf_command() {
  return {
      "learn leaf",
      "Learns how a leaf falls: `learn chain`, cut where the leaf stalls.",
      {{"REC", kRecordings, true}},
      flags("zero:forward_speed", "velocity,length,direction"),
      {{"wisp learn leaf drops.csv -o leaf.wisp", "From `wisp simulate leaf`"},
       {"wisp learn leaf drops.csv gusts.csv gusts.calm.csv -o leaf.wisp",
        "The same with its response to gusts, from `wisp simulate leaf --pairs`"},
       {"wisp learn leaf drops.csv -o paper.wisp --history 1 --best-of 0 --blend 0", "The paper's own chain"}},
      run,
  };
}

}  // namespace wisp::cli
