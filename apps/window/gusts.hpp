#pragma once
// What blows in a scene, from every source that is not sound: keys held, puffs, the pointer's wake.

#include <optional>

#include "wisp/draw/image.hpp"

namespace wisp::window {

/// Wind from keys: the arrows blow as long as they are held, a puff is strong and short. Positive blows to the right;
/// 1 is a strong gust.
class KeyWind {
 public:
  /// How hard the arrows blow: −1, 0 or 1 for left, none or both, right.
  void hold(int direction) { direction_ = direction; }

  /// A strong blow of `strength`, from the left unless the left arrow is held.
  void puff(float strength);

  void advance(float seconds);

  float wind() const { return held_ + puff_; }

  /// Nothing blows any more.
  void calm();

 private:
  int direction_ = 0;
  float held_ = 0;
  float puff_ = 0;
  float puff_peak_ = 0;
  float puff_age_ = 10;
};

/// The wind that a moving pointer drags along: the pointer's own speed, dying away when it rests. Lengths are what the
/// scene measures in.
class PointerWake {
 public:
  /// The pointer is there now.
  void move(Point at);

  /// The pointer left; its wake dies away.
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
