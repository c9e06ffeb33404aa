#include "films/outline_film.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "films/film_look.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/draw/film_strip.hpp"
#include "wisp/draw/live_flames.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/draw/video_writer.hpp"

namespace wisp::cli {
namespace {

constexpr int kStripCellHeight = 220;  // cell height on the strip, pixels; frames are drawn at twice this size

// Visits the clip's frames that have a row in the recording, up to `last_row`.
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

// Minimum height of an overlay: smaller clips are enlarged, so that lines and letters have room.
constexpr int kMinOverlayHeight = 480;
int enlargement(int height) { return std::max(1, (kMinOverlayHeight + height - 1) / height); }

using Outline = std::vector<std::array<double, 2>>;

// Converts from capture, where pixel centres are at integers, to drawing, where they are at halves.
std::vector<Point> enlarged(const Outline& outline, int times) {
  std::vector<Point> points;
  for (const auto& [x, y] : outline) {
    points.push_back({static_cast<float>((x + 0.5) * times), static_cast<float>((y + 0.5) * times)});
  }
  return points;
}

// Layout of an overlay.
struct Layout {
  int times = 1;  // enlargement of the clip
  Corner legend = Corner::kTopLeft;
};

// The upper corner with the larger mean distance from the outlines.
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

// Position of an outline's base (its middle), pixels.
struct Place {
  double x = 0;
  double y = 0;
};

Place base_of(const Outline& outline) {
  return {(outline.front()[0] + outline.back()[0]) / 2, (outline.front()[1] + outline.back()[1]) / 2};
}

// An outline in the model's units: origin at its base, y up.
Outline in_units(Outline outline, double pixels_per_unit) {
  if (outline.empty()) return outline;
  const Place base = base_of(outline);
  for (auto& point : outline) {
    point = {(point[0] - base.x) / pixels_per_unit, (base.y - point[1]) / pixels_per_unit};
  }
  return outline;
}

Outline of_row(const OutlineRows& rows, std::size_t row) { return row < rows.size() ? rows[row] : Outline(); }

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Centre of a film strip's view of a frame: the median base for a fixed camera, whose base varies only by threshold
// noise, and each row's base where camera or candle moves.
class Bases {
 public:
  Bases(const OutlineRows& captured, double unit) {
    std::vector<double> across, down;
    for (const Outline& outline : captured) {
      if (outline.empty()) continue;
      const Place base = base_of(outline);
      across.push_back(base.x);
      down.push_back(base.y);
    }
    if (across.empty()) return;
    middle_ = {median_of(across), median_of(down)};
    for (double& x : across) x = std::abs(x - middle_.x);
    stands_ = median_of(across) < 0.05 * unit;
  }

  Place at(const Outline& outline) const { return stands_ ? middle_ : base_of(outline); }

