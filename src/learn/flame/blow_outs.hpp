#pragma once
// Finds where in a recording a flame was blown out, and removes those parts.
//
// A recording does not say so itself: its outline is missing for a while, as it is where a clip fades or a hand covers
// the flame. The wind just before tells them apart.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A stretch without an outline.
struct BlowOut {
  std::size_t gone = 0;  ///< first row without an outline
  std::size_t back = 0;  ///< first row with one again; the number of rows where it stays away
  double wind = 0;       ///< strongest wind before it, averaged over 0.15 s, in the recording's unit
  bool blown = false;    ///< whether that exceeds 95 % of the wind in which the flame was seen to burn
};

/// Number of rows in `seconds`, at least one.
std::size_t rows_of(double seconds, double rate_hz);

/// Finds the stretches without an outline of 0.5 s or more, in their order. A stretch at the recording's start is
/// left out, since the flame was not seen to go out.
/// Errors: not a recording of an outline, no such input.
Result<std::vector<BlowOut>> find_blow_outs(const Recording& recording, const std::string& input);

/// Removes outlines that nothing moved to: stretches of less than half a second between steps that are both longer than
/// a fifth of the thing's height and 20 times as long as nine in ten. Nothing where that is more than a twentieth of
/// all. Returns how many rows.
std::size_t remove_jumps(Recording& recording);

/// The recording with outlines and inputs missing where the flame is in decay, extinguished or in re-ignition: what is
/// left is a flame that burns, before and after. Stretches that were not blown stay as they are.
Recording without_blow_outs(const Recording& recording, std::span<const BlowOut> blow_outs);

}  // namespace wisp
