#pragma once
// A video camera exposed for the flame alone: glowing soot, a faint blue base, black surroundings, sensor noise.

#include <cstdint>
#include <memory>
#include <span>

#include "simulate/candle/candle_rig.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

/// Maps millimetres of the rig (x from the candle's axis, y up from its upper rim) to pixels.
struct CameraView {
  double origin_x = 0;  ///< pixels from the left edge, of the axis; the middle of the first pixel is at 0
  double origin_y = 0;  ///< pixels from the upper edge, of the rim
  double pixels_per_mm = 1;

  double pixel_x(double mm) const;
  double pixel_y(double mm) const;
};

/// Renders light as pictures.
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
