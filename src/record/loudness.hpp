#pragma once
// How loud the sound was where an input that was heard is 1: by it, what one microphone heard in several recordings can
// be put on one scale.
//
// A tracker calls 1 whatever blew hard in its own recording (wisp/sound/wind_track.hpp), so that a phone and a laptop
// hear alike. In recordings of one microphone the same wind is another number then, wherever something else blew hard.

#include <optional>
#include <string>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// The RMS of the sound, full scale 1, at 1 of an input that goes with the root of it, as speeds of wind do; nothing
/// where the recording does not say (attribute INPUT.one_rms).
/// Errors: the attribute is not one number above 0.
Result<std::optional<double>> one_rms(const Recording& recording, const std::string& input);

/// Says it.
///
/// Precondition: rms > 0.
void set_one_rms(Recording& recording, const std::string& input, double rms);

/// What an input is multiplied by for its 1 to be as loud as `rms`; 1 where the recording does not say how loud it was.
/// Errors: as one_rms().
///
/// Precondition: rms > 0.
Result<double> factor_at(const Recording& recording, const std::string& input, double rms);

/// The recording with an input whose 1 is as loud as `rms`; as it is where it has no such input, or does not say how
/// loud that was. Errors: as one_rms().
///
/// Precondition: rms > 0.
Result<Recording> heard_at(Recording recording, const std::string& input, double rms);

}  // namespace wisp
