#pragma once
// A video camera that looks at the rig, exposed for the flame alone: glowing soot, a faint blue base, black around it,
// sensor noise.

#include <cstdint>
#include <memory>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_rig.hpp"

namespace wisp {

/// The camera. Colours are chosen to look like a photograph of a candle; they are not colorimetry.
struct VirtualCameraOptions {
  int width = 320;              ///< pixels, 16 … 4096; even, as video wants it
  int height = 480;             ///< pixels, 16 … 4096; even
  double pixels_per_mm = 7.5;   ///< 0.5 … 100; at 7.5 a calm flame is about 260 pixels high
  double wick_x = 0.35;         ///< where the candle's axis is, as a share of the width from the left, 0 … 1
  double rim_y = 0.06;          ///< where the candle's upper rim is, as a share of the height from below, 0 … 1
  double gain = 2.5;            ///< exposure: higher is brighter and whiter, 0.01 … 100
  double contrast = 1.8;        ///< steepness of the tone curve, 0.5 … 4: higher gives the flame a sharper edge
  double glow = 0.05;           ///< light scattered in the lens, as a share of the flame's, 0 … 1
  double noise = 1.2;           ///< standard deviation of the sensor's noise in steps of 255, 0 … 50
  bool candle_visible = false;  ///< also show wax and wick, dimly lit; the flame is all that learning wants to see
  std::uint64_t seed = 1;       ///< of the noise
};

/// Where millimetres of the rig (x from the candle's axis, y up from its upper rim) are in the picture.
struct CameraView {
  double origin_x = 0;  ///< pixels from the left edge, of the axis; the middle of the first pixel is at 0
  double origin_y = 0;  ///< pixels from the upper edge, of the rim
  double pixels_per_mm = 1;

  double pixel_x(double mm) const;
  double pixel_y(double mm) const;
};

/// Turns light into pictures.
class VirtualCamera {
 public:
  /// Errors: an option outside its range.
  static Result<VirtualCamera> create(const VirtualCameraOptions& options = {});

  VirtualCamera(VirtualCamera&&) noexcept;
  VirtualCamera& operator=(VirtualCamera&&) noexcept;
  ~VirtualCamera();

  /// The picture of a frame: rows from the top, red, green and blue a byte each, width × height × 3 in all. Valid until
  /// the next call. The same light and frame number give the same bytes.
  ///
  /// Precondition: light.soot and light.blue have columns × rows entries.
  std::span<const std::uint8_t> picture(const FlameLight& light, std::uint64_t frame);

  CameraView view() const;
  const VirtualCameraOptions& options() const;

 private:
  struct Parts;
  explicit VirtualCamera(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wisp
