#pragma once
// Sound against picture for an outline: by how much its motion comes after each input, and what is done about it.
//
// A motion that comes later than its input is nothing to mend: a flame takes some 50 ms to answer, and whatever more
// the recording added is left to the lags and to the search for the delay. A motion that comes before its input is the
// recording's doing alone, and no model can follow what it has not heard yet: that input is moved.

#include <string>
#include <vector>

#include "learn/outline/alignment.hpp"
#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// The tip beside and above the middle of its base, row by row; NaN where missing.
struct TipMotion {
  std::vector<double> sway;
  std::vector<double> height;
};
TipMotion tip_motion(const Recording& recording, const OutlineLayout& layout);

/// One input of one recording.
struct InputAlignment {
  std::string source;        ///< the recording
  std::string input;         ///< its channel
  std::string motion;        ///< "sway" or "height" of the tip: whichever goes with the input more clearly
  Alignment found;           ///< not usable, with the reason, where nothing could be found
  int frames_moved = 0;      ///< by so many frames the input was moved to earlier times
  std::string note() const;  ///< one clause for people: what was found and what was done
};

/// A recording whose inputs are in step with its outline, and what was found.
struct AlignedOutline {
  Recording recording;
  std::vector<InputAlignment> inputs;
};

/// Finds by how much an outline's motion comes after each of the named inputs, and moves those inputs to earlier times
/// by whole frames for which the motion surely comes first (the whole interval below 0): what an input tells beyond the
/// end of its episode is then missing there (NaN).
/// Inputs that the recording has not are left to whoever needs them.
/// Errors: as outline_layout().
Result<AlignedOutline> align_outline(const Recording& recording, const std::vector<std::string>& inputs);

}  // namespace wisp
