#pragma once
// Inputs of a played model: constant, or from a recording or a sound file at the model's rate.

#include <vector>

#include "command.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Values of all inputs, one per frame of the model.
class InputTrack {
 public:
  /// Reads inputs from --input or --wind. A recording's channels are those of --inputs or those with the model's names,
  /// scaled by in_model_units() as in validate(), with --own-gain by their own strength, and resampled linearly to the
  /// model's rate; missing samples repeat the sample before. A sound file is converted to wind, which drives every
  /// input. Errors: a model without inputs gets one; both flags; the recording cannot be read, lacks an input, lasts
  /// above 1e9 frames or, for a plain model, has another rate; a sound file without wind, or with a flag of tables.
  static Result<InputTrack> from(const Model& model, const Arguments& arguments);

  /// Number of frames of the recording or sound; 0 for a constant.
  std::size_t rows() const { return rows_; }

  /// Returns the inputs at a frame; after the end of the recording, those of its last frame.
  std::vector<float> at(std::size_t frame) const;

 private:
  static Result<InputTrack> heard(const Model& model, const std::string& path);

  std::vector<std::vector<float>> tracks_;  // one per input; a constant is a single value
  std::size_t rows_ = 0;
};

}  // namespace wisp::cli
