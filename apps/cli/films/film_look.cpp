#include "films/film_look.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace wisp::cli {
namespace {

// Size of the table of the flame's colours. Height is relative to the outline's own height, since a stretched flame
// stretches its colours; depth is in mean flame heights, since the widths of glow and edge depend on the camera.
constexpr int kHeights = 40;
constexpr float kTop = 1.6F;
constexpr int kDepths = 48;
constexpr float kOutside = -0.30F, kInside = 0.18F;

// Depths between which the glow fades: none beyond kGlowEnds, full from kGlowWhole inwards.
constexpr float kGlowEnds = -0.26F, kGlowWhole = -0.10F;

// Heights above the base in mean flame heights, for stillness(): 1 below kUnder, falling to 0 at kFootBegins; of pixels
// of low variance, such as the wick, 1 up to kFootBegins, falling to 0 at kFootEnds.
constexpr float kUnder = -0.04F, kFootBegins = 0.05F, kFootEnds = 0.22F;

// Standard deviations over time, in 8-bit codes: a pixel below kStill is still, above kMoves it moves.
constexpr float kStill = 6, kMoves = 18;

// Returns a smooth step: 0 at `low` and beyond, 1 at `high`; `high` may be below `low`.
float smooth(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

float square(float value) { return value * value; }

// An edge of an outline, prepared for the computation of distances.
struct Edge {
  Point from, along;  // `along`: vector to the other end
  float inverse = 0;  // inverse of the squared length

  float square_distance(Point p) const {
    const float x = p.x - from.x, y = p.y - from.y;
    const float share = std::clamp((x * along.x + y * along.y) * inverse, 0.0F, 1.0F);
    return square(x - share * along.x) + square(y - share * along.y);
  }
};

// Signed distance of the pixels of one row to an outline, from the edges near the row.
class Depths {
 public:
  Depths(std::span<const Point> outline, float y, float reach) : y_(y), reach_(reach) {
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Point a = outline[k], b = outline[(k + 1) % outline.size()];
      if (std::max(a.y, b.y) < y - reach || std::min(a.y, b.y) > y + reach) continue;
      const Point along{b.x - a.x, b.y - a.y};
      const float length = square(along.x) + square(along.y);
      near_.push_back({a, along, length > 0 ? 1 / length : 0});
      if ((a.y > y) != (b.y > y)) crossings_.push_back(a.x + (y - a.y) / along.y * along.x);
    }
  }

  // Returns the depth in pixels, positive inside, clamped to ±`reach`.
  float at(float x) const {
    float nearest = square(reach_);
    for (const Edge& edge : near_) nearest = std::min(nearest, edge.square_distance({x, y_}));
    const auto beyond = std::ranges::count_if(crossings_, [x](float crossing) { return x < crossing; });
    return beyond % 2 != 0 ? std::sqrt(nearest) : -std::sqrt(nearest);
  }

 private:
  float y_, reach_;
  std::vector<Edge> near_;
  std::vector<float> crossings_;  // x at which the outline crosses the row
};

// Position of a pixel relative to an outline; depths in mean flame heights, positive inside.
struct FlamePlace {
  float height = 0;        // 0 at the base, 1 at the outline's top
  float depth = 0;         // distance to the nearest point of the outline
  float colour_depth = 0;  // depth; above the top its horizontal part, as the glow above a tip stays narrow
};

// Positions of the pixels of one row.
class Places {
 public:
  Places(const FilmView& view, std::span<const Point> outline, int y)
      : view_(view), reach_(-kOutside * view.unit), depths_(outline, static_cast<float>(y) + 0.5F, reach_) {
    const auto [left, right] = std::ranges::minmax_element(outline, {}, &Point::x);
    left_ = left->x - reach_;
    right_ = right->x + reach_;
    const float top = std::ranges::min_element(outline, {}, &Point::y)->y;
    const float middle = static_cast<float>(y) + 0.5F, tall = std::max(0.2F * view.unit, view.base.y - top);
    height_ = std::max(0.0F, (view.base.y - middle) / tall);
    above_top_ = std::max(0.0F, (top - middle) / view.unit);
  }

