#pragma once
// Triangles with a picture on them, in whole numbers: quick, without seams, the same everywhere.

#include <cstdint>
#include <vector>

#include "wisp/draw/image.hpp"

namespace wisp::drawing {

/// A picture in several sizes, each half the one before; premultiplied ARGB.
struct Texture {
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> pixels;
  };
  std::vector<Level> levels;
};

/// Makes the smaller sizes of a picture.
///
/// Precondition: the picture has at least one pixel and width × height of them.
Texture texture_of(Texture::Level picture);

/// A corner: where it is in the image, what of the texture is there (shares of its size, 0 … 1), and how bright.
struct TexturedCorner {
  float x = 0, y = 0;
  float u = 0, v = 0;
  float light = 1;  ///< times the texture's codes, 0 … 4
};

/// Lays a triangle over the image, `opacity` 0 … 1. Pixels whose middles are on an edge that two triangles share belong
/// to one of them. Triangles of which a corner is more than 16 000 pixels away are left out.
void draw_textured(Image& image, const TexturedCorner& a, const TexturedCorner& b, const TexturedCorner& c,
                   const Texture::Level& texture, float opacity);

}  // namespace wisp::drawing
