#include "films/outline_film.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "wisp/capture/media/video.hpp"
#include "wisp/draw/film_strip.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/draw/video_writer.hpp"

namespace wisp::cli {
namespace {

constexpr int kStripCellHeight = 220;  // pixels on the strip; frames are drawn at twice that

// Visits frames of the clip with their row in the recording, up to `last_row`.
Result<void> for_each_row(const ClipFrames& clip, std::size_t last_row,
                          const std::function<Result<void>(std::size_t, const std::function<Image()>&)>& visit) {
  auto reader = VideoReader::open(clip.path, {.rate_hz = clip.rate_hz});
  if (!reader) return reader.error();
  for (;;) {
    const auto frame = reader->next();
    if (!frame) return frame.error();
    if (!*frame) return {};
    const auto index = static_cast<std::size_t>((*frame)->index);
    if (index < clip.first_frame) continue;
    if (index - clip.first_frame > last_row) return {};
    const auto picture = [&] {
      const RgbImage rgb = reader->rgb();
      return Image::from_rgb(rgb.pixels, rgb.width, rgb.height);
    };
    if (auto ok = visit(index - clip.first_frame, picture); !ok) return ok;
  }
}

// Lines and letters need room: a small clip is drawn larger.
constexpr int kMinOverlayHeight = 480;
int enlargement(int height) { return std::max(1, (kMinOverlayHeight + height - 1) / height); }

using Outline = std::vector<std::array<double, 2>>;

// A pixel's centre is at whole numbers for capture and at halves for drawing.
std::vector<Point> enlarged(const Outline& outline, int times) {
  std::vector<Point> points;
  for (const auto& [x, y] : outline) {
    points.push_back({static_cast<float>((x + 0.5) * times), static_cast<float>((y + 0.5) * times)});
  }
  return points;
}

// How an overlay is laid out.
struct Layout {
  int times = 1;  // what the clip is enlarged by
  Corner legend = Corner::kTopLeft;
};

// The upper corner that the outlines are farther from on the whole.
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

Result<int> attribute_number(const Recording& recording, const char* name) {
  const auto values = numbers_attribute(recording, name);
  if (!values) return values.error();
  if (!*values || (*values)->size() != 1 || (**values)[0] < 16 || (**values)[0] > kLargestImageSide) {
    return Error{recording.source + ": does not say its picture's " + name +
                 "; validate against the clip itself for an overlay"};
  }
  return static_cast<int>((**values)[0]);
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
  auto drawn =
      for_each_row(clip, count - 1, [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        Image image = picture();
        if (layout.times > 1) image = resized(image, image.width() * layout.times, image.height() * layout.times);
        draw_row(image, content, row, layout);
        draw_label(image, seconds_text(static_cast<double>(row) / rate_hz));
        terminal.progress("drawing the overlay", static_cast<double>(row + 1) / static_cast<double>(count));
        return film.write(image);
      });
  if (!drawn) return drawn;
  return film.finish();
}

// The middle of an outline's base, pixels.
struct Place {
  double x = 0;
  double y = 0;
};

Place base_of(const Outline& outline) {
  return {(outline.front()[0] + outline.back()[0]) / 2, (outline.front()[1] + outline.back()[1]) / 2};
}

// An outline in the model's units: about its base, y up.
Outline in_units(Outline outline, double pixels_per_unit) {
  if (outline.empty()) return outline;
  const Place base = base_of(outline);
  for (auto& point : outline) {
    point = {(point[0] - base.x) / pixels_per_unit, (base.y - point[1]) / pixels_per_unit};
  }
  return outline;
}

// A film strip's view of one frame, in the clip's pixels.
struct Cell {
  double width = 0;
  double height = 0;
  double below_base = 0;
};

Cell cell_of(const StripContent& content) {
  const double unit = content.pixels_per_unit;
  double highest = 1, widest = 0.4;
  for (std::size_t row : content.rows) {
    for (const OutlineRows* rows : {&content.captured, &content.synthesized}) {
      for (const auto& point : in_units((*rows)[row], unit)) {
        highest = std::max(highest, point[1]);
        widest = std::max(widest, std::abs(point[0]));
      }
    }
  }
  return {2.3 * widest * unit, (highest + 0.55) * unit, 0.35 * unit};
}

// The cartoon of a flame or the plain shape of another outline, as large as a cell.
Image cartoon(const Outline& pixels, const StripContent& content, const Cell& cell) {
  const double scale = 2.0 * kStripCellHeight / cell.height;
  Image image(static_cast<int>(std::lround(cell.width * scale)), 2 * kStripCellHeight);
  std::vector<Point> outline;
  for (const auto& [x, y] : in_units(pixels, content.pixels_per_unit)) {
    outline.push_back({static_cast<float>(x), static_cast<float>(y)});
  }
  FlameScene scene;
  scene.base = {static_cast<float>(image.width() / 2.0), static_cast<float>((cell.height - cell.below_base) * scale)};
  scene.pixels_per_unit = static_cast<float>(content.pixels_per_unit * scale);
  if (!content.flame) {
    const Flame shape{outline, scene};
    draw_shapes(image, {&shape, 1});
    return image;
  }
  draw_night(image);
  draw_flame(image, outline, scene);
  return image;
}

// The filmed frame around the base; the cartoon of what was captured where there is no film.
Image filmed(const Outline& outline, const Image& frame, const StripContent& content, const Cell& cell) {
  if (outline.empty()) return {};
  if (frame.empty()) return cartoon(outline, content, cell);
  const Place base = base_of(outline);
  const int width = static_cast<int>(std::lround(cell.width)), height = static_cast<int>(std::lround(cell.height));
  const int left = static_cast<int>(std::lround(base.x - cell.width / 2));
  const int top = static_cast<int>(std::lround(base.y + cell.below_base - cell.height));
  return crop(frame, {left, top, width, height});
}

// Of a row whose frame was lost, the next frame.
Result<std::map<std::size_t, Image>> frames_at(const ClipFrames& clip, const std::vector<std::size_t>& rows) {
  std::map<std::size_t, Image> frames;
  if (clip.path.empty()) return frames;
  auto wanted = rows.begin();
  auto read =
      for_each_row(clip, rows.back(), [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        if (wanted == rows.end() || *wanted > row) return {};
        const Image frame = picture();
        for (; wanted != rows.end() && *wanted <= row; ++wanted) frames[*wanted] = frame;
        return {};
      });
  if (!read) return read.error();
  return frames;
}

}  // namespace

Result<void> write_overlay(const std::filesystem::path& out, const ClipFrames& clip, const Recording& recording,
                           const OverlayContent& content, Terminal& terminal) {
  const auto width = attribute_number(recording, "width"), height = attribute_number(recording, "height");
  if (!width) return width.error();
  if (!height) return height.error();
  const Layout layout{.times = enlargement(*height), .legend = roomier_corner(content.captured, *width)};
  const int film_width = *width * layout.times, film_height = *height * layout.times;
  auto film = VideoWriter::create(
      out, {.width = film_width, .height = film_height, .rate_hz = recording.rate_hz, .preset = "veryfast"});
  if (!film) return film.error();
  if (clip.path.empty()) return overlay_on_black(*film, film_width, film_height, layout, content);
  return overlay_on_clip(*film, clip, content, recording.rate_hz, layout, terminal);
}

Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content) {
  const auto frames = frames_at(clip, content.rows);
  if (!frames) return frames.error();
  const Cell cell = cell_of(content);
  FilmStrip strip{.rows = {{clip.path.empty() ? "captured" : "filmed", {}}, {content.synthesized_caption, {}}},
                  .frame_height = kStripCellHeight};
  for (std::size_t row : content.rows) {
    const auto found = frames->find(row);
    const Image frame = found == frames->end() ? Image() : found->second;
    strip.rows[0].frames.push_back(filmed(content.captured[row], frame, content, cell));
    strip.rows[1].frames.push_back(cartoon(content.synthesized[row], content, cell));
    strip.times.push_back(seconds_text(static_cast<double>(row - content.rows.front()) / content.rate_hz));
  }
  const auto image = draw_film_strip(strip);
  if (!image) return image.error();
  return write_png(out, *image);
}

}  // namespace wisp::cli
