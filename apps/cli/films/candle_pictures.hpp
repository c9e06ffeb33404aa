#pragma once
// Pictures of a bank of outlines: flames as candles side by side, with smoke; other things as plain shapes.

#include <optional>
#include <span>
#include <vector>

#include "films/filmed_flame.hpp"
#include "wisp/draw/live_flames.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::cli {

class CandlePictures {
 public:
  /// Creates pictures for the bank's living instances. Precondition: bank.polyline_points() > 0 and bank.size() > 0.
  CandlePictures(const Model& model, const Bank& bank);

  /// Creates pictures sized for `count` outlines of `points` points, without a bank. Precondition: the view is an
  /// outline, count > 0 and points >= 2.
  CandlePictures(const Model& model, int count, int points);

  /// Lets draw() show the flame on the candle of a film, in the size of the film's view. Precondition: one outline,
  /// film.known(), and the film outlives the pictures.
  void draw_on(const FilmedFlame& film);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Takes the wind of one step, in the model's units, which carries the smoke.
  void blow(const Bank& bank, float wind);

  /// Draws the bank's current state, bodies as the camera sees them. The picture is valid until the next call.
  const Image& draw(const Bank& bank, const Camera& camera = {});

  /// Draws burning flames from consecutive outlines, count × points × (x, y).
  const Image& draw(std::span<const float> outlines);

 private:
  const Image& draw_points();

  int width_;
  int height_;
  std::vector<FlameScene> scenes_;
  std::vector<SmokeDrift> drifts_;
  std::vector<float> polylines_;
  std::vector<Point> points_;
  std::optional<LiveFlames> candles_;  // without a value: draws plain shapes
  const FilmedFlame* film_ = nullptr;
  Image image_;
};

}  // namespace wisp::cli
