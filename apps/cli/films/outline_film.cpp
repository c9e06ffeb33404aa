#include "films/outline_film.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "wisp/draw/film_strip.hpp"
#include "wisp/draw/live_flames.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/draw/video_writer.hpp"

namespace wisp::cli {
namespace {

constexpr int kStripCellHeight = 220;  // cell height on the strip, pixels; frames are drawn at twice this size

// Minimum height of an overlay: smaller clips are enlarged, so that lines and letters have room.
constexpr int kMinOverlayHeight = 480;
int enlargement(int height) { return std::max(1, (kMinOverlayHeight + height - 1) / height); }

// Enlarges an outline, and moves it from capture (pixel centres at integers) to drawing (pixel centres at halves).
std::vector<Point> enlarged(const Outline& outline, int times) {
  std::vector<Point> points;
  for (const auto& [x, y] : outline) {
    points.push_back({static_cast<float>((x + 0.5) * times), static_cast<float>((y + 0.5) * times)});
  }
  return points;
}

struct Layout {
  int times = 1;  // enlargement of the clip
  Corner legend = Corner::kTopLeft;
};

// Returns the upper corner that is horizontally farther from the outlines' mean.
Corner roomier_corner(const OutlineRows& captured, int width) {
  double across = 0;
  for (const Outline& outline : captured) {
    for (const auto& point : outline) across += point[0] + 0.5 - 0.5 * width;
  }
  return across < 0 ? Corner::kTopRight : Corner::kTopLeft;
}

void draw_row(Image& image, const OverlayContent& content, std::size_t row, const Layout& layout) {
  const LineStyle captured{.colour = kCapturedColour}, simulated{.colour = kSimulatedColour, .dashed = true};
  draw_outline(image, enlarged(content.captured[row], layout.times), captured);
  draw_outline(image, enlarged(content.simulated[row], layout.times), simulated);
  const LegendEntry legend[] = {{"captured", captured}, {content.simulated_label, simulated}};
  draw_legend(image, legend, layout.legend);
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", seconds);
  return text;
}

Result<void> overlay_on_black(VideoWriter& film, int width, int height, const Layout& layout,
                              const OverlayContent& content) {
  for (std::size_t row = 0; row < content.captured.size(); ++row) {
    Image image(width, height);
    draw_row(image, content, row, layout);
    if (auto ok = film.write(image); !ok) return ok;
  }
  return film.finish();
}

Result<void> overlay_on_clip(VideoWriter& film, const ClipFrames& clip, const OverlayContent& content, double rate_hz,
                             const Layout& layout, Terminal& terminal) {
  const std::size_t count = content.captured.size();
  std::size_t reached = 0;
  auto drawn =
      for_each_row(clip, count - 1, [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        Image image = picture();
        if (layout.times > 1) image = resized(image, image.width() * layout.times, image.height() * layout.times);
        draw_row(image, content, row, layout);
        draw_label(image, seconds_text(static_cast<double>(row) / rate_hz));
        reached = row + 1;
        terminal.progress("drawing the overlay", static_cast<double>(reached) / static_cast<double>(count));
        return film.write(image);
      });
  if (!drawn) return drawn;
  const std::string ends = clip.path.string() + ": ends after " + std::to_string(reached) + " of the recording's " +
                           std::to_string(count) + " rows: is it the clip that the recording was captured from?";
  if (reached == 0) return Error{ends};
  if (reached < count) terminal.warn(ends);
  return film.finish();
}

Outline of_row(const OutlineRows& rows, std::size_t row) { return row < rows.size() ? rows[row] : Outline(); }

// Returns the space of a strip's view, large enough for all outlines.
ViewSpace space_of(const StripContent& content) {
  double highest = 1, widest = 0.4;
  for (const OutlineRows* rows : {&content.captured, &content.synthesized}) {
    for (const std::size_t row : content.rows) {
      for (const auto& point : in_units(of_row(*rows, row), content.pixels_per_unit)) {
        highest = std::max(highest, point[1]);
        widest = std::max(widest, std::abs(point[0]));
      }
    }
  }
  return {1.3 * widest, 1.05 * widest, highest + 0.4, highest, 0.4};
}

std::vector<Point> points_of(const Outline& units) {
  std::vector<Point> points;
  for (const auto& [x, y] : units) points.push_back({static_cast<float>(x), static_cast<float>(y)});
  return points;
}

// Draws a flame as a cartoon, or another outline as a plain shape, at the view's size.
Image cartoon(const std::vector<Point>& outline, const StripContent& content, const FilmView& view) {
  Image image(view.width, view.height);
  FlameScene scene;
  scene.base = view.base;
  scene.pixels_per_unit = view.unit;
  const Flame flame{outline, scene};
  if (!content.flame) {
    draw_shapes(image, {&flame, 1});
    return image;
  }
  LiveFlames(view.width, view.height).draw(image, {&flame, 1});
  return image;
}

// Draws an outline with the clip's look, or as a cartoon without a clip or for other shapes.
Image drawn(const Outline& pixels, const StripContent& content, const FilmedFlame& flame, bool as_filmed) {
  if (pixels.empty()) return {};
  const std::vector<Point> outline = points_of(in_units(pixels, content.pixels_per_unit));
  return as_filmed && flame.known() && content.flame ? flame.draw(outline) : cartoon(outline, content, flame.view());
}

}  // namespace

Result<void> write_overlay(const std::filesystem::path& out, const ClipFrames& clip, const Recording& recording,
                           const OverlayContent& content, Terminal& terminal) {
  if (std::min(clip.width, clip.height) < 16 || std::max(clip.width, clip.height) > kLargestImageSide) {
    return Error{recording.source + ": does not say its picture's width and height; validate against the clip itself " +
                 "for an overlay"};
  }
  const Layout layout{.times = enlargement(clip.height), .legend = roomier_corner(content.captured, clip.width)};
  const int film_width = clip.width * layout.times, film_height = clip.height * layout.times;
  auto film =
      VideoWriter::create(out, {.width = film_width, .height = film_height, .rate_hz = recording.rate_hz, .crf = 17});
  if (!film) return film.error();
  if (clip.path.empty()) return overlay_on_black(*film, film_width, film_height, layout, content);
  return overlay_on_clip(*film, clip, content, recording.rate_hz, layout, terminal);
}

Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content) {
  FilmedFlame flame(content.captured, content.pixels_per_unit, {clip.width, clip.height}, space_of(content),
                    2 * kStripCellHeight);
  const auto frames = flame.watch(clip, content.captured, content.rows);
  if (!frames) return frames.error();
  FilmStrip picture{.rows = {{clip.path.empty() ? "captured" : "filmed", {}}, {content.synthesized_caption, {}}},
                    .frame_height = kStripCellHeight};
  for (const std::size_t row : content.rows) {
    const auto found = frames->find(row);
    picture.rows[0].frames.push_back(
        found != frames->end() ? found->second : drawn(of_row(content.captured, row), content, flame, false));
    picture.rows[1].frames.push_back(drawn(of_row(content.synthesized, row), content, flame, true));
    picture.times.push_back(seconds_text(static_cast<double>(row - content.rows.front()) / content.rate_hz));
  }
  const auto image = draw_film_strip(picture);
  if (!image) return image.error();
  return write_png(out, *image);
}

}  // namespace wisp::cli
