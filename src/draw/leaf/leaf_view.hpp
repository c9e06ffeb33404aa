#pragma once
// How a leaf is drawn: vectors in the room and the camera; its shape; its surface; its samples.

#include <array>
#include <cmath>
#include <vector>

#include "draw/tone.hpp"
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

// A leaf's shape: a blade with a pointed tip and toothed margins, curled as leaves dry, and its stalk.

/// A corner of the surface.
struct LeafVertex {
  Vec3 place;          ///< in the leaf's axes, metres
  Vec3 normal;         ///< out of the upper side
  float u = 0, v = 0;  ///< along the midrib, 0 base … 1 tip (below 0: the stalk), and across, −1 … 1
};

struct LeafMesh {
  std::vector<LeafVertex> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Fields of the style are clamped to their ranges.
LeafMesh leaf_mesh(const LeafStyle& style);

/// Whether the blade reaches to v at u: its margin has teeth.
bool on_blade(float u, float v);

// The colour of a place on a leaf, before and after light falls on it.

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

// A leaf's triangles as samples of the picture: which are covered, by what part of the leaf, and by what light.

/// Light over a part of the picture, with how much of each pixel it covers.
struct LeafPatch {
  int x = 0, y = 0;  ///< its corner in the picture
  int width = 0, height = 0;
  std::vector<Light> light;  ///< premultiplied by the cover
  std::vector<float> cover;  ///< 0 … 1

  bool empty() const { return width <= 0 || height <= 0; }
};

inline constexpr float kLampRadius = 0.10F;  ///< of the lamp over its distance: how soft shadows are
inline constexpr float kDarkest = 0.62F;     ///< of the floor's light that a shadow takes away

/// Whether a leaf is somewhere, and turned somehow.
bool is_drawable(const LeafPose& pose);

/// A mesh placed in the room.
struct PlacedLeaf {
  Vec3 position;
  Turn turn;
};

/// The leaf as the camera sees it, cut to the picture; empty where nothing of it is in view.
LeafPatch leaf_patch(const LeafMesh& mesh, const PlacedLeaf& leaf, const LeafSurface& surface, const LeafView& view,
                     int width, int height);

/// Its shadow on the floor z = 0: only the cover is filled, with `margin` empty pixels around it for a blur.
LeafPatch shadow_patch(const LeafMesh& mesh, const PlacedLeaf& leaf, Vec3 towards_lamp, const LeafView& view, int width,
                       int height, int margin);

}  // namespace wisp::drawing
