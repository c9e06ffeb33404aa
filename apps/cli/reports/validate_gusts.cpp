#include "reports/validate_gusts.hpp"

#include <filesystem>

#include "flags/recordings.hpp"
#include "reports/chain_recordings.hpp"
#include "reports/gust_figures.hpp"
#include "wisp/learn/gust_play.hpp"

namespace wisp::cli {
namespace {

// The recording that differs only in its wind.
Result<Recording> twin_of(const Recording& recording, const Arguments& arguments) {
  if (arguments.positionals().size() > 2) return read_table(arguments.positionals()[2], arguments);
  const std::filesystem::path own = arguments.positionals()[1];
  const auto beside = std::filesystem::path(own).replace_extension(".calm.csv");
  if (std::filesystem::exists(beside)) return read_table(beside.string(), arguments);
  return Error{recording.source + ": is one of a pair, and there is no " + beside.string() +
               ", expected its twin as a third argument"};
}

Json direction_json(const GustDirection& direction) {
  return {{"median", number(direction.median)},
          {"mean", number(direction.mean)},
          {"mean_clear", number(direction.mean_clear)}};
}

Json json_of(const GustPlayFigures& found) {
  return {{"gusts", found.gusts},
          {"clear_gusts", found.clear_gusts},
          {"clones", found.clones},
          {"fit_percent", number(found.fit_percent)},
          {"velocity_fit_percent", number(found.velocity_fit_percent)},
          {"direction_degrees", direction_json(found.direction)},
          {"halves",
           {{"fit_percent", number(found.halves_fit_percent)},
            {"direction_degrees", direction_json(found.halves_direction)}}},
          {"largest_displacement", number(found.largest_displacement)},
          {"largest_recorded_displacement", number(found.largest_recorded_displacement)},
          {"left_after", number(found.left_after)},
          {"diverges", found.diverges}};
}

void say(const GustPlayFigures& found, Terminal& terminal) {
  terminal.say(std::to_string(found.gusts) + " gusts of " + std::to_string(found.clones) +
               " clones, played by the model from where each calm fall is at the onset:");
  terminal.say("  mean displacement fits by " + shown(found.fit_percent) + " % (half the clones against the others " +
               shown(found.halves_fit_percent) + " %), velocity by " + shown(found.velocity_fit_percent) + " %");
  terminal.say("  direction off by " + shown(found.direction.mean_clear) + " degrees over the " +
               std::to_string(found.clear_gusts) + " gusts whose displacement stands out of chance (halves " +
               shown(found.halves_direction.mean_clear) + "); " + shown(found.direction.median) +
               " in the median and " + shown(found.direction.mean) + " on average over all");
  terminal.say("  carried at most " + shown(found.largest_displacement) + " m (recorded " +
               shown(found.largest_recorded_displacement) + " m); " +
               (found.diverges ? "it DIVERGES: " : "it never diverges: ") + shown(found.left_after) +
               " m/s are left after two seconds");
}

}  // namespace

Result<void> validate_gusts(const Model& model, Recording recording, const Arguments& arguments, Terminal& terminal) {
  auto twin = twin_of(recording, arguments);
  if (!twin) return twin.error();
  for (const Recording* one : {&recording, &*twin}) {
    if (auto ok = check_paired(*one); !ok) return ok;
  }
  const auto pair = find_attribute(recording, "pair"), twins = find_attribute(*twin, "pair");
  if (pair != twins || is_calm(recording) == is_calm(*twin)) {
    return Error{twin->source + ": is no twin of " + recording.source +
                 ", expected the same value of the attribute pair in both, and wind in one of them only"};
  }
  const bool calm_first = is_calm(recording);
  const auto play = play_gusts(model, calm_first ? *twin : recording, calm_first ? recording : *twin,
                               {.seed = static_cast<std::uint64_t>(arguments.integer("seed"))});
  if (!play) return play.error();
  terminal.result()["rows"] = recording.rows();
  terminal.result()["channels"] = Json::array();
  terminal.result()["fidelity"] = nullptr;  // clones are no falls of their own
  terminal.result()["gusts"] = json_of(play->figures);
  say(play->figures, terminal);
  if (!arguments.has("figures") || play->scenes.empty()) return {};
  if (auto ok = write_gust_figure(arguments.text("figures"), play->scenes); !ok) return ok;
  terminal.say("wrote figures to " + arguments.text("figures"));
  return {};
}

}  // namespace wisp::cli
