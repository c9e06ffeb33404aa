#include "draw/cairo.hpp"

namespace wisp::drawing {

CairoSurface surface_of(Image& image) {
  return CairoSurface(cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(image.pixels().data()),
                                                          CAIRO_FORMAT_ARGB32, image.width(), image.height(),
                                                          image.width() * 4));
}

CairoContext context_of(Image& image) {
  const CairoSurface surface = surface_of(image);
  return CairoContext(cairo_create(surface.get()));
}

void set_colour(cairo_t* context, Colour colour) {
  cairo_set_source_rgba(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, colour.opacity / 255.0);
}

}  // namespace wisp::drawing
