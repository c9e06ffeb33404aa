#pragma once
// A video camera exposed for the flame alone: glowing soot, a faint blue base, black surroundings, sensor noise.

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/candle_clip.hpp"

// Samples light between the cells of a grid: the light at a pixel is the mean of 4 × 4 cells, weighted by the cubic
// B-spline kernel. The kernel is nonnegative and smooth: it blurs about as a lens that does not resolve a cell.
namespace wisp::flow {

/// Sample positions along one axis: for each, the first of four cells and their weights.
struct SamplePlaces {
  std::vector<int> first;
  std::vector<float> weight;  ///< four weights per position
};

/// Returns `count` positions start, start + step, … in cells (cell k's centre is k), over an axis of `cells`. Cells
/// outside of the axis have no weight.
SamplePlaces sample_places(int count, double start, double step, int cells);

/// Interpolates one row from four rows of `columns` values. Precondition: out has `columns` entries, values at least
/// columns × (highest used row + 1).
void mix_rows(std::span<const float> values, int columns, const SamplePlaces& rows, int row, std::span<float> out);

/// Returns one sample of an interpolated row.
float sample(std::span<const float> mixed, const SamplePlaces& columns, int place);

}  // namespace wisp::flow

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
  /// all. Valid until the next call. Equal light and frame number give equal bytes. Precondition: light.soot and
  /// light.blue have columns × rows entries.
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
  std::vector<float> steep_;  // table: exposure to the power of the contrast
  flow::SamplePlaces columns_, rows_;
  RigLight seen_;  // grid of the cached sample positions
  std::vector<float> soot_, scattered_, mixed_soot_, mixed_blue_;
  std::vector<std::int16_t> line_;
  std::vector<std::uint8_t> picture_;
};

}  // namespace wisp
