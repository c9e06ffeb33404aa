#pragma once
// The colour of a place on a leaf, before and after light falls on it.

#include "draw/leaf/leaf_view.hpp"
#include "draw/tone.hpp"

namespace wisp::drawing {

/// A leaf's colours as light, fetched once.
class LeafSurface {
 public:
  LeafSurface(const LeafStyle& style, Vec3 towards_lamp);

  /// Light that a place sends to the eye. `normal` is that of the upper side, `to_eye` the way back; both of length 1.
  Light seen(float u, float v, Vec3 normal, Vec3 to_eye) const;

 private:
  Light reflectance(float u, float v, bool upper) const;

  Light upper_, margin_, under_, vein_;
  Vec3 lamp_;
};

}  // namespace wisp::drawing
