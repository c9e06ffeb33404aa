#pragma once
// Plays simulated or recorded gusts with a chain's gust response: a bank is placed at each calm fall's state at the
// gust's onset and exposed to the gust.
//
// Source: section 4.4 of the paper, whose figure 8 shows one response; here many are judged, on means over clones.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "learn/chain/gusts/gust_response.hpp"
#include "learn/chain/motion/motion.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp::chain {

/// Horizontal angles between the mean displacements at the end, degrees.
struct GustDirection {
  double median = 0;
  double mean = 0;        ///< over all gusts: small displacements have a random direction
  double mean_clear = 0;  ///< over gusts with a significant displacement
};

struct GustPlayFigures {
  std::size_t gusts = 0;
  std::size_t clear_gusts = 0;  ///< number of gusts with a significant recorded displacement
  std::size_t clones = 0;
  double fit_percent = 0;  ///< of the mean displacement during and after the gust
  double velocity_fit_percent = 0;
  GustDirection direction;
  double halves_fit_percent = 0;    ///< one half of the recorded clones against the other; NaN with fewer than 4 clones
  GustDirection halves_direction;   ///< direction for the same halves
  double largest_displacement = 0;  ///< metres, maximum of the played means
  double largest_recorded_displacement = 0;  ///< metres, maximum of the recorded means
  double left_after = 0;                     ///< m/s, maximum velocity difference in play two seconds after a gust
  bool diverges = false;                     ///< whether a value is not finite, or left_after exceeds 0.1 m/s
};

/// Paths of every clone in one gust from its onset on, and the rows in which the wind blows.
struct GustScene {
  std::size_t gust = 0;
  std::vector<std::vector<Triple>> recorded;  ///< per clone
  std::vector<std::vector<Triple>> played;
  std::vector<Triple> recorded_calm;  ///< mean path without the gust
  std::vector<Triple> played_calm;
  std::vector<bool> blows;  ///< whether the wind blows, per row
  Triple strongest{};       ///< strongest wind vector, m/s
};

struct GustPlay {
  GustPlayFigures figures;
  std::vector<GustScene> scenes;  ///< scenes for figures, at equally spaced quantiles of displacement
};

/// Plays the gusts of a windy recording from index `first` on, clone by clone, with and without their wind.
/// Errors: the model is not a chain with a gust response; rates that differ; no gust with wind.
Result<GustPlay> play_gusts(const Model& model, const GustPairs& pairs, std::size_t first, std::uint64_t seed);

ReportSection gusts_section(const GustPlayFigures& figures);

/// Horizontal tracks of a scene in centimetres from each clone's own onset, split by whether the wind blows: ids
/// `gusts-above.NUMBER.SIDE.WHAT`. The title names the gust.
ReportSection scene_section(const GustScene& scene, std::size_t number);

}  // namespace wisp::chain
