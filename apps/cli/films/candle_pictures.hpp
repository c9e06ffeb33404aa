#pragma once
// Pictures of a bank of outlines: flames as candles side by side, smoke and all; other things as plain shapes.

#include <optional>
#include <span>
#include <vector>

#include "wisp/draw/live_flames.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::cli {

class CandlePictures {
 public:
  /// Sized for the living instances of the model's bank.
  ///
  /// Precondition: bank.polyline_points() > 0 and bank.size() > 0.
  CandlePictures(const Model& model, const Bank& bank);

  /// Sized for so many outlines of so many points, which need no bank.
  ///
  /// Precondition: the view is an outline, count > 0 and points >= 2.
  CandlePictures(const Model& model, int count, int points);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Notes the wind of one step of the bank, in the model's units: it carries the smoke.
  void blow(const Bank& bank, float wind);

  /// The bank as it is now. The picture is good until the next call.
  const Image& draw(const Bank& bank);

  /// Outlines, one after the other, count × points × (x, y), that all burn.
  const Image& draw(std::span<const float> outlines);

 private:
  // The mean wind since a flame went out: what its smoke has gone through.
  struct Drift {
    float sum = 0;
    float count = 0;
  };

  int width_;
  int height_;
  std::vector<FlameScene> scenes_;
  std::vector<Drift> drifts_;
  std::vector<float> polylines_;
  std::vector<Point> points_;
  std::optional<LiveFlames> candles_;  // of what is a flame
  Image image_;
};

}  // namespace wisp::cli
