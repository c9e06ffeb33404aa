#pragma once
// What a switched ARX model says about a recording: how likely it is, which modes acted, and k steps ahead or from the
// input alone.
//
// By regions everything follows from the equations without noise. Of a Markov chain the mode is not known: a prediction
// begins with the probabilities that the past gives (J. D. Hamilton 1989) and goes on with the mean over modes, weighed
// with how probable each is by then; that the mean of paths is not the path of means is left out.

#include <span>
#include <vector>

#include "learn/arx/judge/prediction.hpp"
#include "learn/channel_choice.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/switched.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// ln of the density of each row that can be predicted, given those before it, in the outputs' units, over all
/// recordings one after the other. A single ARX model is judged as switched_of(it).
/// Errors: channels that do not fit the model or are missing, rates that differ, no usable row.
Result<std::vector<double>> row_log_likelihoods(const SwitchedArxModel& model, std::span<const Recording> recordings,
                                                const ChannelChoice& channels);

/// The likeliest mode of every row of a recording, −1 where a sample is missing: its region or, for a Markov chain,
/// what all rows of the stretch tell. Errors: as row_log_likelihoods.
Result<std::vector<int>> mode_sequence(const SwitchedArxModel& model, const Recording& recording,
                                       const ChannelChoice& channels);

/// One series an output, as predict() of an ARX model has them, from measured samples: `steps` ahead, or kFreeRun.
/// Errors: as row_log_likelihoods; steps below 0 or above 100000.
Result<std::vector<std::vector<double>>> predict_switched(const SwitchedArxModel& model, const Recording& recording,
                                                          const ChannelChoice& channels, int steps);

/// Figures of those predictions over one recording, as prediction_figures() has them.
Result<std::vector<PredictionFigures>> switched_figures(const SwitchedArxModel& model, const Recording& recording,
                                                        const ChannelChoice& channels, const std::vector<int>& steps);

}  // namespace wisp