  FlamePlace at(int x) const {
    const float middle = static_cast<float>(x) + 0.5F;
    if (above_top_ >= -kOutside || middle < left_ || middle > right_) return {height_, kOutside, kOutside};
    const float depth = depths_.at(middle) / view_.unit;
    return {height_, depth, above_top_ > 0 ? -std::sqrt(std::max(0.0F, square(depth) - square(above_top_))) : depth};
  }

 private:
  const FilmView& view_;
  float reach_;
  Depths depths_;
  float left_ = 0, right_ = 0, height_ = 0, above_top_ = 0;  // above_top_: mean flame heights
};

float height_index(float height) { return std::clamp(height / kTop, 0.0F, 1.0F) * (kHeights - 1); }
float depth_index(float depth) {
  return std::clamp((depth - kOutside) / (kInside - kOutside), 0.0F, 1.0F) * (kDepths - 1);
}

float light_of(std::uint32_t pixel) {
  return static_cast<float>((pixel >> 16 & 0xFFU) + (pixel >> 8 & 0xFFU) + (pixel & 0xFFU)) / 3;
}

template <class Sum>
void add(Sum& sum, std::uint32_t pixel, float weight = 1) {
  for (int c = 0; c < 3; ++c) sum[c] += weight * static_cast<float>(pixel >> (16 - 8 * c) & 0xFFU);
  sum[3] += weight;
}

template <class Sum>
Sum mean(const Sum& sum) {
  return sum[3] == 0 ? sum : Sum{sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3], 1};
}

template <class Sum>
Sum mix(const Sum& a, const Sum& b, float share) {
  Sum out{};
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = a[c] + share * (b[c] - a[c]);
  return out;
}

// Fills gaps of a row or column by linear interpolation between filled neighbours.
template <class Sum>
void fill_gaps(Sum* line, int count, int stride) {
  int before = -1;
  for (int k = 0; k <= count; ++k) {
    if (k < count && line[k * stride][3] == 0) continue;
    for (int gap = before + 1; gap < k; ++gap) {
      if (before < 0 && k == count) return;
      const float share = static_cast<float>(gap - before) / static_cast<float>(k - before);
      line[gap * stride] = before < 0   ? line[k * stride]
                           : k == count ? line[before * stride]
                                        : mix(line[before * stride], line[k * stride], share);
    }
    before = k;
  }
}

// Returns the means of a table of sums, row by row, with gaps filled along rows and then along columns.
template <class Sum>
std::vector<Sum> filled_means(const std::vector<Sum>& sums, int rows, int columns) {
  std::vector<Sum> table(sums.size());
  std::ranges::transform(sums, table.begin(), [](const Sum& sum) { return mean(sum); });
  for (int i = 0; i < rows; ++i) fill_gaps(table.data() + static_cast<std::ptrdiff_t>(i) * columns, columns, 1);
  for (int j = 0; j < columns; ++j) fill_gaps(table.data() + j, rows, columns);
  return table;
}

template <class Sum>
Sum bilinear(const std::vector<Sum>& table, float height, float depth) {
  const int i = std::min(static_cast<int>(height), kHeights - 2), j = std::min(static_cast<int>(depth), kDepths - 2);
  const float a = height - static_cast<float>(i), b = depth - static_cast<float>(j);
  const Sum* at = table.data() + static_cast<std::ptrdiff_t>(i) * kDepths + j;
  return mix(mix(at[0], at[1], b), mix(at[kDepths], at[kDepths + 1], b), a);
}

}  // namespace

FilmLook::FilmLook(const FilmView& view)
    : view_(view),
      flame_(static_cast<std::size_t>(kHeights) * kDepths),
      around_(static_cast<std::size_t>(view.width) * view.height),
      still_(around_.size()),
      squares_(around_.size()),
      out_(around_.size()) {
  assert(view.width >= 1 && view.height >= 1 && view.unit > 0);
}

