#pragma once
// A video camera exposed for the flame alone: glowing soot, a faint blue base, black surroundings, sensor noise.

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/light_sampling.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

/// Maps millimetres of the rig (x from the candle's axis, y up from its upper rim) to pixels.
struct CameraView {
  double origin_x = 0;  ///< x of the axis, pixels from the left edge; the centre of the first pixel is at 0
  double origin_y = 0;  ///< y of the rim, pixels from the upper edge
  double pixels_per_mm = 1;

  double pixel_x(double mm) const;
  double pixel_y(double mm) const;
};

/// Renders light as pictures.
class VirtualCamera {
 public:
  /// Errors: an option outside its range.
  static Result<VirtualCamera> create(const VirtualCameraOptions& options = {});

  /// Returns the picture of a frame: rows from the top, one byte each of red, green and blue, width × height × 3 in
  /// all. Valid until the next call. Equal light and frame number give equal bytes.
  ///
  /// Precondition: light.soot and light.blue have columns × rows entries.
  std::span<const std::uint8_t> picture(const RigLight& light, std::uint64_t frame);

  CameraView view() const { return view_; }
  const VirtualCameraOptions& options() const { return options_; }

 private:
  explicit VirtualCamera(const VirtualCameraOptions& options);

  void set_places(const RigLight& light);
  void scatter(const RigLight& light);
  void expose_row(const RigLight& light, int row);
  std::int16_t tone(float exposure) const;

  VirtualCameraOptions options_;
  CameraView view_;
  std::vector<std::int16_t> tones_, noise_;
  std::vector<float> steep_;  // exposure by soot, to the power of the contrast
  flow::SamplePlaces columns_, rows_;
  RigLight seen_;  // grid of the cached sample positions
  std::vector<float> soot_, scattered_, mixed_soot_, mixed_blue_;
  std::vector<std::int16_t> line_;
  std::vector<std::uint8_t> picture_;
};

}  // namespace wisp
