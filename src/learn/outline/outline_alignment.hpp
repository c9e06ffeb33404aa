#pragma once
// Synchronises sound and picture of an outline: estimates the lag of its motion behind each input.
//
// Motion that lags its input needs no correction: a flame takes some 50 ms to respond, and any further lag of the
// recording is covered by the model's lags. Motion that leads its input is an error of the recording, which no causal
// model can follow: the input is moved earlier.

#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct AlignmentOptions {
  double rate_hz = 60;     ///< sampling rate of both series, > 0
  double max_seconds = 1;  ///< range of offsets searched, ±, > 0
};

struct Alignment {
  double offset_seconds = 0;  ///< motion(t) corresponds to wind(t − offset): positive where the motion is later
  double low_seconds = 0;     ///< ends of the offset's 95 % interval
  double high_seconds = 0;
  double correlation = 0;  ///< correlation of the whitened series at that offset, −1 to 1
  double chance = 0;       ///< 99th percentile of the largest |correlation| of unrelated recordings
  bool usable = false;     ///< whether the offset is significant, within the search range and sharp
  std::string reason;      ///< one clause: the finding, or why it is not usable
};

/// Estimates the lag of `motion` behind `wind` by the cross-correlation of both after an autoregressive filter that
/// whitens the wind (Box & Jenkins, Time Series Analysis, section on prewhitening): the peak is that of the impulse
/// response. The offset therefore includes the response time of the object (some 50 ms for a flame's tip). Its interval
/// comes from a bootstrap over blocks of time.
/// Both series have one value per frame; NaN is missing.
/// Errors: lengths differ; fewer frames known in both than four times max_seconds, or than 16; a constant series.
Result<Alignment> align_offset(std::span<const double> wind, std::span<const double> motion,
                               const AlignmentOptions& options = {});

struct InputAlignment {
  std::string source;        ///< name of the recording
  std::string input;         ///< name of its input channel
  std::string motion;        ///< "sway" or "height" of the tip, whichever correlates more clearly with the input
  Alignment found;           ///< not usable, with the reason, where no offset could be estimated
  int frames_moved = 0;      ///< number of frames by which the input was moved earlier
  std::string note() const;  ///< one clause for reports: the finding and the correction
};

/// A recording whose inputs are synchronised with its outline, and the estimated offsets.
struct AlignedOutline {
  Recording recording;
  std::vector<InputAlignment> inputs;
};

/// Estimates the lag of an outline's motion behind each named input. Inputs that the motion leads significantly (the
/// whole interval below 0) are moved earlier by whole frames; samples freed at the end of an episode become NaN. Inputs
/// missing from the recording are ignored here. Errors: as outline_layout().
Result<AlignedOutline> align_outline(const Recording& recording, const std::vector<std::string>& inputs);

}  // namespace wisp
