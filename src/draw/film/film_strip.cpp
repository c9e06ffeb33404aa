#include "wisp/draw/film_strip.hpp"

#include <algorithm>
#include <cmath>

#include "draw/cairo.hpp"

namespace wisp {

using namespace drawing;

namespace {

constexpr Colour kFilm{14, 13, 15, 255};
constexpr Colour kCaption{236, 230, 220, 255};
constexpr Colour kTime{158, 150, 140, 255};
constexpr Colour kEmpty{26, 25, 27, 255};
constexpr int kGap = 4;  // pixels between frames

// Layout of the strip in whole pixels, which keeps frames sharp.
struct Layout {
  int columns = 0;
  int cell_width = 0;
  int cell_height = 0;
  int margin = 0;
  int caption = 0;  // height of a line of captions with its margins
  int times = 0;    // height of the line of times; 0: none
  int width = 0;
  long height = 0;
  double text = 0;  // height of captions

  int cell_x(int column) const { return margin + column * (cell_width + kGap); }
};

const Image* first_frame(const FilmStrip& strip) {
  for (const FilmRow& row : strip.rows) {
    for (const Image& frame : row.frames) {
      if (!frame.empty()) return &frame;
    }
  }
  return nullptr;
}

Result<Layout> lay_out(const FilmStrip& strip) {
  const Image* frame = first_frame(strip);
  if (frame == nullptr) return Error{"film strip: there are no frames to show"};
  Layout at;
  at.cell_height = std::clamp(strip.frame_height, 16, 2000);
  const double proportion = static_cast<double>(frame->width()) / frame->height();
  at.cell_width = std::max(1, static_cast<int>(std::lround(at.cell_height * proportion)));
  at.text = std::clamp(at.cell_height / 14.0, 11.0, 28.0);
  at.margin = static_cast<int>(std::lround(at.text * 1.4));
  at.times = strip.times.empty() ? 0 : static_cast<int>(std::lround(at.text * 1.5));
  at.caption = static_cast<int>(std::lround(at.text * 2.0));
  std::size_t columns = 0;
  at.height = at.times + at.margin + at.margin / 2;
  for (const FilmRow& row : strip.rows) {
    columns = std::max(columns, row.frames.size());
    at.height += at.cell_height + (row.caption.empty() ? at.margin / 2 : at.caption);
  }
  const auto width = 2.0 * at.margin + static_cast<double>(columns) * (at.cell_width + kGap) - kGap;
  if (width > kLargestImageSide || at.height > kLargestImageSide) {
    return Error{"film strip: " + std::to_string(std::lround(width)) + " x " + std::to_string(at.height) +
                 " pixels are too many; show fewer or smaller frames"};
  }
  at.columns = static_cast<int>(columns);
  at.width = static_cast<int>(width);
  return at;
}

void show_frame(cairo_t* context, const Image& frame, int x, int y, const Layout& at) {
  cairo_rectangle(context, x, y, at.cell_width, at.cell_height);
  set_colour(context, kEmpty);
  cairo_fill(context);
  if (frame.empty()) return;
  // A frame of other proportions is shown whole, in the middle of its cell.
  const double scale = std::min(static_cast<double>(at.cell_width) / frame.width(),
                                static_cast<double>(at.cell_height) / frame.height());
  const int width = std::max(1, static_cast<int>(std::lround(frame.width() * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(frame.height() * scale)));
  Image small = resized(frame, width, height);
  const CairoSurface surface = surface_of(small);
  const int left = (at.cell_width - width) / 2, top = (at.cell_height - height) / 2;  // whole numbers keep pixels sharp
  cairo_set_source_surface(context, surface.get(), x + left, y + top);
  cairo_paint(context);
}

}  // namespace

Result<Image> draw_film_strip(const FilmStrip& strip) {
  const auto layout = lay_out(strip);
  if (!layout) return layout.error();
  const Layout& at = *layout;
  Image image(at.width, static_cast<int>(at.height), kFilm);
  const CairoContext context = context_of(image);
  int y = at.margin / 2;
  for (const FilmRow& row : strip.rows) {
    if (!row.caption.empty()) show_text(context.get(), row.caption, at.margin, y + at.text * 1.35, {at.text}, kCaption);
    y += row.caption.empty() ? at.margin / 2 : at.caption;
    for (std::size_t column = 0; column < row.frames.size(); ++column) {
      show_frame(context.get(), row.frames[column], at.cell_x(static_cast<int>(column)), y, at);
    }
    y += at.cell_height;
  }
  for (std::size_t column = 0; column < strip.times.size() && column < static_cast<std::size_t>(at.columns); ++column) {
    show_text(context.get(), strip.times[column], at.cell_x(static_cast<int>(column)) + at.cell_width / 2.0,
              y + at.text * 1.3, {at.text * 0.8}, kTime, Align::kCentre);
  }
  return image;
}

}  // namespace wisp
