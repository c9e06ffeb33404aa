#pragma once
// How a leaf is drawn: vectors in the room, the camera, and the picture of a leaf's side.

#include <array>
#include <cmath>

#include "draw/textured.hpp"
#include "wisp/draw/leaf.hpp"

namespace wisp::drawing {

struct Vec3 {
  float x = 0, y = 0, z = 0;

  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
};

inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(Vec3 a) { return 1 / length(a) * a; }
inline Vec3 vec3(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }

/// Turns a vector of the leaf into the room.
class Turn {
 public:
  explicit Turn(const std::array<float, 4>& attitude);
  Vec3 operator()(Vec3 v) const { return v.x * x_ + v.y * y_ + v.z * z_; }

 private:
  Vec3 x_, y_, z_;
};

/// A place in the picture.
struct Projected {
  float x = 0, y = 0;  ///< pixels
  float depth = 0;     ///< metres from the eye along its gaze; not in view where <= kNear
};
inline constexpr float kNear = 0.01F;

/// A camera over a picture of a given size.
class LeafView {
 public:
  LeafView(const LeafCamera& camera, int width, int height);

  Projected operator()(Vec3 place) const;
  /// Pixels of one metre at a depth.
  float scale_at(float depth) const { return focal_ / depth; }
  /// Where the ray through a pixel goes, not of length 1.
  Vec3 ray(float x, float y) const;
  Vec3 eye() const { return eye_; }
  Vec3 gaze() const { return forward_; }

 private:
  Vec3 eye_, right_, up_, forward_;
  float focal_ = 1;
  float middle_x_ = 0, middle_y_ = 0;
};

/// A leaf's picture reaches from kLeafLeft to kLeafRight along the midrib, in halves of the blade's length from its
/// middle, and as far as kLeafSide to both sides, in halves of its width: the stalk reaches beyond the base.
inline constexpr float kLeafLeft = -1.52F, kLeafRight = 1.06F, kLeafSide = 1.12F;
inline constexpr int kLeafPixels = 192;  ///< along it, of the largest size

/// One side of a flat leaf under a lamp straight above it. Row 0 is where the leaf's y is largest.
Texture painted_side(const LeafStyle& style, bool upper);

}  // namespace wisp::drawing
