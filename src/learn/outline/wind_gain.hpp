#pragma once
// One scale for the wind of all recordings, as one microphone hears them.

#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// The recordings with their inputs as loud at 1 as in the loudest of them. Whatever does not say how loud it was stays
/// as it is. Errors: as one_rms().
Result<std::vector<Recording>> at_common_gain(std::vector<Recording> recordings);

/// The factor for each recording's first heard input; empty where some recording does not say how loud it was, or where
/// all are equal within 2 %. Errors: as one_rms().
Result<std::vector<double>> common_gain_factors(std::span<const Recording> recordings);

/// What a recording's first heard input is multiplied by to be as loud at 1 as in what the model was learned from; 1
/// where either does not say. Errors: as one_rms().
Result<double> factor_to_trained_gain(const Model& model, const Recording& recording);

/// A recording whose inputs are as loud at 1 as in those that the model was learned from; as it is where either does
/// not say how loud that was. Errors: as one_rms().
Result<Recording> at_trained_gain(const Model& model, Recording recording);

}  // namespace wisp
