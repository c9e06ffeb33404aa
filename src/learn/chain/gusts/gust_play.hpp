#pragma once
// How a chain with a response to gusts plays them, against gusts that were simulated or recorded: the bank itself is
// placed where each calm fall is at the gust's onset, and blown at.
//
// Source: section 4.4 of the paper. It shows one response (its figure 8); here many are judged, on means over clones.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "learn/chain/gusts/gust_response.hpp"
#include "learn/chain/motion/motion.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp::chain {

/// Angles over ground between mean displacements at the end, degrees.
struct GustDirection {
  double median = 0;
  double mean = 0;        ///< of all gusts: small displacements have any direction
  double mean_clear = 0;  ///< of those whose displacement stands out of chance
};

struct GustPlayFigures {
  std::size_t gusts = 0;
  std::size_t clear_gusts = 0;  ///< whose recorded displacement stands out of chance
  std::size_t clones = 0;
  double fit_percent = 0;  ///< of the mean displacement over the gust and after it
  double velocity_fit_percent = 0;
  GustDirection direction;
  double halves_fit_percent = 0;    ///< the recording itself, one half of the clones against the other; NaN with fewer
                                    ///< than 4 clones
  GustDirection halves_direction;   ///< likewise
  double largest_displacement = 0;  ///< metres, of the play's means
  double largest_recorded_displacement = 0;  ///< and of the recording's
  double left_after = 0;                     ///< metres a second that a play still differs by two seconds later
  bool diverges = false;                     ///< something is not finite, or more than a tenth of a metre a second is
                                             ///< left
};

/// One gust seen clone by clone: ways from the onset on, and the rows in which the wind blows.
struct GustScene {
  std::size_t gust = 0;
  std::vector<std::vector<Triple>> recorded;  ///< per clone
  std::vector<std::vector<Triple>> played;
  std::vector<Triple> recorded_calm;  ///< means without the gust
  std::vector<Triple> played_calm;
  std::vector<bool> blows;  ///< a row each
  Triple strongest{};       ///< the wind at its height, m/s
};

struct GustPlay {
  GustPlayFigures figures;
  std::vector<GustScene> scenes;  ///< for a figure: at even shares of all gusts by how far they carry
};

/// Plays the gusts of a windy recording from `first` on, clone by clone, with and without their wind.
/// Errors: the model is not a chain with a response to gusts; rates that differ; none of them blows.
Result<GustPlay> play_gusts(const Model& model, const GustPairs& pairs, std::size_t first, std::uint64_t seed);

ReportSection gusts_section(const GustPlayFigures& figures);

/// Tracks of a scene from above, in centimetres from each clone's own onset, where the wind blows and where it does
/// not: ids `gusts-above.NUMBER.SIDE.WHAT`. The title says which gust it is.
ReportSection scene_section(const GustScene& scene, std::size_t number);

}  // namespace wisp::chain
