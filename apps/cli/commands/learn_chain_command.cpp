// `wisp learn chain` and its preset `wisp learn leaf`: a segment chain from recordings of something that moves.

#include <array>
#include <chrono>
#include <filesystem>

#include "commands/commands.hpp"
#include "flags/flag_ranges.hpp"
#include "flags/motion_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {
namespace {

int number_or_auto(const Arguments& arguments, std::string_view flag) {
  return arguments.text(flag) == "auto" ? 0 : arguments.integer(flag);
}

Result<void> check_flags(const Arguments& arguments) {
  static constexpr std::array kRanges = {
      FlagRange{"modes", 1, 64},     FlagRange{"history", 1, 2},   FlagRange{"best-of", 0, 256},
      FlagRange{"blend", 0, 0.5},    FlagRange{"shortest", 0, 60}, FlagRange{"debounce", 0, 100},
      FlagRange{"smooth", 0, 10001}, FlagRange{"holdout", 0, 0.9}, FlagRange{"max-bytes", 1, 1e9},
  };
  return check_ranges(arguments, kRanges);
}

Result<ChainRecipe> recipe_from(const Arguments& arguments) {
  if (auto ok = check_flags(arguments); !ok) return ok.error();
  auto event = parse_event(arguments.text("event"));
  if (!event) return Error{"--event: " + event.error().message};
  auto realisation = parse_realisation(arguments.text("realisation"));
  if (!realisation) return Error{"--realisation: " + realisation.error().message};
  return ChainRecipe{.name = model_name(arguments),
                     .event = std::move(*event),
                     .heading_free = arguments.text("frame") == "heading",
                     .modes = number_or_auto(arguments, "modes"),
                     .history = arguments.integer("history"),
                     .realisation = *realisation,
                     .best_of = arguments.integer("best-of"),
                     .blend = arguments.number("blend"),
                     .min_seconds = arguments.number("shortest"),
                     .debounce = arguments.number("debounce"),
                     .smooth_rows = arguments.integer("smooth"),
                     .max_bytes = static_cast<std::size_t>(arguments.integer("max-bytes")),
                     .holdout = arguments.number("holdout"),
                     .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
}

// The rows of --range of falls; a pair stays whole, since its gusts have as many clones each.
Result<std::vector<Recording>> falls_in_range(std::vector<Recording> recordings, const Arguments& arguments) {
  for (Recording& recording : recordings) {
    if (find_attribute(recording, "pair")) continue;
    auto part = in_range(std::move(recording), arguments, "range");
    if (!part) return part.error();
    recording = std::move(*part);
  }
  return recordings;
}

// With --skip-bad, recordings that tell no motion are left out here; else learning says what is wrong with them.
Result<std::vector<Recording>> read_motions(const Arguments& arguments, Terminal& terminal) {
  auto recordings = read_tables(arguments.positionals(), arguments, terminal, motion_table(arguments));
  if (!recordings || !arguments.on("skip-bad")) return recordings;
  std::erase_if(*recordings, [&](const Recording& recording) {
    const auto sound = check_motion(recording);
    return !sound && leave_out(recording.source, sound.error(), arguments, terminal);
  });
  if (recordings->empty()) return Error{arguments.positionals().front() + ": none of the recordings can be used"};
  return recordings;
}

Result<void> run_learn_chain(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto recipe = recipe_from(arguments);
  if (!recipe) return recipe.error();
  const std::string output = model_path(arguments);
  if (auto ok = check_writable(output); !ok) return ok;
  auto read = read_motions(arguments, terminal);
  if (!read) return read.error();
  const auto recordings = falls_in_range(std::move(*read), arguments);
  if (!recordings) return recordings.error();
  const auto fit = learn(*recordings, *recipe, terminal.progress());
  if (!fit) return fit.error();
  return hand_over(*fit, output, start, terminal);
}

std::vector<Flag> flags(const std::string& event) {
  std::vector<Flag> all = {
      output_flag(),
      {"event", Kind::kText, "SPEC", event,
       "where motion is cut: zero:, min: or max: of a channel, or of speed, horizontal_speed, forward_speed"},
      {"frame",
       Kind::kChoice,
       "world|heading",
       "heading",
       "whether directions are the world's, or a segment's own, so that the chain does not learn which way was north",
       {"world", "heading"}},
      {"modes",
       Kind::kIntegerOrWord,
       "K|auto",
       "auto",
       "kinds of segment, one of the next of which follows; auto: none, or 6 where there is no orientation",
       {"auto"}},
      {"history", Kind::kInteger, "H", "1", "how many kinds back the next one depends on, 1 or 2"},
      {"realisation",
       Kind::kChoice,
       "HOW",
       "segments",
       "what segments are: recorded ones; splines that vary as those of their kind do; made by a linear system with "
       "noise, "
       "or by a differential equation (ode), of each kind; or halves, each kind a chain of its own",
       {"segments", "spline", "linear", "ode", "chain"}},
      {"best-of", Kind::kInteger, "N", "4",
       "where orientation is known a segment is followed by one of its N best-joining ones; 0: by any, of the next "
       "kind"},
      {"blend", Kind::kNumber, "S", "0.15",
       "most seconds on either side that a join is spread over, 0 to 0.5; 0: joins stay as they are"},
      {"shortest", Kind::kNumber, "S", "0.04", "seconds; events nearer to the one before do not count"},
      {"debounce", Kind::kNumber, "D", "0.1",
       "standard deviations that the signal must move beyond an event on both sides"},
      {"smooth", Kind::kInteger, "ROWS", "0", "rows that velocities are taken over, where positions are noisy"},
      {"max-bytes", Kind::kInteger, "N", "4000000",
       "of stored segments; of what is more, evenly by dive, speed and turn, some are left out"},
      {"holdout", Kind::kNumber, "SHARE", "0.2", "share of the stretches kept for judging"},
      {"seed", Kind::kInteger, "N", "1", "of all chance"},
      {"range", Kind::kSamples, "A:B", "", "rows to learn falls from, 1-based and inclusive"},
      {"inputs", Kind::kNames, "A,B", "", "columns of a plain table that are inputs"},
      {"outputs", Kind::kNames, "C,D", "", "columns of a plain table that are outputs"},
  };
  for (Flag& flag : motion_flags()) all.push_back(std::move(flag));
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
      flags("min:horizontal_speed"),
      {{"wisp learn chain falls.csv -o disc.wisp --event min:horizontal_speed --smooth 7",
        "Tracks of falling paper: positions only"}},
      run_learn_chain,
  };
}

Command learn_leaf_command() {
  return {
      "learn leaf",
      "Learns how a leaf falls: `learn chain`, cut where the leaf stalls.",
      {{"REC", kRecordings, true}},
      flags("zero:forward_speed"),
      {{"wisp learn leaf drops.csv -o leaf.wisp", "From `wisp simulate leaf`"},
       {"wisp learn leaf drops.csv gusts.csv gusts.calm.csv -o leaf.wisp",
        "The same with its response to gusts, from `wisp simulate leaf --pairs`"},
       {"wisp learn leaf drops.csv -o paper.wisp --modes 6 --best-of 0 --blend 0", "The paper's own chain"}},
      run_learn_chain,
  };
}

}  // namespace wisp::cli
