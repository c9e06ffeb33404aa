#include "films/outline_film.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "wisp/capture/media/video.hpp"
#include "wisp/draw/film_strip.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/learn/outline_shape.hpp"

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
constexpr int kLeastOverlayHeight = 480;
int enlargement(int height) { return std::max(1, (kLeastOverlayHeight + height - 1) / height); }

std::vector<Point> enlarged(std::vector<Point> outline, int times) {
  for (Point& point : outline) point = {point.x * static_cast<float>(times), point.y * static_cast<float>(times)};
  return outline;
}

// How an overlay is laid out.
struct Layout {
  int times = 1;  // what the clip is enlarged by
  Corner legend = Corner::kTopLeft;
};

// The upper corner that the outlines are farther from on the whole.
Corner roomier_corner(const OutlineRows& rows, int width) {
  double across = 0;
  for (const auto& outline : rows.captured) {
    for (const Point& point : outline) across += point.x - 0.5 * width;
  }
  return across < 0 ? Corner::kTopRight : Corner::kTopLeft;
}

void draw_row(Image& image, const OutlineRows& rows, std::size_t row, const Layout& layout) {
  const LineStyle captured{.colour = kCapturedColour}, simulated{.colour = kSimulatedColour, .dashed = true};
  if (row < rows.captured.size()) draw_outline(image, enlarged(rows.captured[row], layout.times), captured);
  if (row < rows.simulated.size()) draw_outline(image, enlarged(rows.simulated[row], layout.times), simulated);
  const LegendEntry legend[] = {{"captured", captured}, {rows.simulated_label, simulated}};
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

Result<void> overlay_on_black(VideoWriter& film, int width, int height, const Layout& layout, const OutlineRows& rows) {
  for (std::size_t row = 0; row < rows.captured.size(); ++row) {
    Image image(width, height);
    draw_row(image, rows, row, layout);
    if (auto ok = film.write(image); !ok) return ok;
  }
  return film.finish();
}

Result<void> overlay_on_clip(VideoWriter& film, const ClipFrames& clip, const OutlineRows& rows, double rate_hz,
                             const Layout& layout, Terminal& terminal) {
  const std::size_t count = rows.captured.size();
  auto drawn =
      for_each_row(clip, count - 1, [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        Image image = picture();
        if (layout.times > 1) image = resized(image, image.width() * layout.times, image.height() * layout.times);
        draw_row(image, rows, row, layout);
        draw_label(image, seconds_text(static_cast<double>(row) / rate_hz));
        terminal.progress("drawing the overlay", static_cast<double>(row + 1) / static_cast<double>(count));
        return film.write(image);
      });
  if (!drawn) return drawn;
  return film.finish();
}

// The control points of a row, x0, y0, x1, y1, …; empty where one is missing.
std::vector<double> control_points(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  std::vector<double> values;
  for (std::size_t channel : layout.outputs) {
    const double value = recording.channels[channel].samples[row];
    if (std::isnan(value)) return {};
    values.push_back(value);
  }
  return values;
}

OutlineFrame frame_of(const std::vector<double>& control, double pixels_per_unit) {
  const std::size_t last = control.size() - 2;
  return {(control[0] + control[last]) / 2, (control[1] + control[last + 1]) / 2, pixels_per_unit};
}

// A film strip's view of one frame, in the clip's pixels.
struct Cell {
  double width = 0;
  double height = 0;
  double below_base = 0;
};

// The row in the model's units; empty where it has no outline.
std::vector<double> row_units(const Recording& recording, const OutlineLayout& layout, std::size_t row,
                              double pixels_per_unit) {
  const auto control = control_points(recording, layout, row);
  if (control.empty()) return {};
  return to_model_units(control, frame_of(control, pixels_per_unit));
}

Cell cell_of(const StripContent& content) {
  const OutlineCurve curve(content.layout.knots);
  const double unit = content.pixels_per_unit;
  double highest = 1, widest = 0.4;
  for (std::size_t row : content.rows) {
    for (const auto& control : {row_units(*content.recording, content.layout, row, unit),
                                row_units(*content.synthesized, content.synthesized_layout, row, unit)}) {
      if (control.empty()) continue;
      for (const OutlinePoint& point : curve.polyline(control)) {
        highest = std::max(highest, point[1]);
        widest = std::max(widest, std::abs(point[0]));
      }
    }
  }
  return {2.3 * widest * unit, (highest + 0.55) * unit, 0.35 * unit};
}

// The cartoon of an outline in model units, as large as a cell.
Image cartoon(const std::vector<double>& control, const StripContent& content, const Cell& cell) {
  const double scale = 2.0 * kStripCellHeight / cell.height;
  Image image(static_cast<int>(std::lround(cell.width * scale)), 2 * kStripCellHeight);
  std::vector<Point> outline;
  if (!control.empty()) {
    for (const OutlinePoint& point : OutlineCurve(content.layout.knots).polyline(control)) {
      outline.push_back({static_cast<float>(point[0]), static_cast<float>(point[1])});
    }
  }
  FlameScene scene;
  scene.base = {static_cast<float>(image.width() / 2.0), static_cast<float>((cell.height - cell.below_base) * scale)};
  scene.pixels_per_unit = static_cast<float>(content.pixels_per_unit * scale);
  draw_night(image);
  draw_flame(image, outline, scene);
  return image;
}

// The filmed frame around the base; the cartoon of what was captured where there is no film.
Image filmed(const std::vector<double>& control, const Image& frame, const StripContent& content, const Cell& cell) {
  if (control.empty()) return {};
  const OutlineFrame place = frame_of(control, content.pixels_per_unit);
  if (frame.empty()) return cartoon(to_model_units(control, place), content, cell);
  const int width = static_cast<int>(std::lround(cell.width)), height = static_cast<int>(std::lround(cell.height));
  const int left = static_cast<int>(std::lround(place.base_x - cell.width / 2));
  const int top = static_cast<int>(std::lround(place.base_y + cell.below_base - cell.height));
  return crop(frame, {left, top, width, height});
}

Result<std::map<std::size_t, Image>> frames_at(const ClipFrames& clip, const std::vector<std::size_t>& rows) {
  std::map<std::size_t, Image> frames;
  if (clip.path.empty()) return frames;
  auto read =
      for_each_row(clip, rows.back(), [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        if (std::binary_search(rows.begin(), rows.end(), row)) frames[row] = picture();
        return {};
      });
  if (!read) return read.error();
  return frames;
}

}  // namespace

