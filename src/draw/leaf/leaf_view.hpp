#pragma once
// Drawing of leaves: vectors, camera, textured triangles in integer arithmetic (fast, without seams, and identical on
// every machine), and the texture of a leaf's side.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "wisp/draw/image.hpp"
#include "wisp/draw/leaf.hpp"

namespace wisp::drawing {

/// A picture at several sizes, each half of the one before; premultiplied ARGB.
struct Texture {
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> pixels;
  };
  std::vector<Level> levels;
};

/// Builds the smaller sizes of a picture. Precondition: it has at least one pixel and width × height of them.
Texture texture_of(Texture::Level picture);

/// A triangle corner: position in the image, position in the texture (shares of the size, 0 … 1), and brightness.
struct TexturedCorner {
  float x = 0, y = 0;
  float u = 0, v = 0;
  float light = 1;  ///< factor of the texture's codes, 0 … 4
};

/// Draws a triangle over the image with `opacity` 0 … 1. Pixels whose centres are on an edge shared by two triangles
/// belong to one of them. Triangles with a corner more than 16 000 pixels away are skipped.
void draw_textured(Image& image, const TexturedCorner& a, const TexturedCorner& b, const TexturedCorner& c,
                   const Texture::Level& texture, float opacity);

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

/// Rotates a vector from the leaf's axes to the room's.
class Turn {
 public:
  explicit Turn(const std::array<float, 4>& attitude);
  Vec3 operator()(Vec3 v) const { return v.x * x_ + v.y * y_ + v.z * z_; }

 private:
  Vec3 x_, y_, z_;
};

struct Projected {
  float x = 0, y = 0;  ///< pixels
  float depth = 0;     ///< metres from the eye along the view direction; invisible where <= kNear
};
inline constexpr float kNear = 0.01F;

/// A camera over a picture of a given size.
class LeafView {
 public:
  LeafView(const LeafCamera& camera, int width, int height);

  Projected operator()(Vec3 place) const;
  /// Returns the pixels per metre at a depth.
  float scale_at(float depth) const { return focal_ / depth; }
  /// Returns the direction of the ray through a pixel, not normalised.
  Vec3 ray(float x, float y) const;
  Vec3 eye() const { return eye_; }
  Vec3 gaze() const { return forward_; }

 private:
  Vec3 eye_, right_, up_, forward_;
  float focal_ = 1;
  float middle_x_ = 0, middle_y_ = 0;
};

/// Extent of a leaf's texture: from kLeafLeft to kLeafRight along the midrib, in halves of the blade's length from its
/// centre, and ±kLeafSide across, in halves of its width. The stalk extends beyond the base.
inline constexpr float kLeafLeft = -1.52F, kLeafRight = 1.06F, kLeafSide = 1.12F;
inline constexpr int kLeafPixels = 192;  ///< texture length in pixels at the largest size

/// Paints the texture of one side of a flat leaf under a lamp directly above. Row 0 has the largest y.
Texture painted_side(const LeafStyle& style, bool upper);

}  // namespace wisp::drawing
