#pragma once
// Gusts that hit many clones of one fall, and the same falls without them, as means over the clones: what the wind did
// without what chance did.

#include <array>
#include <cstddef>
#include <vector>

#include "learn/chain/motion/motion.hpp"

namespace wisp::chain {

/// A windy recording and its calm twin: piece k of both began alike, and each gust has `clones` pieces in a row.
struct GustPairs {
  Motion windy;
  Motion calm;
  std::array<const std::vector<double>*, 3> wind{};  ///< samples of the windy recording, which must outlive this
  std::size_t clones = 1;

  std::size_t gusts() const { return windy.pieces.size() / clones; }
  Triple wind_at(std::size_t piece, std::size_t row) const;
};

/// `clones` comes from the attribute of that name, 1 where it is missing.
/// Errors: as motion_of(); no wind channels; episodes that do not match; fewer than 4 gusts.
Result<GustPairs> gust_pairs(const Recording& windy, const Recording& calm);

/// Rows [onset, end) of a gust: from the first wind of any clone to the last, and a while after.
struct GustSpan {
  std::size_t onset = 0;
  std::size_t end = 0;
  std::size_t rows() const { return end - onset; }
};
GustSpan span_of(const GustPairs& pairs, std::size_t gust, double after_seconds);

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

/// Sums of squares that fits are made of.
struct FitSums {
  double error = 0;
  double size = 0;
  void add(const Triple& found, const Triple& expected);
  double fit_percent() const;
};

/// The angle over ground between two displacements, degrees.
double degrees_between(const Triple& a, const Triple& b);

}  // namespace wisp::chain
