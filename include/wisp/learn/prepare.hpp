#pragma once
// A recording made ready for identification: without its straight line, filtered, at another rate.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/training.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// From words such as `detrend`, `highpass:0.1`, `lowpass:5`, `resample:20` (Hz), in any order.
/// Errors: another word, a word twice, a frequency that is not above 0.
Result<Preparation> parse_preparation(const std::vector<std::string>& words);

/// The words, separated by commas; empty where nothing is done.
std::string text_of(const Preparation& preparation);

/// The recording with every channel prepared alike, so that a linear system stays the same: first its straight line is
/// taken off, then it is filtered, then resampled. Means stay, so that an operating point does. Filters are Butterworth
/// of order 2, forward and backward, without a delay: −3 dB at their frequency, 24 dB an octave. Before a lower rate a
/// low-pass at 0.4 of it is added; between samples cubic lines are drawn. Episodes are prepared apart. Missing samples
/// stay missing; the filter bridges them by straight lines.
/// Errors, naming the recording: a filter's frequency is not below half of its rate, or the high-pass is not below the
/// low-pass; a rate more than 100 times its own, or at which an episode has no two rows.
Result<Recording> prepare(const Recording& recording, const Preparation& preparation);

/// The same of several recordings.
Result<std::vector<Recording>> prepare_all(std::span<const Recording> recordings, const Preparation& preparation);

}  // namespace wisp
