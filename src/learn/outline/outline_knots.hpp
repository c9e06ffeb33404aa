#pragma once
// One outline, other knots.
//
// Every clip may have its knots placed where its own outline bends. The curve is the same curve in any knots that are
// fine enough for it, so recordings with different knots can be brought together.

#include <span>

#include "learn/outline/outline_units.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A recording in other knots.
struct Reknotted {
  Recording recording;  ///< its outputs changed, its attribute `knots` set
  double rms = 0;       ///< root mean square distance between old and new curves at the same parameters, in the
                        ///< outputs' unit; 0 where no row has an outline
};

/// Expresses a recording's outlines in other knots: in every row the control points, the same number, whose curve is
/// nearest to the old one by least squares at 200 even parameters, ends kept.
///
/// Precondition: layout is the recording's; `knots` has as many values as its own and is valid (valid_knots).
Reknotted with_knots(const Recording& recording, const OutlineLayout& layout, std::span<const double> knots);

}  // namespace wisp
