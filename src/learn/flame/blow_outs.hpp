#pragma once
// Detects where in a recording a flame was blown out, and removes those parts.
//
// Recordings do not mark extinctions: the outline is missing for a while, which also happens where a clip fades or a
// hand covers the flame. The wind just before distinguishes extinctions.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct BlowOut {
  std::size_t gone = 0;  ///< first row without an outline
  std::size_t back = 0;  ///< first row with an outline again; the number of rows where there is none
  double wind = 0;     ///< largest 0.15 s mean of the wind from 0.6 s before `gone` to 0.15 s after, in the wind's unit
  bool blown = false;  ///< whether `wind` exceeds the 95th percentile of the wind while the flame burned
};

/// Number of rows in `seconds`, at least one.
std::size_t rows_of(double seconds, double rate_hz);

/// Returns stretches without an outline of 0.5 s or more, in order. A stretch at the recording's start is ignored,
/// since the flame was not seen to go out; one at a later episode's start is not blown. Errors: no outline or input.
Result<std::vector<BlowOut>> find_blow_outs(const Recording& recording, const std::string& input);

/// Removes misdetected outlines: stretches shorter than half a second between two jumps, or between a jump and an end
/// of the recording. A jump is a step above a fifth of the outline's median height and above 20 times the 90th
/// percentile of steps. Does nothing if more than a twentieth of all rows would be removed. Returns the number removed.
std::size_t remove_jumps(Recording& recording);

/// The recording with all channels set missing during decay, extinction and re-ignition, so that only a burning flame
/// remains. Absences without wind stay as they are.
Recording without_blow_outs(const Recording& recording, std::span<const BlowOut> blow_outs);

}  // namespace wisp
