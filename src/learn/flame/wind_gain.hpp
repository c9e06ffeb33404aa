#pragma once
// Whether recordings were heard by one microphone: is the same wind the same number in all of them?

#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_fit.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// On what scale the heard inputs of several recordings are.
struct WindGain {
  bool common = false;          ///< one for all, that of the loudest; else every recording's own
  std::vector<double> factors;  ///< of every recording's inputs on the common scale; empty: nothing to choose
  double common_error = 0;      ///< of free simulation on what is held out, model units; 0 where it was not tried
  double own_error = 0;
  std::string reason;  ///< one clause for people; empty: nothing to choose
};

/// The recordings with their inputs as loud at 1 as in the loudest of them. Whatever does not say how loud it was stays
/// as it is. Errors: as one_rms().
Result<std::vector<Recording>> at_common_gain(std::vector<Recording> recordings);

/// Chooses as the recipe's gain says. Where that is open, learns with a common scale and with every recording's own,
/// simulates freely what is held out, and takes the common scale unless the other is surely better.
/// There is nothing to choose where not every recording says how loud it was, or where that is within 2 % the same.
/// Errors: as fit_outline() and one_rms().
Result<WindGain> choose_wind_gain(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                                  const Progress& progress = {});

/// What a recording's first heard input is multiplied by to be as loud at 1 as in what the model was learned from; 1
/// where either does not say. Errors: as one_rms().
Result<double> factor_to_trained_gain(const Model& model, const Recording& recording);

/// A recording whose inputs are as loud at 1 as in those that the model was learned from; as it is where either does
/// not say how loud that was. Errors: as one_rms().
Result<Recording> at_trained_gain(const Model& model, Recording recording);

}  // namespace wisp
