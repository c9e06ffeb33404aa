#pragma once
// Cairo, owned: contexts that draw straight into an Image's pixels.
//
// What is private to this layer is in wisp::drawing, so that short names never meet another layer's of the same name.

#include <cairo.h>

#include <memory>

#include "wisp/draw/image.hpp"

namespace wisp::drawing {

struct DestroyCairo {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_pattern_t* pattern) const { cairo_pattern_destroy(pattern); }
};
using CairoContext = std::unique_ptr<cairo_t, DestroyCairo>;
using CairoSurface = std::unique_ptr<cairo_surface_t, DestroyCairo>;
using CairoPattern = std::unique_ptr<cairo_pattern_t, DestroyCairo>;

/// A surface over the image's own pixels, which must outlive it and stay where they are.
CairoSurface surface_of(Image& image);

/// A context that draws into the image; what is drawn is in the pixels once the context is gone.
CairoContext context_of(Image& image);

void set_colour(cairo_t* context, Colour colour);

}  // namespace wisp::drawing