 private:
  Place middle_{};
  bool stands_ = true;
};

// Size of a film strip's view, in the clip's pixels: contains all flames, within the clip.
struct Cell {
  double width = 0;
  double height = 0;
  double below_base = 0;
};

Cell cell_of(const StripContent& content, const Bases& bases) {
  const double unit = content.pixels_per_unit;
  double highest = 1, widest = 0.4;
  Cell room{.width = 1e9, .height = 1e9, .below_base = 1e9};  // limits of the clip
  const auto look = [&](const Outline& outline) {
    for (const auto& point : in_units(outline, unit)) {
      highest = std::max(highest, point[1]);
      widest = std::max(widest, std::abs(point[0]));
    }
  };
  for (std::size_t row : content.rows) {
    const Outline outline = of_row(content.captured, row);
    look(outline);
    look(of_row(content.synthesized, row));
    if (outline.empty() || content.clip_width == 0) continue;
    const Place base = bases.at(outline);
    room.width = std::min({room.width, 2 * base.x, 2 * (content.clip_width - base.x)});
    room.height = std::min(room.height, base.y);
    room.below_base = std::min(room.below_base, content.clip_height - 1 - base.y);
  }
  const double below = std::clamp(room.below_base, 0.05 * unit, 0.4 * unit);
  const double above = std::clamp(room.height, highest * unit, (highest + 0.4) * unit);
  return {std::clamp(room.width, 2.1 * widest * unit, 2.6 * widest * unit), above + below, below};
}

// Layout and colours of a strip.
struct Strip {
  const StripContent& content;
  Bases bases;
  Cell cell;
  FilmView view;
  FilmLook look;
};

Strip strip_of(const StripContent& content) {
  const Bases bases(content.captured, content.pixels_per_unit);
  const Cell cell = cell_of(content, bases);
  const double scale = 2.0 * kStripCellHeight / cell.height;
  FilmView view{.width = static_cast<int>(std::lround(cell.width * scale)),
                .height = 2 * kStripCellHeight,
                .unit = static_cast<float>(content.pixels_per_unit * scale)};
  view.base = {static_cast<float>(view.width) / 2, static_cast<float>((cell.height - cell.below_base) * scale)};
  return {content, bases, cell, view, FilmLook(view)};
}

// Converts an outline from model units to pixels of the view.
std::vector<Point> in_view(const Outline& units, const FilmView& view) {
  std::vector<Point> points;
  for (const auto& [x, y] : units) {
    points.push_back(
        {view.base.x + view.unit * static_cast<float>(x), view.base.y - view.unit * static_cast<float>(y)});
  }
  return points;
}

// Converts a captured outline from pixels of the clip to pixels of the view.
std::vector<Point> captured_in_view(const Outline& outline, const Strip& strip) {
  const Place base = strip.bases.at(outline);
  Outline units = outline;
  for (auto& point : units) {
    point = {(point[0] - base.x) / strip.content.pixels_per_unit, (base.y - point[1]) / strip.content.pixels_per_unit};
  }
  return in_view(units, strip.view);
}

// Draws a flame as a cartoon, or another outline as a plain shape, at the view's size.
Image cartoon(const Outline& pixels, const Strip& strip) {
  Image image(strip.view.width, strip.view.height);
  std::vector<Point> outline;
  for (const auto& [x, y] : in_units(pixels, strip.content.pixels_per_unit)) {
    outline.push_back({static_cast<float>(x), static_cast<float>(y)});
  }
  FlameScene scene;
  scene.base = strip.view.base;
  scene.pixels_per_unit = strip.view.unit;
  const Flame flame{outline, scene};
  if (!strip.content.flame) {
    draw_shapes(image, {&flame, 1});
    return image;
  }
  LiveFlames(strip.view.width, strip.view.height).draw(image, {&flame, 1});
  return image;
}

// Draws a synthesized outline with the clip's look, or as a cartoon without a clip or for other shapes.
Image synthesized(const Outline& pixels, const Strip& strip) {
  if (pixels.empty()) return {};
  if (!strip.look.known() || !strip.content.flame) return cartoon(pixels, strip);
  return strip.look.draw(in_view(in_units(pixels, strip.content.pixels_per_unit), strip.view));
}

// Cuts the view around the base from a filmed frame.
Image filmed(const Outline& outline, const Image& frame, const Strip& strip) {
  const Place base = strip.bases.at(outline);
  const Cell& cell = strip.cell;
  const int width = static_cast<int>(std::lround(cell.width)), height = static_cast<int>(std::lround(cell.height));
  const int left = static_cast<int>(std::lround(base.x + 0.5 - cell.width / 2));
  const int top = static_cast<int>(std::lround(base.y + 0.5 + cell.below_base - cell.height));
  return resized(crop(frame, {left, top, width, height}), strip.view.width, strip.view.height);
}

// Rows whose frames the look is learned from: the rows shown, and others in the clip's first minute.
std::vector<std::size_t> lesson_of(const StripContent& content) {
  constexpr std::size_t kLessons = 48, kLast = 1800;
  std::vector<std::size_t> rows = content.rows;
  const std::size_t count = std::min(content.captured.size(), kLast);
  for (std::size_t row = 0; row < count; row += std::max<std::size_t>(1, count / kLessons)) rows.push_back(row);
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

// Learns the clip's look and returns the views shown. A row whose frame was lost takes the next frame.
Result<std::map<std::size_t, Image>> watch(const ClipFrames& clip, Strip& strip) {
  std::map<std::size_t, Image> shown;
  const StripContent& content = strip.content;
  if (clip.path.empty()) return shown;
  const std::vector<std::size_t> rows = lesson_of(content);
  auto wanted = rows.begin();
  auto read =
      for_each_row(clip, rows.back(), [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        if (wanted == rows.end() || *wanted > row) return {};
        const Image frame = picture();
        for (; wanted != rows.end() && *wanted <= row; ++wanted) {
          const Outline& outline = content.captured[*wanted];
          if (outline.empty()) continue;
          Image view = filmed(outline, frame, strip);
          if (outline.size() >= 3 && *wanted == row) strip.look.learn(view, captured_in_view(outline, strip));
          if (std::ranges::find(content.rows, *wanted) != content.rows.end()) shown[*wanted] = std::move(view);
        }
        return {};
      });
  if (!read) return read.error();
  return shown;
}

}  // namespace

Result<void> write_overlay(const std::filesystem::path& out, const ClipFrames& clip, const Recording& recording,
                           const OverlayContent& content, Terminal& terminal) {
  const auto width = attribute_number(recording, "width"), height = attribute_number(recording, "height");
  if (!width) return width.error();
  if (!height) return height.error();
  const Layout layout{.times = enlargement(*height), .legend = roomier_corner(content.captured, *width)};
  const int film_width = *width * layout.times, film_height = *height * layout.times;
  auto film =
      VideoWriter::create(out, {.width = film_width, .height = film_height, .rate_hz = recording.rate_hz, .crf = 17});
  if (!film) return film.error();
  if (clip.path.empty()) return overlay_on_black(*film, film_width, film_height, layout, content);
  return overlay_on_clip(*film, clip, content, recording.rate_hz, layout, terminal);
}

Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content) {
  Strip strip = strip_of(content);
  const auto frames = watch(clip, strip);
  if (!frames) return frames.error();
  FilmStrip picture{.rows = {{clip.path.empty() ? "captured" : "filmed", {}}, {content.synthesized_caption, {}}},
                    .frame_height = kStripCellHeight};
  for (const std::size_t row : content.rows) {
    const auto found = frames->find(row);
    const Outline outline = of_row(content.captured, row);
    picture.rows[0].frames.push_back(found != frames->end() ? found->second
                                     : outline.empty()      ? Image()
                                                            : cartoon(outline, strip));
    picture.rows[1].frames.push_back(synthesized(of_row(content.synthesized, row), strip));
    picture.times.push_back(seconds_text(static_cast<double>(row - content.rows.front()) / content.rate_hz));
  }
  const auto image = draw_film_strip(picture);
  if (!image) return image.error();
  return write_png(out, *image);
}

}  // namespace wisp::cli
