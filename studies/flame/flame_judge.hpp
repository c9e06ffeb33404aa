#pragma once
// How like a recorded flame is what something plays along its wind? The same questions to whatever plays.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_inputs.hpp"
#include "studies/flame/flame_corpus.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::verify {

/// The units that a set of training clips gives: flame heights, and its strong wind.
struct FlameUnits {
  std::vector<double> knots;
  std::optional<OutlineInput> wind;  ///< nothing: clips without one

  /// A clip in these units: its own height at rest is 1, and what was `wind` before still is.
  Recording operator()(const Recording& clip) const;
};

/// The units of clips in common knots; the wind is that of an input `wind`, where they have one.
FlameUnits flame_units(std::span<const Recording> clips);

/// Something that plays a flame.
struct FlamePlayer {
  std::string name;  ///< without commas
  /// Plays along a clip in units: outputs in units, a row a row. Without chance where it can do without.
  std::function<Recording(const Recording& along, bool chance, std::uint64_t seed)> play;
  bool hears_wind = true;
  std::int64_t operations = 0;  ///< a frame
  std::size_t bytes = 0;
};

/// A model of Wisp's as a player.
FlamePlayer player_of(const std::string& name, const Model& model);

/// What a frame costs to look at: reading between two steps and the polyline, the same for all that give control
/// points.
std::int64_t view_operations(const Model& model);

/// Asks all players about all clips of one wind. Writes FOLDER/WIND/figures.csv (a line a player: name, energy
/// distance, log-spectral distance in dB, speeds in standard deviations, fit of the tip in per cent or `none`,
/// operations, bytes; `floor` and `ceiling` are lines too) and FOLDER/WIND/windows.csv for a classifier, and prints
/// what it wrote.
void judge_players(const UnseenFlames& unseen, const FlameUnits& units, std::span<const FlamePlayer> players,
                   const std::filesystem::path& folder);

}  // namespace wisp::verify
