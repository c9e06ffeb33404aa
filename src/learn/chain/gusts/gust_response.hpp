#pragma once
// What wind does to a fall, learned from falls that differ only in their wind.
//
// Source: section 4.4 of the paper, v_windy − v_calm = F(w, x). Falls are chaotic: a windy one and its calm twin drift
// apart for reasons that are not the wind, so the response is learned, and judged, on means over clones of one gust
// that differ a little.

#include <cstddef>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

struct GustOptions {
  int order = 1;               ///< 1 … 4; a leaf is so light that more lags say no more
  double after_seconds = 0.3;  ///< ≥ 0: learned and judged over the gust and so long after it
  double holdout = 0.4;        ///< share of the gusts, the last ones, kept for judging; 0 … 0.9
};

/// How the learned response follows the gusts that were held out.
struct GustFigures {
  std::size_t gusts_learned = 0;
  std::size_t gusts_judged = 0;
  double fit_percent = 0;             ///< of the mean displacement over the gust and after it
  double velocity_fit_percent = 0;    ///< of the mean change of velocity
  double direction_degrees = 0;       ///< median angle over ground between displacements at the end
  double direction_degrees_mean = 0;  ///< its mean: small displacements have any direction
  double largest_change = 0;          ///< metres a second, of the simulated response
};

struct GustFit {
  GustResponse response;
  std::vector<Input> inputs;  ///< wind.x, wind.y, wind.z with the range that was seen
  GustFigures figures;
};

/// Both recordings share the value of `pair`; `clones` says how many episodes in a row belong to one gust (1 where it
/// is missing). The calm one has the same episodes. Errors: as motion_of(); no wind channels; episodes that do not
/// match; fewer than 4 gusts; an option out of range.
Result<GustFit> learn_gusts(const Recording& windy, const Recording& calm, const GustOptions& options);

}  // namespace wisp::chain
