#pragma once
// Sound against picture for an outline: by how much its motion comes after each input, and what is done about it.
//
// A motion that comes later than its input is nothing to mend: a flame takes some 50 ms to answer, and whatever more
// the recording added is left to the lags and to the search for the delay. A motion that comes before its input is the
// recording's doing alone, and no model can follow what it has not heard yet: that input is moved.

#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How the offset is searched.
struct AlignmentOptions {
  double rate_hz = 60;     ///< of both series, > 0
  double max_seconds = 1;  ///< offsets searched: from minus to plus this, > 0
};

/// By how much the motion comes after the wind.
struct Alignment {
  double offset_seconds = 0;  ///< motion(t) goes with wind(t − offset): positive where the motion comes later
  double low_seconds = 0;     ///< the ends of its 95 % interval
  double high_seconds = 0;
  double correlation = 0;  ///< of the whitened series at that offset, −1 to 1
  double chance = 0;       ///< largest |correlation| that unrelated recordings reach in one of a hundred
  bool usable = false;     ///< the offset stands out from chance, lies within the search and is sharp
  std::string reason;      ///< one clause: what was found, or why it is not usable
};

/// Estimates how much later `motion` follows `wind`, by the cross-correlation of both after an autoregressive filter
/// that whitens the wind (Box & Jenkins, Time Series Analysis, section on prewhitening): it peaks where the response of
/// motion to wind does. So the offset is that of the recording plus the time that the thing itself takes to answer (a
/// flame's tip: some 50 ms). Its interval comes from a bootstrap over blocks of time.
/// Both series have one value a frame; NaN is missing.
/// Errors: lengths differ; less than four times max_seconds in which both are known; a series that never changes.
Result<Alignment> align_offset(std::span<const double> wind, std::span<const double> motion,
                               const AlignmentOptions& options = {});

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
