#pragma once
// Pictures of a bank of flames: its instances as candles side by side.

#include <vector>

#include "wisp/draw/flame.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::cli {

class CandlePictures {
 public:
  /// Sized for the bank's living instances.
  ///
  /// Precondition: bank.polyline_points() > 0 and bank.size() > 0.
  explicit CandlePictures(const Bank& bank);

  int width() const { return width_; }
  int height() const { return height_; }

  /// The bank as it is now. The picture is good until the next call.
  const Image& draw(const Bank& bank);

 private:
  int width_;
  int height_;
  std::vector<FlameScene> scenes_;
  std::vector<float> polylines_;
  std::vector<Point> points_;
  Image image_;
};

}  // namespace wisp::cli