Result<void> write_overlay(const std::filesystem::path& out, const ClipFrames& clip, const Recording& recording,
                           const OutlineRows& rows, Terminal& terminal) {
  const auto width = attribute_number(recording, "width"), height = attribute_number(recording, "height");
  if (!width) return width.error();
  if (!height) return height.error();
  const Layout layout{.times = enlargement(*height), .legend = roomier_corner(rows, *width)};
  const int film_width = *width * layout.times, film_height = *height * layout.times;
  auto film = VideoWriter::create(
      out, {.width = film_width, .height = film_height, .rate_hz = recording.rate_hz, .preset = "veryfast"});
  if (!film) return film.error();
  if (clip.path.empty()) return overlay_on_black(*film, film_width, film_height, layout, rows);
  return overlay_on_clip(*film, clip, rows, recording.rate_hz, layout, terminal);
}

Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content) {
  const auto frames = frames_at(clip, content.rows);
  if (!frames) return frames.error();
  const Cell cell = cell_of(content);
  FilmStrip strip{.rows = {{clip.path.empty() ? "captured" : "filmed", {}}, {content.synthesized_caption, {}}},
                  .frame_height = kStripCellHeight};
  for (std::size_t row : content.rows) {
    const auto found = frames->find(row);
    const auto control = control_points(*content.recording, content.layout, row);
    strip.rows[0].frames.push_back(filmed(control, found == frames->end() ? Image() : found->second, content, cell));
    const auto synthesized = row_units(*content.synthesized, content.synthesized_layout, row, content.pixels_per_unit);
    strip.rows[1].frames.push_back(cartoon(synthesized, content, cell));
    strip.times.push_back(seconds_text(static_cast<double>(row - content.rows.front()) / content.recording->rate_hz));
  }
  const auto image = draw_film_strip(strip);
  if (!image) return image.error();
  return write_png(out, *image);
}

}  // namespace wisp::cli
