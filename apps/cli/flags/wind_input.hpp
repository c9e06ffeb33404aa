#pragma once
// Inputs of a model in `wisp run`: a constant, or a recording resampled to the model's rate.

#include <vector>

#include "command.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Values of all inputs, one per frame of the model.
class InputTrack {
 public:
  /// Inputs from --input or --wind. A recording's channels are matched by the model's input names and resampled
  /// linearly to the model's rate; missing samples repeat the one before. A sound file is converted to wind, which
  /// drives every input. A recording is scaled as in validate() (in_model_units()), with --own-gain by its own
  /// strength. Errors: the recording cannot be read, or lacks an input of the model; a silent sound file.
  static Result<InputTrack> from(const Model& model, const Arguments& arguments);

  /// Number of frames of the recording; 0 for a constant.
  std::size_t rows() const { return rows_; }

  /// The inputs at a frame; after the recording's end, its last ones.
  std::vector<float> at(std::size_t frame) const;

 private:
  static Result<InputTrack> heard(const Model& model, const std::string& path);

  std::vector<std::vector<float>> tracks_;  // one per input; a constant is a single value
  std::size_t rows_ = 0;
};

}  // namespace wisp::cli
