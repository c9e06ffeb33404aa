#pragma once
// Diagnosis of a recording before learning: its rate, its channels, and defects that will spoil a model, with remedies.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Kinds of defects of a recording, from the most to the least common cause of bad models.
enum class RemarkKind {
  kSentinel,    ///< a number that stands for a missing sample, such as −999
  kOutliers,    ///< single samples far from their neighbours
  kConstant,    ///< a channel that never changes
  kRedundant,   ///< a linear function of another channel; for inputs, also of earlier samples of another input
  kMissing,     ///< more than a tenth of the samples are missing
  kShort,       ///< fewer than 50 rows
  kExcitation,  ///< an input that changes only one to three times
  kFeedback,    ///< an input that depends on the output (feedback)
  kDelay,       ///< an input that acts after a delay of four samples or more
  kIntegrates,  ///< an output that integrates its input
  kDrift,       ///< an output that drifts independently of the inputs
  kClock,       ///< a clock that was resampled, or a rate or unit that was guessed
  kText,        ///< a column of text
};

/// One remark: a cause and its remedy, each a clause that begins in lower case.
struct Remark {
  RemarkKind kind = RemarkKind::kClock;
  std::string channel;
  std::string cause;
  std::string cure;
  double size = 0;  ///< kDelay: delay in samples; kFeedback: percent of the input's variance, unexplained by its own
                    ///< past, that the output's past explains
};

/// Returns remarks on recordings, in the order of RemarkKind. Only outputs are tested for outliers, drift and
/// integration. Excitation, feedback, delays, drift and integration are tested only where there are inputs and outputs
/// and no sentinel or outlier was found. Channels that a recording lacks are skipped.
std::vector<Remark> remarks_on(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                               const std::vector<std::string>& outputs);

/// Returns the kRedundant remarks on the named channels, judged by at most 8192 rows from the recordings' middles.
/// `lags`: samples by which one channel may lag another.
std::vector<Remark> redundant_channels(std::span<const Recording> recordings, const std::vector<std::string>& names,
                                       int lags = 0);

/// Returns the kFeedback remarks on the first 8192 rows of the first recording.
std::vector<Remark> feedback_of(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                                const std::vector<std::string>& outputs);

/// Returns the data page of `wisp info`: rate and its source, rows, a table `channels`, a table `remarks`, and one
/// series per channel. Inputs and outputs are the channels with that role.
Report advise(const Recording& recording);

/// Describes the motion of outlines: mean and deviation of height, area and lean; the flicker frequency of √area with
/// its half-power bandwidth, and its spectrum as a series. For outlines filmed simultaneously, also the phase by which
/// each other outline lags the first, at the first one's flicker frequency, −180 to 180 degrees, and coherence. Errors:
/// no outline; fewer than two rows with an outline; a rate or number of rows that differs from the first recording's.
Result<Report> outline_motion(std::span<const Recording> recordings);

}  // namespace wisp
