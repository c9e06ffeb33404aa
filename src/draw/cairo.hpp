#pragma once
// Owning types for Cairo, and contexts that draw directly into an Image's pixels. Private names of this layer are in
// namespace wisp::drawing, so that they do not collide with those of other layers.

#include <cairo.h>
#include <memory>
#include <string>
#include <string_view>

#include "wisp/draw/image.hpp"

namespace wisp::drawing {

struct DestroyCairo {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using CairoContext = std::unique_ptr<cairo_t, DestroyCairo>;
using CairoSurface = std::unique_ptr<cairo_surface_t, DestroyCairo>;

/// Returns a surface over the image's own pixels, which must neither be freed nor move while the surface exists.
CairoSurface surface_of(Image& image);

/// Returns a context that draws into the image; the pixels are complete once the context is destroyed.
CairoContext context_of(Image& image);

void set_colour(cairo_t* context, Colour colour);

/// Appends bytes that Cairo writes to the std::string at `text`.
cairo_status_t append_bytes(void* text, const unsigned char* data, unsigned length);

struct Font {
  double size = 10;  ///< line height without spacing
  bool bold = false;
};

enum class Align { kLeft, kCentre, kRight };

double text_width(cairo_t* context, std::string_view text, Font font);

/// Draws a line of text; (x, y) is the left end, middle or right end of its base line.
void show_text(cairo_t* context, std::string_view text, double x, double y, Font font, Colour colour,
               Align align = Align::kLeft);

}  // namespace wisp::drawing
