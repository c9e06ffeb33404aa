#pragma once
// Sound level at which an acoustic input has the value 1: by it, recordings of one microphone get a common scale.
//
// A tracker's 1 is the strong wind of its own recording (wisp/sound/wind_track.hpp), so that a phone and a laptop give
// similar inputs. In recordings of one microphone, equal winds then have different values if the strong winds differ.

#include <optional>
#include <string>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Returns the RMS of the sound, full scale 1, at which an input is 1; nothing if the recording does not state it
/// (attribute INPUT.one_rms). The input is taken as proportional to the square root of the RMS, as wind speed is.
/// Errors: the attribute is not one number above 0.
Result<std::optional<double>> one_rms(const Recording& recording, const std::string& input);

/// Sets the attribute INPUT.one_rms.
///
/// Precondition: rms > 0.
void set_one_rms(Recording& recording, const std::string& input, double rms);

/// Returns the factor after which an input is 1 at sound level `rms`; 1 if the recording does not state its level.
/// Errors: those of one_rms().
///
/// Precondition: rms > 0.
Result<double> factor_at(const Recording& recording, const std::string& input, double rms);

/// Returns the recording with an input rescaled to 1 at sound level `rms`; unchanged if it has no such input, or does
/// not state its level. Errors: those of one_rms().
///
/// Precondition: rms > 0.
Result<Recording> heard_at(Recording recording, const std::string& input, double rms);

}  // namespace wisp
