#include "films/filmed_flame.hpp"

#include <algorithm>
#include <cmath>

#include "wisp/capture/media/video.hpp"

namespace wisp::cli {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using Place = std::array<double, 2>;

// Returns the middle of an outline's base.
Place base_of(const Outline& outline) {
  return {(outline.front()[0] + outline.back()[0]) / 2, (outline.front()[1] + outline.back()[1]) / 2};
}

// Adds the rows from whose frames the look is learned: about 48 spread over 1800, which begin at most 450 before the
// first outline. If the camera moves (`stands` is false), the surroundings change: then 24 around the middle outline.
std::vector<std::size_t> lesson_of(const OutlineRows& captured, std::vector<std::size_t> rows, bool stands) {
  constexpr std::size_t kLessons = 48, kLast = 1800, kPassing = 24;
  std::vector<std::size_t> seen;
  for (std::size_t row = 0; row < captured.size(); ++row) {
    if (!captured[row].empty()) seen.push_back(row);
  }
  const std::size_t from = seen.empty() ? 0 : stands ? seen.front() : seen[seen.size() / 2];
  const std::size_t first = from - std::min(from, stands ? kLast / 4 : kPassing / 2);
  const std::size_t last = std::min(captured.size(), first + (stands ? kLast : kPassing));
  for (std::size_t row = first; row < last; row += 1 + (last - first) / kLessons) rows.push_back(row);
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

// Returns whether the flame is out: no outline in the row nor in any of the seven before and after.
bool is_out(const OutlineRows& captured, std::size_t row) {
  constexpr std::size_t kAround = 7;
  const auto first = captured.begin() + static_cast<std::ptrdiff_t>(row - std::min(row, kAround));
  const auto last = captured.begin() + static_cast<std::ptrdiff_t>(std::min(row + kAround + 1, captured.size()));
  return std::all_of(first, last, [](const Outline& outline) { return outline.empty(); });
}

double height_of(const Outline& outline) {
  const auto [x, y] = base_of(outline);
  double farthest = 0;
  for (const auto& point : outline) farthest = std::max(farthest, std::hypot(point[0] - x, point[1] - y));
  return farthest;
}

}  // namespace

ClipFrames clip_of(const Recording& recording, std::filesystem::path path) {
  const auto number = [&](const char* name) {
    const auto values = numbers_attribute(recording, name);
    const bool one = values && *values && (*values)->size() == 1 && std::abs((**values)[0]) < 1e9;
    return one ? static_cast<int>((**values)[0]) : 0;
  };
  ClipFrames clip{.path = std::move(path), .width = number("width"), .height = number("height")};
  clip.first_frame = static_cast<std::size_t>(std::max(1, number("first_frame")) - 1);
  if (std::filesystem::is_directory(clip.path)) clip.rate_hz = recording.rate_hz;
  return clip;
}

Result<void> for_each_row(const ClipFrames& clip, std::size_t last_row,
                          const std::function<Result<void>(std::size_t, const std::function<Image()>&)>& visit) {
  auto reader = VideoReader::open(clip.path, {.rate_hz = clip.rate_hz});
  if (!reader) return reader.error();
  const auto [width, height] = std::pair(reader->info().width, reader->info().height);
  if (clip.width > 0 && clip.height > 0 && (width != clip.width || height != clip.height)) {
    const auto size = [](int w, int h) { return std::to_string(w) + " × " + std::to_string(h); };
    return Error{clip.path.string() + ": its pictures are " + size(width, height) + " pixels, expected " +
                 size(clip.width, clip.height) + ": is it the clip that the recording was captured from?"};
  }
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

Outline in_units(Outline outline, double pixels_per_unit) {
  if (outline.empty()) return outline;
  const auto [x, y] = base_of(outline);
  for (auto& point : outline) point = {(point[0] - x) / pixels_per_unit, (y - point[1]) / pixels_per_unit};
  return outline;
}

FilmedFlame::FilmedFlame(const OutlineRows& captured, double pixels_per_unit, std::array<int, 2> clip_size,
                         const ViewSpace& space, int height)
    : unit_(pixels_per_unit) {
  std::vector<double> across, down;
  for (const Outline& outline : captured) {
    if (outline.empty()) continue;
    across.push_back(base_of(outline)[0]);
    down.push_back(base_of(outline)[1]);
  }
  left_ = right_ = space.beside * unit_;
  above_ = space.above * unit_;
  below_ = space.below * unit_;
  if (!across.empty()) {
    middle_ = {median_of(across), median_of(down)};
    std::vector<double> away = across;
    for (double& x : away) x = std::abs(x - middle_[0]);
    stands_ = median_of(away) < 0.05 * unit_;
    const auto [left, right] = std::ranges::minmax(stands_ ? std::vector{middle_[0]} : across);
    const auto [top, bottom] = std::ranges::minmax(stands_ ? std::vector{middle_[1]} : down);
    if (clip_size[0] > 0) {
      left_ = std::clamp(left, space.least_beside * unit_, left_);
      right_ = std::clamp(clip_size[0] - right, space.least_beside * unit_, right_);
      above_ = std::clamp(top, space.least_above * unit_, above_);
      below_ = std::clamp(clip_size[1] - 1 - bottom, 0.05 * unit_, below_);
    }
  }
  const double scale = height / (above_ + below_);
  view_ = {.width = 2 * static_cast<int>(std::lround((left_ + right_) * scale / 2)),
           .height = height,
           .unit = static_cast<float>(unit_ * scale)};
  view_.base = {static_cast<float>(left_ * scale), static_cast<float>(above_ * scale)};
  look_ = FilmLook(view_);
}

Place FilmedFlame::base_in(const Outline& outline) const {
  return stands_ || outline.empty() ? middle_ : base_of(outline);
}

std::vector<Point> FilmedFlame::in_view(const Outline& outline) const {
  const Place base = base_in(outline);
  const double scale = view_.unit / unit_;
  std::vector<Point> points;
  for (const auto& [x, y] : outline) {
    points.push_back({view_.base.x + static_cast<float>((x - base[0]) * scale),
                      view_.base.y + static_cast<float>((y - base[1]) * scale)});
  }
  return points;
}

Image FilmedFlame::cut(const Outline& outline, const Image& frame) const {
  const Place base = base_in(outline);
  const int width = static_cast<int>(std::lround(left_ + right_));
  const int height = static_cast<int>(std::lround(above_ + below_));
  const int left = static_cast<int>(std::lround(base[0] + 0.5 - left_));
  const int top = static_cast<int>(std::lround(base[1] + 0.5 - above_));
  return resized(crop(frame, {left, top, width, height}), view_.width, view_.height);
}

Result<std::map<std::size_t, Image>> FilmedFlame::watch(const ClipFrames& clip, const OutlineRows& captured,
                                                        const std::vector<std::size_t>& shown) {
  std::map<std::size_t, Image> views;
  const std::vector<std::size_t> rows = lesson_of(captured, shown, stands_);
  auto wanted = rows.begin();
  if (clip.path.empty() || rows.empty()) return views;
  auto read =
      for_each_row(clip, rows.back(), [&](std::size_t row, const std::function<Image()>& picture) -> Result<void> {
        if (wanted == rows.end() || *wanted > row) return {};
        const Image frame = picture();
        for (; wanted != rows.end() && *wanted <= row; ++wanted) {
          const Outline& outline = captured[*wanted];
          if (outline.empty() && !is_out(captured, *wanted)) continue;
          Image view = cut(outline, frame);
          if (*wanted == row) look_.learn(view, in_view(outline));
          if (!outline.empty() && std::ranges::find(shown, *wanted) != shown.end()) views[*wanted] = std::move(view);
        }
        return {};
      });
  if (!read) return read.error();
  look_.finish();
  return views;
}

Image FilmedFlame::draw(std::span<const Point> outline, float light) const {
  std::vector<Point> points;
  for (const Point p : outline) points.push_back({view_.base.x + view_.unit * p.x, view_.base.y - view_.unit * p.y});
  return look_.draw(points, light);
}

Result<FilmedFlame> filmed_flame(const Recording& recording, int height) {
  const auto rows = outline_rows(recording);
  if (!rows) return rows.error();
  std::vector<double> heights;
  for (const Outline& outline : *rows) {
    if (!outline.empty()) heights.push_back(height_of(outline));
  }
  const auto source = find_attribute(recording, "source");
  if (!source || heights.empty()) {
    return Error{recording.source + ": does not name the film that it was captured from, or has no outline"};
  }
  const ClipFrames clip = clip_of(recording, *source);
  FilmedFlame out(*rows, median_of(std::move(heights)), {clip.width, clip.height}, {}, height);
  if (const auto watched = out.watch(clip, *rows); !watched) return watched.error();
  if (!out.known()) return Error{clip.path.string() + ": no frame of it has an outline of " + recording.source};
  return out;
}

}  // namespace wisp::cli
