// `wisp simulate leaf`: simulates falls of one leaf as a recording, or as two: in gusts, and the same falls without.

#include <array>
#include <cmath>
#include <filesystem>

#include "commands/commands.hpp"
#include "films/leaf_film.hpp"
#include "terminal.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp::cli {
namespace {

constexpr double kMinPairSeconds = 0.7;  // minimum --seconds with --pairs: gusts begin at 0.5 s ± 20 %
constexpr double kMaxJitter = 0.01;      // maximum deviation of a time step, as a share of the step

// Checks that a wind's time column, if there is one, has equal steps, as rows are taken at the recording's rate.
Result<void> check_time(const Recording& recording) {
  const double step = 1 / recording.rate_hz;
  for (const char* name : kTimeColumns) {
    const auto channel = find_channel(recording, name);
    if (!channel) continue;
    const auto& time = recording.channels[*channel].samples;
    for (std::size_t row = 1; row < time.size(); ++row) {
      const double found = time[row] - time[row - 1];
      if (std::abs(found - step) <= kMaxJitter * step) continue;
      return Error{recording.source + ": " + name + " goes on by " + shown(found) + " s in row " +
                   std::to_string(row + 1) + ", expected " + shown(step) +
                   " everywhere, as rate_hz says: sort and resample the wind"};
    }
  }
  return {};
}

// Reads wind from a recording: channels wind.x, wind.y and wind.z (a missing one is 0), or its only input, along x.
Result<MeasuredWind> track_from(const std::string& path) {
  const auto recording = read_csv(path, {});
  if (!recording) return recording.error();
  if (auto good = check_time(*recording); !good) return good.error();
  MeasuredWind track{.rows = std::vector<std::array<double, 3>>(recording->rows()), .rate_hz = recording->rate_hz};
  const auto take = [&](std::size_t channel, std::size_t axis) -> Result<void> {
    const auto& samples = recording->channels[channel].samples;
    for (std::size_t row = 0; row < samples.size(); ++row) {
      if (!(std::abs(samples[row]) <= 30)) {
        return Error{path + ": " + recording->channels[channel].name + " in row " + std::to_string(row + 1) + " is " +
                     (std::isnan(samples[row]) ? "missing" : shown(samples[row])) +
                     ", expected a wind within 30 m/s and no sample missing"};
      }
      track.rows[row][axis] = samples[row];
    }
    return {};
  };
  bool found = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto channel = find_channel(*recording, std::array{"wind.x", "wind.y", "wind.z"}[axis]);
    if (!channel) continue;
    found = true;
    if (auto good = take(*channel, axis); !good) return good.error();
  }
  if (found) return track;
  const auto inputs = channels_with_role(*recording, Role::kInput);
  if (inputs.size() != 1) {
    return Error{path + ": has " + std::to_string(inputs.size()) +
                 " inputs and no wind.x, wind.y or wind.z, expected one of these or a single input, in m/s"};
  }
  if (auto good = take(inputs.front(), 0); !good) return good.error();
  return track;
}

Result<void> take_wind(const Arguments& arguments, LeafDropsOptions& drops) {
  const std::string& word = arguments.text("wind");
  drops.gusts = word == "gusts";
  if (word == "calm" || word == "gusts") return {};
  if (std::filesystem::path(word).extension() != ".csv") {
    return Error{"--wind is " + word + ", expected calm, gusts or a recording, FILE.csv"};
  }
  if (arguments.on("pairs")) return Error{"--wind " + word + ": --pairs makes gusts of its own, give one of the two"};
  auto track = track_from(word);
  if (!track) return track.error();
  drops.track = std::move(*track);
  return {};
}

Result<LeafPairsOptions> options_from(const Arguments& arguments, Terminal& terminal) {
  LeafPairsOptions options;
  LeafDropsOptions& drops = options.drops;
  if (auto good = take_wind(arguments, drops); !good) return good.error();
  if (arguments.on("pairs") && arguments.number("seconds") < kMinPairSeconds) {
    return Error{"--seconds is " + arguments.text("seconds") + ", expected at least " + shown(kMinPairSeconds) +
                 " with --pairs: gusts begin half a second after the recording"};
  }
  drops.drops = arguments.integer("drops");
  drops.seconds = arguments.number("seconds");
  drops.rate_hz = arguments.number("rate");
  drops.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  drops.on_progress = [&terminal](double share) { terminal.progress("falling", share); };
  return options;
}

