#pragma once
// What drives a model in `wisp run`: a constant, or a recording brought to the model's rate.

#include <vector>

#include "command.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// One value of every input a frame of the model.
class InputTrack {
 public:
  /// From --input, or from --wind. A recording's channels are found by the model's input names; where its rate differs
  /// from the model's it is resampled linearly; a missing sample holds the one before it. A sound file is listened to:
  /// its wind drives every input. A recording is heard as validate() hears it (in_model_units()), --own-gain by its own
  /// strength. Errors: the recording cannot be read, or has not an input that the model takes; nothing is heard in a
  /// sound file.
  static Result<InputTrack> from(const Model& model, const Arguments& arguments);

  /// Frames of the recording; 0 for a constant.
  std::size_t rows() const { return rows_; }

  /// The inputs at a frame; a recording's last ones after its end.
  std::vector<float> at(std::size_t frame) const;

 private:
  static Result<InputTrack> heard(const Model& model, const std::string& path);

  std::vector<std::vector<float>> tracks_;  // one an input; a constant is a single value
  std::size_t rows_ = 0;
};

/// A channel at another rate, by linear interpolation; missing samples hold the last one before them, 0 at the start.
///
/// Precondition: from_hz > 0 and to_hz > 0.
std::vector<float> at_rate(const std::vector<double>& samples, double from_hz, double to_hz);

}  // namespace wisp::cli
