#pragma once
// The modes of a chain as splines: to each segment a smoothing spline by least squares, and of those of a mode the mean
// and the ways in which they differ most, as principal components.
//
// Sources: section 2.2 of the paper names splines as realisations of a mode; P. H. C. Eilers & B. D. Marx, Flexible
// Smoothing with B-splines and Penalties, Statistical Science 11 (1996), for the penalty on second differences.

#include "wisp/model/chain.hpp"

namespace wisp::chain {

struct ModeSplineOptions {
  int control_points = 8;   ///< 4 … 32, over the whole of a segment
  int components = 12;      ///< most ways in which segments of a mode differ, 0 … 64
  double stiffness = 1e-3;  ///< of the penalty on second differences of control points; > 0
};

/// Puts splines in the place of a chain's rows: each segment is then a draw of its mode's spline, with the scores that
/// it had in the recording, and as long as it was.
///
/// Precondition: the chain is sound, its modes are neither systems nor splines.
void as_splines(ChainModel& chain, const ModeSplineOptions& options = {});

}  // namespace wisp::chain