void FilmLook::learn(const Image& frame, std::span<const Point> outline) {
  assert(frame.width() == view_.width && frame.height() == view_.height);
  for (int y = 0; outline.empty() && y < view_.height; ++y) {
    for (int x = 0; x < view_.width; ++x) add(out_[static_cast<std::size_t>(y) * view_.width + x], frame.row(y)[x]);
  }
  if (outline.size() < 3) return;
  for (int y = 0; y < view_.height; ++y) {
    const Places places(view_, outline, y);
    const auto row = frame.row(y);
    for (int x = 0; x < view_.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * view_.width + x;
      const FlamePlace place = places.at(x);
      add(still_[pixel], row[x]);
      squares_[pixel] += square(light_of(row[x]));
      // Weights frames by the distance to the flame, with a minimum for pixels near the flame in every frame.
      if (place.depth <= kGlowWhole) add(around_[pixel], row[x], 0.001F + smooth(kGlowWhole, kOutside, place.depth));
      if (place.height <= 0 || (place.depth <= kOutside && place.colour_depth > kOutside)) continue;
      const auto i = static_cast<std::size_t>(std::lround(height_index(place.height)));
      const auto j = static_cast<std::size_t>(std::lround(depth_index(place.colour_depth)));
      add(flame_[i * kDepths + j], row[x]);
    }
  }
  ++frames_;
}

// Returns the confidence, 0 to 1, that a pixel shows no moving flame. `height`: mean flame heights above the base.
float FilmLook::stillness(std::size_t pixel, float height) const {
  const Sum code = mean(still_[pixel]);
  const float variance = squares_[pixel] / still_[pixel][3] - square((code[0] + code[1] + code[2]) / 3);
  const float still = 1 - smooth(kStill, kMoves, std::sqrt(std::max(0.0F, variance)));
  return std::max(1 - smooth(kUnder, kFootBegins, height), still * (1 - smooth(kFootBegins, kFootEnds, height)));
}

void FilmLook::finish() {
  constexpr float kUnlit = 0.25F;  // share of brightness that stays without the flame, if no frame shows that
  colours_ = filled_means(flame_, kHeights, kDepths);
  plate_ = filled_means(around_, view_.height, view_.width);  // where the flame always is: interpolated
  foot_.resize(plate_.size());
  unlit_.resize(plate_.size());
  over_.resize(plate_.size());
  for (std::size_t pixel = 0; pixel < plate_.size(); ++pixel) {
    const auto row = static_cast<float>(pixel / static_cast<std::size_t>(view_.width));
    over_[pixel] = stillness(pixel, (view_.base.y - row) / view_.unit);
    foot_[pixel] = mean(still_[pixel]);
    unlit_[pixel] =
        out_[pixel][3] > 0 ? mean(out_[pixel]) : mix(Sum{}, mix(plate_[pixel], foot_[pixel], over_[pixel]), kUnlit);
  }
}

Image FilmLook::draw(std::span<const Point> outline, float light) const {
  assert(known() && !colours_.empty());
  Image image(view_.width, view_.height);
  for (int y = 0; y < view_.height; ++y) {
    std::optional<Places> places;
    if (outline.size() >= 3) places.emplace(view_, outline, y);
    for (int x = 0; x < view_.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * view_.width + x;
      const FlamePlace place = places ? places->at(x) : FlamePlace{0, kOutside, kOutside};
      Sum colour = mix(unlit_[pixel], plate_[pixel], light);
      if (const float share = smooth(kGlowEnds, kGlowWhole, place.depth); share > 0) {
        colour = mix(colour, bilinear(colours_, height_index(place.height), depth_index(place.colour_depth)), share);
      }
      if (over_[pixel] > 0) colour = mix(colour, mix(unlit_[pixel], foot_[pixel], light), over_[pixel]);
      std::uint32_t code = 0xFF000000U;
      for (int c = 0; c < 3; ++c)
        code |= static_cast<std::uint32_t>(std::lround(std::clamp(colour[c], 0.0F, 255.0F))) << (16 - 8 * c);
      image.row(y)[x] = code;
    }
  }
  return image;
}

}  // namespace wisp::cli
