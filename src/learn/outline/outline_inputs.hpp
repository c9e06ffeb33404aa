#pragma once
// What drives an outline: inputs in the model's units, signs, and the mirror image.
//
// A wind of 1 is the 95th percentile of the training wind while it blows. Its sign is carried as two non-negative
// inputs, NAME+ and NAME-, so that a linear model does not answer a gust from the right by a flame that grows where a
// gust from the left makes it shrink.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Rescales inputs to a common gain: a value of 1 stands for the same loudness in all recordings, that of the loudest
/// one. Inputs whose loudness is not recorded are left unchanged. Errors: as one_rms().
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

/// Below this share of its 99th percentile an input counts as calm: microphones and anemometers are never at 0.
inline constexpr double kCalmShare = 0.1;

/// One input of an outline.
struct OutlineInput {
  std::string name;
  std::string unit;    ///< of the recording
  double scale = 1;    ///< the recording's value that is 1 in the model, > 0
  double lowest = 0;   ///< seen, in the model's units
  double highest = 0;  ///< seen, in the model's units
};

/// The 95th percentile of |input| over all rows of all recordings where it is above kCalmShare of its 99th percentile.
/// Returns the input with its scale and seen range.
/// Errors: a recording without that channel, no sample, an input that is 0 throughout.
Result<OutlineInput> scaled_input(std::span<const Recording> recordings, const std::string& name);

/// What of a recording's input was 1 when a model was learned.
/// Errors: the model has no input of that name, or was not learned from recordings.
Result<double> trained_scale(const Model& model, const std::string& input);

/// One byte a row: 1 where every input is calm (all rows where there are no inputs).
std::vector<std::uint8_t> calm_rows(const Recording& recording, std::span<const OutlineInput> inputs);

/// How long it must have been calm before what moved by wind counts as being at rest: a flame has come back after a
/// quarter of a second, larger things later; what is left of their lean would pass for their shape at rest.
inline constexpr double kSettleSeconds = 0.5;

/// One byte a row: 1 where every input has been calm for kSettleSeconds within its episode (all rows where there are no
/// inputs).
std::vector<std::uint8_t> resting_rows(const Recording& recording, std::span<const OutlineInput> inputs);

/// Rows of rest; of calm where half a second of rest is not seen, and none where half a second of calm is not either.
std::vector<std::uint8_t> undisturbed_rows(const Recording& recording, std::span<const OutlineInput> inputs);

/// The height in pixels that is 1 in the model: with inputs the median over undisturbed rows, some of which still lean,
/// since an input may be felt before it is heard; without, or where no row is undisturbed, the mean over all of them.
/// 0 where no row has an outline.
double resting_height_pixels(const Recording& recording, const OutlineLayout& layout,
                             std::span<const OutlineInput> inputs);

/// Which regressors inputs make.
struct RegressorShape {
  bool powers = false;  ///< |NAME|, its square root and its square, then the same with NAME's sign, instead of NAME
};

/// Names of the regressors that inputs make, in the model's order (regressor_count(InputShape)).
std::vector<std::string> regressor_names(std::span<const OutlineInput> inputs, RegressorShape shape);

/// A recording with an input channel for every regressor, in the model's units, in the place of its inputs; missing
/// samples stay missing.
///
/// Precondition: the recording has the inputs.
Recording with_regressors(const Recording& recording, std::span<const OutlineInput> inputs, RegressorShape shape);

/// The mean of every output over the chosen rows that are complete, in the layout's order; empty where there is none.
///
/// Precondition: `rows` is empty or has one entry a row.
std::vector<double> mean_shape(const Recording& recording, const OutlineLayout& layout,
                               std::span<const std::uint8_t> rows);

}  // namespace wisp
