#pragma once
// Inputs of an outline: conversion to the model's units, and the regressors made from them.
//
// A wind of 1 is the 95th percentile of the training wind, calm rows excluded. The wind's size and its signed value are
// separate regressors, each also as square root and square, because a linear model of the signed wind alone would
// answer opposite gusts with opposite changes of height.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Rescales inputs to a common gain: a value of 1 stands for the same loudness in all recordings, the largest that one
/// of them states. An input stays unchanged if any recording does not state its loudness. Errors: as one_rms().
Result<std::vector<Recording>> at_common_gain(std::vector<Recording> recordings);

/// Factors by which at_common_gain() scales the first audio input of each recording; empty if a recording does not
/// state the input's loudness, or if all factors are within 2 % of 1. Errors: as one_rms().
Result<std::vector<double>> common_gain_factors(std::span<const Recording> recordings);

/// Factor by which at_trained_gain() scales a recording's first audio input; 1 if the model or the recording does not
/// state the input's loudness. Errors: as one_rms().
Result<double> factor_to_trained_gain(const Model& model, const Recording& recording);

/// A recording with its inputs scaled so that 1 stands for the same loudness as in training. An input stays unchanged
/// if the model or the recording does not state its loudness. Errors: as one_rms().
Result<Recording> at_trained_gain(const Model& model, Recording recording);

/// Share of an input's 99th percentile below which it counts as calm: sensors never read exactly 0.
inline constexpr double kCalmShare = 0.1;

struct OutlineInput {
  std::string name;
  std::string unit;    ///< unit in the recording
  double scale = 1;    ///< recording's value that equals 1 in the model, > 0
  double lowest = 0;   ///< lowest observed value, at most 0, in the model's units
  double highest = 0;  ///< highest observed value, at least 0, in the model's units
};

/// The input with its range and its scale: the 95th percentile of |input| over the rows of all recordings in which it
/// exceeds kCalmShare of its 99th percentile. Errors: a recording without that channel, no sample, an input always 0.
Result<OutlineInput> scaled_input(std::span<const Recording> recordings, const std::string& name);

/// The input's value in training that is 1 in the model. Errors: no input of that name, or no training record.
Result<double> trained_scale(const Model& model, const std::string& input);

/// Flags per row: 1 where every input is calm (everywhere without inputs).
std::vector<std::uint8_t> calm_rows(const Recording& recording, std::span<const OutlineInput> inputs);

/// Minimum duration of calm before an object counts as at rest: a flame recovers within a quarter of a second, larger
/// objects take longer, and a remaining lean would be mistaken for the shape at rest.
inline constexpr double kSettleSeconds = 0.5;

/// Flags per row: 1 where every input has been calm for kSettleSeconds within its episode (everywhere without inputs).
std::vector<std::uint8_t> resting_rows(const Recording& recording, std::span<const OutlineInput> inputs);

/// resting_rows() if they last at least 0.5 s in total, else calm_rows() if these do; else empty.
std::vector<std::uint8_t> undisturbed_rows(const Recording& recording, std::span<const OutlineInput> inputs);

/// Height in pixels that is 1 in the model. With inputs it is the median over undisturbed rows, since in some of them
/// an input may act before it is heard. Without inputs or undisturbed rows it is the mean over all rows. 0 if none of
/// these rows has an outline.
double resting_height_pixels(const Recording& recording, const OutlineLayout& layout,
                             std::span<const OutlineInput> inputs);

/// Kinds of regressors made from inputs.
struct RegressorShape {
  bool powers = false;  ///< six regressors in place of NAME: |NAME|, its root and square, then these with NAME's sign
};

/// Names of the regressors of inputs, in the model's order (regressor_count(InputShape)).
std::vector<std::string> regressor_names(std::span<const OutlineInput> inputs, RegressorShape shape);

/// A recording with an input channel for every regressor, in the model's units, in place of its inputs; missing samples
/// stay missing. Precondition: the recording has the inputs.
Recording with_regressors(const Recording& recording, std::span<const OutlineInput> inputs, RegressorShape shape);

/// Mean of every output over the complete rows among those flagged, in the layout's order; empty if there are none.
///
/// Precondition: `rows` is empty or has one entry per row.
std::vector<double> mean_shape(const Recording& recording, const OutlineLayout& layout,
                               std::span<const std::uint8_t> rows);

}  // namespace wisp
