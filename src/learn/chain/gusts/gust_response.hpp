#pragma once
// Response of a fall to wind, learned from falls that differ only in their wind.
//
// Source: section 4.4 of the paper, v_windy − v_calm = F(w, x). Falls are chaotic: a windy fall and its calm twin drift
// apart for reasons other than the wind. So the response is learned and judged on means over clones of one gust with
// slightly different starts. It has one lag: a leaf is so light that further lags add nothing.

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

/// A windy recording and its calm twin: piece k of both began equally; each gust has `clones` consecutive pieces.
struct GustPairs {
  Motion windy;
  Motion calm;
  std::array<const std::vector<double>*, 3> wind{};  ///< samples of the windy recording; it must outlive this
  std::size_t clones = 1;
  std::string source;  ///< source of the windy recording

  std::size_t gusts() const { return windy.pieces.size() / clones; }
  Triple wind_at(std::size_t piece, std::size_t row) const;
};

/// Pairs recordings that share the value of `pair`; attribute `clones` is the number of episodes per gust (default 1).
/// Errors: as motion_of(); no wind channels; episodes that do not match; fewer than 4 gusts.
Result<GustPairs> gust_pairs(const Recording& windy, const Recording& calm);

/// Rows [onset, end) of a gust: from the first wind of any clone to the last, and kAfterSeconds more.
struct GustSpan {
  std::size_t onset = 0;
  std::size_t end = 0;
  std::size_t rows() const { return end - onset; }
};
GustSpan span_of(const GustPairs& pairs, std::size_t gust);

/// Means over clones, one row per row since the onset.
struct GustEnsemble {
  std::vector<Triple> change;        ///< change of velocity
  std::vector<Triple> displacement;  ///< displacement since the onset
  std::vector<Triple> wind;
  std::vector<std::array<Triple, 3>> normal;  ///< projection n nᵀ onto the body's normal
  double displacement_error = 0;              ///< standard error of the mean horizontal displacement at the end, metres
};

/// Means over the clones first, first + stride, …
GustEnsemble ensemble_of(const GustPairs& pairs, std::size_t gust, const GustSpan& span, std::size_t first = 0,
                         std::size_t stride = 1);

struct GustFit {
  GustResponse response;
  std::vector<Input> inputs;  ///< wind.x, wind.y, wind.z with the observed range
};

/// Learns from the first `gusts` gusts. Errors: fewer than 2 of them have wind.
Result<GustFit> learn_gusts(const GustPairs& pairs, std::size_t gusts);

}  // namespace wisp::chain
