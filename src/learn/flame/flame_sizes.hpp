#pragma once
// Recorded events of a flame's size, to be played again: how it goes when it is blown out, and how it comes when it is
// lit.

#include <span>
#include <vector>

#include "learn/flame/extinction.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/extinction.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// The size of the flame in every row, NaN where it has no outline: the square root of its control points' polygon's
/// area, which shrinks as the flame does, over the median of that while it burns. All are NaN where it never burns
/// undisturbed.
/// Errors: not a recording of an outline.
Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs);

/// The events of some recordings, at most eight of a kind, evenly spread; none where none was seen.
struct RecordedEvents {
  SizeEvents dying;              ///< from where it begins to shrink, over what it was before; then three dim frames of
                                 ///< 60 a second, in which no camera finds an outline
  SizeEvents catching;           ///< over a second, the last third of it fading into full size
  double vanishing_seconds = 0;  ///< median, of what is seen of dying
};

/// Cuts the events at what was blown out. All recordings have one rate.
/// Errors: as flame_sizes().
Result<RecordedEvents> recorded_events(std::span<const ExtinctionEvidence> evidence);

}  // namespace wisp
