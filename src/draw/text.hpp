#pragma once
// Lines of text by Cairo.

#include <cairo.h>

#include <string>
#include <string_view>

#include "wisp/draw/image.hpp"

namespace wisp::drawing {

struct Font {
  double size = 10;  ///< height of a line without its spacing
  bool bold = false;
};

enum class Align { kLeft, kCentre, kRight };

/// The text with every byte that is not UTF-8 replaced by '?': Cairo would draw nothing more after it.
std::string as_utf8(std::string_view text);

double text_width(cairo_t* context, std::string_view text, Font font);

/// Draws a line of text; (x, y) is the left, middle or right of its base line.
void show_text(cairo_t* context, std::string_view text, double x, double y, Font font, Colour colour,
               Align align = Align::kLeft);

}  // namespace wisp::drawing
