#pragma once
// Textured triangles in integer arithmetic: fast, without seams, and identical on every machine.

#include <cstdint>
#include <vector>

#include "wisp/draw/image.hpp"

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

/// Builds the smaller sizes of a picture.
///
/// Precondition: the picture has at least one pixel and width × height of them.
Texture texture_of(Texture::Level picture);

/// A corner: its position in the image, its position in the texture (shares of the size, 0 … 1), and its brightness.
struct TexturedCorner {
  float x = 0, y = 0;
  float u = 0, v = 0;
  float light = 1;  ///< factor of the texture's codes, 0 … 4
};

/// Draws a triangle over the image with `opacity` 0 … 1. Pixels whose centres are on an edge shared by two triangles
/// belong to one of them. Triangles with a corner more than 16 000 pixels away are skipped.
void draw_textured(Image& image, const TexturedCorner& a, const TexturedCorner& b, const TexturedCorner& c,
                   const Texture::Level& texture, float opacity);

}  // namespace wisp::drawing
