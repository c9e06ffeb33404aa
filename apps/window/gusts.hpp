#pragma once
// Wind in a scene from sources other than sound: arrow keys, puffs, the pointer's wake.

#include <optional>

#include "wisp/draw/image.hpp"

namespace wisp::window {

/// Wind from keys: the arrows blow as long as they are held, a puff is strong and short. Positive blows to the right;
/// 1 is a strong gust.
class KeyWind {
 public:
  /// Sets the direction of the held arrows: −1 left, 0 none or both, 1 right.
  void hold(int direction) { direction_ = direction; }

  /// A strong blow of `strength`, from the left unless the left arrow is held.
  void puff(float strength);

  void advance(float seconds);

  float wind() const { return held_ + puff_; }

  /// Stops all wind at once.
  void calm();

 private:
  int direction_ = 0;
  float held_ = 0;
  float puff_ = 0;
  float puff_peak_ = 0;
  float puff_age_ = 10;
};

/// The wind behind a moving pointer: the pointer's own speed, decaying when it rests. Lengths are in the scene's unit.
class PointerWake {
 public:
  /// Moves the pointer to `at`.
  void move(Point at);

  /// The pointer left the scene; its wake decays.
  void leave() { last_.reset(); }

  void advance(float seconds);

  Point at() const { return at_; }

  /// Lengths a second.
  Point speed() const { return speed_; }

 private:
  std::optional<Point> last_;
  Point at_{};
  Point moved_{};
  Point speed_{};
};

}  // namespace wisp::window
