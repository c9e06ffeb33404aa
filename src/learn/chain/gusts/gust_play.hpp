#pragma once
// Response of a fall to wind, learned from falls that differ only in their wind (gust_response.cpp), and its play: a
// bank is placed at each calm fall's state at the gust's onset and exposed to the gust.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 4.4, v_windy − v_calm = F(w, x), and figure 8.
// Falls are chaotic: a windy fall and its calm twin drift apart for reasons other than the wind. So each gust
// is repeated over clones with slightly different starts, and the response is learned and judged on the clones' means.
// The response has one lag: a leaf is so light that further lags add nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

/// A windy recording and its calm twin: piece k of both starts alike; each gust has `clones` consecutive pieces.
struct GustPairs {
  Motion windy;
  Motion calm;
  std::array<const std::vector<double>*, 3> wind{};  ///< wind of the windy recording, which must outlive the pairs
  std::size_t clones = 1;
  std::string source;  ///< source of the windy recording

  std::size_t gusts() const { return windy.pieces.size() / clones; }
  Triple wind_at(std::size_t piece, std::size_t row) const;
};

/// Pairs a windy recording with its calm twin; attribute `clones` is the number of episodes per gust (default 1).
/// Errors: as motion_of(); no wind channels; episodes that do not match; fewer than 4 gusts.
Result<GustPairs> gust_pairs(const Recording& windy, const Recording& calm);

/// Rows [onset, end) of a gust: from the first wind of any clone to the last, and 0.3 s more. Empty without wind.
struct GustSpan {
  std::size_t onset = 0;
  std::size_t end = 0;
  std::size_t rows() const { return end - onset; }
};
GustSpan span_of(const GustPairs& pairs, std::size_t gust);

/// Means over clones, one row per row since the onset.
struct GustEnsemble {
  std::vector<Triple> change;        ///< change of velocity by the wind
  std::vector<Triple> displacement;  ///< displacement by the wind since the onset
  std::vector<Triple> wind;
  std::vector<std::array<Triple, 3>> normal;  ///< projection n nᵀ onto the body's normal
  double displacement_error = 0;              ///< standard error of the mean horizontal displacement at the end, metres
};

/// Returns the means over the clones first, first + stride, …
GustEnsemble ensemble_of(const GustPairs& pairs, std::size_t gust, const GustSpan& span, std::size_t first = 0,
                         std::size_t stride = 1);

struct GustFit {
  GustResponse response;
  std::vector<Input> inputs;  ///< wind.x, wind.y, wind.z with the observed range
};

/// Learns from the first `gusts` gusts. Errors: fewer than 2 of them have wind.
Result<GustFit> learn_gusts(const GustPairs& pairs, std::size_t gusts);

/// Horizontal angles between the recorded and the played mean displacement at the end, degrees; NaN over no gusts.
struct GustDirection {
  double median = 0;
  double mean = 0;        ///< over all gusts, also small displacements, whose direction is random
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
  bool diverges = false;                     ///< whether left_after exceeds 0.1 m/s, or a figure is not finite
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
  std::vector<GustScene> scenes;  ///< scenes for plots, at equally spaced quantiles of displacement
};

/// Plays the gusts of a windy recording from index `first` on, clone by clone, with and without their wind.
/// Errors: the model is not a chain with a gust response; rates that differ; orientation in one alone; no gust's wind.
Result<GustPlay> play_gusts(const Model& model, const GustPairs& pairs, std::size_t first, std::uint64_t seed);

ReportSection gusts_section(const GustPlayFigures& figures);

/// Horizontal tracks of a scene in centimetres from each clone's own onset, split by whether the wind blows: ids
/// `gusts-above.NUMBER.SIDE.WHAT`. The title names the gust.
ReportSection scene_section(const GustScene& scene, std::size_t number);

}  // namespace wisp::chain
