#pragma once
// Preparation of a recording for identification: detrending, filtering, resampling.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/training.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Parses words such as `detrend`, `highpass:0.1`, `lowpass:5`, `resample:20` (Hz), in any order.
/// Errors: another word, a word twice, a frequency that is not above 0.
Result<Preparation> parse_preparation(const std::vector<std::string>& words);

/// Returns the words, separated by commas; empty for no preparation.
std::string text_of(const Preparation& preparation);

/// Returns the recording with all channels detrended, then filtered, then resampled. Equal treatment
/// preserves linear systems between channels. Means are kept, and so is the operating point. Filters are Butterworth of
/// order 2, applied forward and backward, without delay: −3 dB at their frequency, 24 dB per octave. If the new rate is
/// lower, a low-pass at 0.4 of the new rate is applied, unless a lower one is requested. Samples are interpolated by
/// cubics. Episodes are processed separately. Missing samples stay missing; the filter bridges them linearly.
/// Errors, naming the recording: a filter's frequency not below half the recording's rate; a high-pass not below the
/// low-pass; a new rate more than 100 times the old one, or at which an episode has fewer than two rows.
Result<Recording> prepare(const Recording& recording, const Preparation& preparation);

/// Prepares several recordings.
Result<std::vector<Recording>> prepare_all(std::span<const Recording> recordings, const Preparation& preparation);

}  // namespace wisp
