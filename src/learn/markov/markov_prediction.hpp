#pragma once
// What a Markov-switched ARX model says about a recording: how likely it is, which modes acted, and k steps ahead or
// from the input alone.
//
// The mode is not known: a prediction begins with the probabilities that the past gives (J. D. Hamilton 1989) and goes
// on with the mean over modes, weighted with their probabilities at that step. Differences between the mean of paths
// and the path of means are neglected.

#include <span>
#include <vector>

#include "learn/arx/judge/prediction.hpp"
#include "learn/markov/markov_rows.hpp"
#include "wisp/base/result.hpp"

namespace wisp::markov {

/// How likely the rows of a recording are, and which modes acted. Errors: channels that do not fit the model or are
/// missing, rates that differ, no usable row.
Result<Belief> believe(const SwitchedArxModel& model, const Recording& recording, const ChannelChoice& channels);

/// One series an output, as predict() of an ARX model has them, from measured samples: `steps` ahead, or kFreeRun.
/// Errors: as believe().
Result<std::vector<std::vector<double>>> predict(const SwitchedArxModel& model, const Recording& recording,
                                                 const ChannelChoice& channels, int steps);

/// Figures of those predictions over all recordings together, as prediction_figures() has them.
/// Errors: as predict; steps below 0 or above 100000.
Result<PredictionFigures> figures(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                  const ChannelChoice& channels, int steps);

}  // namespace wisp::markov
