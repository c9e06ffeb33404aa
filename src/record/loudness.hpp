#pragma once
// Sound level at which an acoustic input has the value 1. It gives recordings of one microphone a common scale.
//
// A wind tracker scales each recording so that its own strong wind is 1 (wisp/sound/wind_track.hpp): a phone and a
// laptop then give similar inputs, but equal winds of two recordings get different values if the strong winds differ.

#include <optional>
#include <string>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Returns the RMS of the sound, full scale 1, at which an input is 1; nothing if the recording does not state it
/// (attribute INPUT.one_rms). The input is taken as proportional to the square root of the RMS, as wind speed is.
/// Errors: the attribute is not one number above 0.
Result<std::optional<double>> one_rms(const Recording& recording, const std::string& input);

/// Sets the attribute INPUT.one_rms. Precondition: rms > 0.
void set_one_rms(Recording& recording, const std::string& input, double rms);

/// Returns the factor that rescales an input to 1 at sound level `rms`; 1 if the recording does not state its level.
/// Errors: those of one_rms(). Precondition: rms > 0.
Result<double> factor_at(const Recording& recording, const std::string& input, double rms);

/// Returns the recording with an input rescaled to 1 at sound level `rms`; unchanged if it has no such input, or does
/// not state its level. Errors: those of one_rms(). Precondition: rms > 0.
Result<Recording> heard_at(Recording recording, const std::string& input, double rms);

}  // namespace wisp
