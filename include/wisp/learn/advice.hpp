#pragma once
// A recording looked at before any model: its rate, its channels, and what in it will spoil a model, with cures.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// What may be wrong with a recording, the cause of most bad models first.
enum class RemarkKind {
  kSentinel,    ///< a number that stands for a missing sample, such as −999
  kOutliers,    ///< single samples far from their neighbours
  kConstant,    ///< a channel that never changes
  kRedundant,   ///< a channel that others already tell
  kMissing,     ///< a tenth of the samples or more
  kShort,       ///< few rows
  kExcitation,  ///< an input that hardly moves
  kFeedback,    ///< an input that is set by the output
  kDelay,       ///< an input that acts late
  kIntegrates,  ///< an output that sums what goes in
  kDrift,       ///< an output that wanders whatever the inputs do
  kClock,       ///< a clock that was resampled, or a rate or unit that was guessed
  kText,        ///< a column that is not of numbers
};

/// One remark: a cause and its cure, each a sentence that begins small.
struct Remark {
  RemarkKind kind = RemarkKind::kClock;
  std::string channel;
  std::string cause;
  std::string cure;
  double size = 0;  ///< kDelay: samples
};

/// What is remarkable of recordings, in the order of RemarkKind. Outputs alone are searched for outliers, drift and
/// integration; without inputs nothing is said of excitation, feedback and delays.
/// Channels that a recording has not are passed over.
std::vector<Remark> remarks_on(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                               const std::vector<std::string>& outputs);

/// Those of them that are kRedundant among the named channels, judged by a sample of the rows.
std::vector<Remark> redundant_channels(std::span<const Recording> recordings, const std::vector<std::string>& names);

/// The data page of `wisp info`: rate and where it is from, rows, a table `channels`, a table `remarks`, and a series a
/// channel. Inputs and outputs are those with that role.
Report advise(const Recording& recording);

/// How outlines move: mean and deviation of height, area and lean, the frequency of the flicker of √area with its width
/// at half power, and its spectrum as a series. Of several, filmed at once, the phase of each after the first at the
/// first one's flicker, −180 to 180 degrees, with the coherence.
/// Errors: no outline; another rate or number of rows than the first one's.
Result<Report> outline_motion(std::span<const Recording> recordings);

}  // namespace wisp