// Returns the path of the recording of calm air: REC.calm.csv for REC.csv.
std::filesystem::path calm_path(std::filesystem::path path) { return path.replace_extension(".calm.csv"); }

// Simulates falls in gusts, and writes the same falls in calm air beside `path`.
Result<Recording> windy_half(const std::filesystem::path& path, const LeafPairsOptions& options, Terminal& terminal) {
  auto pairs = simulate_leaf_pairs(options);
  if (!pairs) return pairs.error();
  if (auto good = write_csv(calm_path(path), pairs->calm); !good) return good.error();
  terminal.add("calm", calm_path(path).string());
  terminal.add("clones", options.clones);
  return std::move(pairs->windy);
}

Result<void> run_simulate_leaf(const Arguments& arguments, Terminal& terminal) {
  const auto found = options_from(arguments, terminal);
  if (!found) return found.error();
  const LeafPairsOptions& options = *found;
  const std::filesystem::path path = arguments.text("output");
  if (path.extension() != ".csv")
    return Error{path.string() + ": cannot be written, expected a name that ends in .csv"};
  if (arguments.has("video"))
    if (auto good = check_film_name(arguments.text("video")); !good) return good;
  const bool pairs = arguments.on("pairs");
  const auto recording = pairs ? windy_half(path, options, terminal) : simulate_leaf_drops(options.drops);
  if (!recording) return recording.error();
  if (auto good = write_csv(path, *recording); !good) return good;
  if (arguments.has("video")) {
    LeafFilmOptions film;
    film.style.length = static_cast<float>(options.drops.leaf.length);
    film.style.width = static_cast<float>(options.drops.leaf.width);
    if (auto good = write_leaf_film(arguments.text("video"), *recording, film, terminal); !good) return good;
    terminal.add("video", arguments.text("video"));
  }
  const double seconds = terminal.seconds();
  terminal.add("episodes", episodes(*recording).size());
  terminal.add("rows", recording->rows());
  terminal.add("rate_hz", recording->rate_hz);
  terminal.add("seed", options.drops.seed);
  terminal.add("output", path.string());
  terminal.add("seconds", seconds);
  terminal.say("wrote " + path.string() + (pairs ? " and " + calm_path(path).string() : "") + ": " +
               std::to_string(episodes(*recording).size()) + " episodes, " + std::to_string(recording->rows()) +
               " rows, seed " + std::to_string(options.drops.seed) + ", in " + shown(seconds) + " s");
  return {};
}

}  // namespace

Command simulate_leaf_command() {
  return {
      "simulate leaf",
      "Simulates falls of one leaf from random starts: a recording of its pose, one episode a drop.",
      {},
      {
          {"output", Kind::kOutput, "REC.csv", "", "where to write the recording", {}, true},
          ranged({"drops", Kind::kInteger, "N", "200", "falls; with --pairs, gusts"}, 1, 100000),
          ranged({"seconds", Kind::kNumber, "S", "20", "recorded of each"}, 0.1, 3600),
          ranged({"rate", Kind::kNumber, "HZ", "60", "rows a second"}, 1, 10000),
          {"wind", Kind::kText, "W", "calm",
           "calm, gusts from all sides, or a recording FILE.csv of wind.x, wind.y, wind.z, or of a single input that "
           "blows along x, m/s"},
          {"pairs", Kind::kSwitch, "", "",
           "one gust an episode, each with many clones of a fall, and in REC.calm.csv the same falls without it"},
          {"video", Kind::kOutput, "CLIP.mp4", "", "and film the first few drops, up to 20 s"},
          {"seed", Kind::kInteger, "N", "1", "of all chance"},
      },
      {{"wisp simulate leaf -o leaf.csv --drops 200 --seconds 20", "What a leaf's chain is learned from"},
       {"wisp simulate leaf -o gusts.csv --pairs --drops 200 --seconds 1.5",
        "What its answer to wind is learned from"}},
      run_simulate_leaf,
  };
}

}  // namespace wisp::cli
