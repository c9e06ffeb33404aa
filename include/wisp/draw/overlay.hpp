#pragma once
// Outlines and labels over a video frame.

#include <span>
#include <string>
#include <string_view>

#include "wisp/draw/image.hpp"

namespace wisp {

/// Colours of captured and simulated outlines, distinguishable on fire and on black, by colour-blind people too.
inline constexpr Colour kCapturedColour{64, 224, 255};
inline constexpr Colour kSimulatedColour{255, 72, 176};

/// Appearance of a line over a picture.
struct LineStyle {
  Colour colour = kCapturedColour;
  float width = 0;  ///< pixels, 0.25 … 50; 0: in proportion to the picture's size
  bool dashed = false;
  bool closed = true;   ///< also connect the last point to the first
  float casing = 1.2F;  ///< width of the dark edge on either side, pixels, 0 … 20: keeps the line visible on the flame
};

/// Draws a polyline in pixels (y down; the centre of the top left pixel is 0.5, 0.5). Points that are not finite
/// interrupt the line.
void draw_outline(Image& image, std::span<const Point> outline, const LineStyle& style = {});

enum class Corner { kTopLeft, kTopRight, kBottomLeft, kBottomRight };

/// One line of a legend.
struct LegendEntry {
  std::string text{};  ///< UTF-8
  LineStyle style{};
};

/// Draws a small legend on a translucent dark plate; `text_height` in pixels, 0: in proportion to the picture's size.
void draw_legend(Image& image, std::span<const LegendEntry> entries, Corner corner = Corner::kTopLeft,
                 float text_height = 0);

/// Draws a line of text on a translucent dark plate (frame number, time).
void draw_label(Image& image, std::string_view text, Corner corner = Corner::kBottomLeft, float text_height = 0);

/// Draws lines of text on a translucent dark plate. A tab divides a line into two columns. `opacity` applies to plate
/// and text, 0 … 1.
void draw_note(Image& image, std::span<const std::string> lines, Corner corner = Corner::kTopLeft,
               float text_height = 0, float opacity = 1);

}  // namespace wisp
