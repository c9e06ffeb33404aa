#include "draw/cairo.hpp"

#include <algorithm>

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

cairo_status_t append_bytes(void* text, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

namespace {

// Returns the length of the UTF-8 sequence with which the text begins; 0 if it begins with none (RFC 3629).
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const auto follows = [&](std::size_t k, unsigned low, unsigned high) {
    return k < text.size() && byte(k) >= low && byte(k) <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first == 0 ? 0 : 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1, 0x80, 0xBF) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const unsigned low = first == 0xE0 ? 0xA0 : 0x80;
    const unsigned high = first == 0xED ? 0x9F : 0xBF;
    return follows(1, low, high) && follows(2, 0x80, 0xBF) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const unsigned low = first == 0xF0 ? 0x90 : 0x80;
    const unsigned high = first == 0xF4 ? 0x8F : 0xBF;
    return follows(1, low, high) && follows(2, 0x80, 0xBF) && follows(3, 0x80, 0xBF) ? 4 : 0;
  }
  return 0;
}

void choose(cairo_t* context, Font font) {
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, font.size);
}

// Returns the text with every invalid UTF-8 byte, at which Cairo would stop drawing, replaced by '?'.
std::string as_utf8(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0)
      clean += '?';
    else
      clean += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return clean;
}

}  // namespace

double text_width(cairo_t* context, std::string_view text, Font font) {
  choose(context, font);
  cairo_text_extents_t extents;
  cairo_text_extents(context, as_utf8(text).c_str(), &extents);
  return extents.x_advance;
}

void show_text(cairo_t* context, std::string_view text, double x, double y, Font font, Colour colour, Align align) {
  if (align != Align::kLeft) x -= text_width(context, text, font) * (align == Align::kCentre ? 0.5 : 1);
  choose(context, font);
  set_colour(context, colour);
  cairo_move_to(context, x, y);
  cairo_show_text(context, as_utf8(text).c_str());
  cairo_new_path(context);
}

}  // namespace wisp::drawing
