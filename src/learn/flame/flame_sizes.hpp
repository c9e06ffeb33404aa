#pragma once
// Recorded time courses of a flame's size and shape for playback: decay when it is blown out, and re-ignition.

#include <span>
#include <vector>

#include "learn/flame/extinction.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/extinction.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Size of the flame in every row, NaN without an outline: the square root of the control polygon's area, divided by
/// its median while the flame burns. All NaN where the flame never burns undisturbed.
/// Errors: not a recording of an outline.
Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs);

/// Recorded events, at most eight of a kind, equally spaced; empty where none was seen.
struct RecordedEvents {
  FlameEvents dying;             ///< from the beginning of decay, relative to the size before; then 0.05 s of glow
                                 ///< without an outline
  FlameEvents catching;          ///< up to 0.75 s
  double vanishing_seconds = 0;  ///< median duration of visible decay
};

/// Extracts the events around the blow-outs. All recordings must have one rate. If the view has a shape, outlines of
/// re-ignition are stored as its components. Errors: as flame_sizes().
Result<RecordedEvents> recorded_events(std::span<const ExtinctionEvidence> evidence, const OutlineView& view = {});

/// Extends the ranges of a shape to those of the events: re-ignition is wider than any burning flame.
void make_room(const FlameEvents& events, ShapeComponents& shape);

}  // namespace wisp
