#pragma once
// What wind does to a fall, learned from falls that differ only in their wind.
//
// Source: section 4.4 of the paper, v_windy − v_calm = F(w, x). Falls are chaotic: a windy one and its calm twin drift
// apart for reasons that are not the wind, so the response is learned, and judged, on means over clones of one gust
// that differ a little. It has one lag: a leaf is so light that more say no more.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

/// A windy recording and its calm twin: piece k of both began alike, and each gust has `clones` pieces in a row.
struct GustPairs {
  Motion windy;
  Motion calm;
  std::array<const std::vector<double>*, 3> wind{};  ///< samples of the windy recording, which must outlive this
  std::size_t clones = 1;
  std::string source;  ///< the windy recording's

  std::size_t gusts() const { return windy.pieces.size() / clones; }
  Triple wind_at(std::size_t piece, std::size_t row) const;
};

/// Both share the value of `pair`; `clones` says how many episodes in a row belong to one gust (1 where it is missing).
/// Errors: as motion_of(); no wind channels; episodes that do not match; fewer than 4 gusts.
Result<GustPairs> gust_pairs(const Recording& windy, const Recording& calm);

/// Rows [onset, end) of a gust: from the first wind of any clone to the last, and a while after.
struct GustSpan {
  std::size_t onset = 0;
  std::size_t end = 0;
  std::size_t rows() const { return end - onset; }
};
GustSpan span_of(const GustPairs& pairs, std::size_t gust);

/// Means over clones, a row each from the onset on.
struct GustEnsemble {
  std::vector<Triple> change;        ///< of velocity
  std::vector<Triple> displacement;  ///< since the onset
  std::vector<Triple> wind;
  std::vector<std::array<Triple, 3>> normal;  ///< what takes of a wind its part that is square to the body: n nᵀ
  double displacement_error = 0;              ///< over ground at the end: standard error of the mean, metres
};

/// Over the clones first, first + stride, …
GustEnsemble ensemble_of(const GustPairs& pairs, std::size_t gust, const GustSpan& span, std::size_t first = 0,
                         std::size_t stride = 1);

struct GustFit {
  GustResponse response;
  std::vector<Input> inputs;  ///< wind.x, wind.y, wind.z with the range that was seen
};

/// Learns from the first so many gusts. Errors: fewer than 2 of them blow.
Result<GustFit> learn_gusts(const GustPairs& pairs, std::size_t gusts);

}  // namespace wisp::chain
