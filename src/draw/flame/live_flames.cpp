#include "wisp/draw/live_flames.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "draw/flame/flame_layers.hpp"
#include "draw/flame/night.hpp"

namespace wisp {

using namespace drawing;

namespace {

// The soft grid has cells of 4 × 4 pixels. Rings of the glow that are too narrow for it are added around the flames
// only, in the picture's own pixels.
constexpr int kHalvings = 2;
constexpr int kCell = 1 << kHalvings;

// Beyond this many standard deviations a ring adds nothing that could be seen.
constexpr float kRingReach = 3.5F;

int cells(int pixels) { return (pixels + kCell - 1) / kCell; }

PixelBox grown(PixelBox box, int by, int width, int height) {
  const int left = std::max(0, box.x - by), top = std::max(0, box.y - by);
  const int right = std::min(width, box.x + box.width + by), bottom = std::min(height, box.y + box.height + by);
  if (left >= right || top >= bottom) return {};
  return {left, top, right - left, bottom - top};
}

// Grown to whole cells, and by as much as halving spreads light.
PixelBox on_grid(PixelBox box, int width, int height) {
  const int left = std::max(0, box.x / kCell - 2) * kCell, top = std::max(0, box.y / kCell - 2) * kCell;
  const int right = std::min(width, (cells(box.x + box.width) + 2) * kCell);
  const int bottom = std::min(height, (cells(box.y + box.height) + 2) * kCell);
  return {left, top, right - left, bottom - top};
}

// One row of a grid, or the place between two, as values of the picture's row.
struct Between {
  Between(int pixel, int count) {
    const float at = (static_cast<float>(pixel) + 0.5F) / kCell - 0.5F;
    const int below = static_cast<int>(std::floor(at));
    share = at - static_cast<float>(below);
    first = std::clamp(below, 0, count - 1);
    second = std::clamp(below + 1, 0, count - 1);
  }
  int first = 0, second = 0;
  float share = 0;
};

// Spreads a row of cells over pixels: linear between the middles of cells. `row` has a spare value at either end.
void spread(const Plane& grid, const Between& y, std::vector<float>& row, float* out, int width) {
  const float* a = grid.row(y.first);
  const float* b = grid.row(y.second);
  for (int k = 0; k < grid.width; ++k) row[k + 1] = a[k] + y.share * (b[k] - a[k]);
  row[0] = row[1];
  row[grid.width + 1] = row[grid.width];
  // Each group of pixels lies between the middles of two cells; the first and the last group hang over the edge.
  const int groups = (width + kCell / 2 + kCell - 1) / kCell;
  float* group = out;
  for (int k = 0; k < groups; ++k, group += kCell) {
    const float from = row[k], step = (row[std::min(k + 1, grid.width + 1)] - from) / (2 * kCell);
    for (int r = 0; r < kCell; ++r) group[r] = from + static_cast<float>(2 * r + 1) * step;
  }
}

// The three channels of a row, with room for the groups that hang over both edges.
struct Row {
  explicit Row(int width) {
    for (auto& channel : channels) channel.resize(static_cast<std::size_t>(width) + 2 * kCell);
  }
  const float* operator[](int channel) const { return channels[channel].data() + kCell / 2; }
  std::array<std::vector<float>, 3> channels;
};

void spread(const LightField& grid, const Between& y, std::vector<float>& scratch, Row& row, int width) {
  spread(grid.red, y, scratch, row.channels[0].data(), width);
  spread(grid.green, y, scratch, row.channels[1].data(), width);
  spread(grid.blue, y, scratch, row.channels[2].data(), width);
}

void clear(LightField& field, PixelBox box) {
  for (Plane* plane : {&field.red, &field.green, &field.blue}) {
    for (int y = box.y; y < box.y + box.height; ++y) std::fill_n(plane->row(y) + box.x, box.width, 0.0F);
  }
}

Plane luminance_in(const LightField& field, PixelBox box) {
  Plane plane(box.width, box.height);
  for (int y = 0; y < box.height; ++y) {
    const auto at = [&](const Plane& channel) { return channel.row(box.y + y) + box.x; };
    const float *red = at(field.red), *green = at(field.green), *blue = at(field.blue);
    float* out = plane.row(y);
    for (int x = 0; x < box.width; ++x) out[x] = luminance({red[x], green[x], blue[x]});
  }
  return plane;
}

PixelBox around(PixelBox a, PixelBox b) {
  const int left = std::min(a.x, b.x), top = std::min(a.y, b.y);
  const int right = std::max(a.x + a.width, b.x + b.width), bottom = std::max(a.y + a.height, b.y + b.height);
  return {left, top, right - left, bottom - top};
}

// Pixels where a candle's own light may be: flame and ember.
PixelBox own_light_box(const Candle& candle, int width, int height) {
  const PixelBox& flame = candle.shape.box;
  const PixelBox& wick = candle.wick.box;
  if (candle.wick.empty()) return flame;
  const int ember = static_cast<int>(std::ceil(2.2F * (0.62F * candle.wick.width + 0.5F))) + 2;
  const PixelBox glowing = grown(wick, ember, width, height);
  return candle.shape.empty() ? glowing : around(flame, glowing);
}

bool meet(PixelBox a, PixelBox b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// Boxes that meet become one, until none do: what is added within a box is added to a pixel once.
void merge_meeting(std::vector<PixelBox>& boxes) {
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    for (std::size_t other = k + 1; other < boxes.size(); ++other) {
      if (!meet(boxes[k], boxes[other])) continue;
      boxes[k] = around(boxes[k], boxes[other]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(other));
      other = k;  // The larger box may meet others now.
    }
  }
}

// Writes the codes of pixels that have only the room behind them; a loop that compilers make wide.
void write_codes(const Row& codes, const float* dither, std::uint32_t* out, int first, int last) {
  const float *red = codes[0], *green = codes[1], *blue = codes[2];
  for (int x = first; x < last; ++x) {
    const auto r = static_cast<std::int32_t>(std::min(255.0F, red[x] + dither[x]));
    const auto g = static_cast<std::int32_t>(std::min(255.0F, green[x] + dither[x]));
    const auto b = static_cast<std::int32_t>(std::min(255.0F, blue[x] + dither[x]));
    out[x] = static_cast<std::uint32_t>(-0x1000000 | r << 16 | g << 8 | b);
  }
}

}  // namespace

struct LiveFlames::State {
  State(int width, int height, const FlameStyle& asked)
      : style(held(asked)),
        night(width, height),
        dither(width, height),
        own(width, height),
        glow(cells(width), cells(height)),
        codes(cells(width), cells(height)),
        light_row(width),
        code_row(width),
        scratch(static_cast<std::size_t>(cells(width)) + 2),
        bright(static_cast<std::size_t>(width) + 1) {
    draw_night(night);
    for (int y = 0; y < height; ++y) {
      // As dithered() rounds, so that both ways to a pixel agree.
      for (int x = 0; x < width; ++x) dither.row(y)[x] = 0.004F + 0.992F * dither_at(x, y);
    }
  }

  int width() const { return night.width(); }
  int height() const { return night.height(); }

  void add_glow(std::span<const Candle> candles);
  void add_narrow_rings(std::span<const HaloRing> rings, PixelBox lit);
  void gather(Plane& luminance, PixelBox lit) const;
  void make_codes();
  void show(Image& image);
  void show_row(Image& image, int y);
  void mark_bright(int y);

  FlameStyle style;
  Image night;
  Plane dither;
  LightField own;   // flames and embers, in pixels; dark outside `lit`
  LightField glow;  // what surrounds them, in cells
  LightField codes;
  Row light_row, code_row;
  std::vector<float> scratch;
  std::vector<std::uint8_t> bright;  // pixels of a row that may have own light
  std::vector<PixelBox> lit;
};

// Adds a part of the picture's luminance to the grid.
void LiveFlames::State::gather(Plane& luminance, PixelBox box) const {
  const PixelBox part = on_grid(box, width(), height());
  Plane soft = luminance_in(own, part);
  for (int k = 0; k < kHalvings; ++k) soft = halved(soft);
  const int left = part.x / kCell, top = part.y / kCell;
  for (int y = 0; y < soft.height; ++y) {
    // At a part's edge the light of a neighbouring part is missing, which has it all.
    float* out = luminance.row(top + y) + left;
    for (int x = 0; x < soft.width; ++x) out[x] = std::max(out[x], soft.row(y)[x]);
  }
}

void LiveFlames::State::add_narrow_rings(std::span<const HaloRing> rings, PixelBox box) {
  LightField near(box.width, box.height);
  add_halo(luminance_in(own, box), rings, near);
  for (const auto& [from, to] :
       {std::pair{&near.red, &own.red}, std::pair{&near.green, &own.green}, std::pair{&near.blue, &own.blue}}) {
    for (int y = 0; y < box.height; ++y) {
      float* out = to->row(box.y + y) + box.x;
      for (int x = 0; x < box.width; ++x) out[x] += from->row(y)[x];
    }
  }
}

void LiveFlames::State::add_glow(std::span<const Candle> candles) {
  clear(glow, {0, 0, glow.width(), glow.height()});
  if (style.glow <= 0) return;
  std::vector<HaloRing> narrow, wide;
  float reach = 0;
  for (HaloRing ring : glow_rings(style, largest_unit(candles))) {
    if (finest_level({&ring, 1}) < kHalvings) {
      reach = std::max(reach, kRingReach * ring.sigma);
      narrow.push_back(ring);
    } else {
      ring.sigma /= kCell;
      wide.push_back(ring);
    }
  }
  Plane luminance(glow.width(), glow.height());
  for (const PixelBox& box : lit) gather(luminance, box);
  add_halo(std::move(luminance), wide, glow);
  if (narrow.empty()) return;
  for (PixelBox& box : lit) box = grown(box, static_cast<int>(reach) + 1, width(), height());
  merge_meeting(lit);
  for (const PixelBox& box : lit) add_narrow_rings(narrow, box);
}

// What the room and the glow look like where nothing else is.
void LiveFlames::State::make_codes() {
  const Tone& tone = Tone::get();
  for (int y = 0; y < glow.height(); ++y) {
    const Light room = night_light(kCell * (static_cast<float>(y) + 0.5F) - 0.5F, height());
    const auto fill = [&](const Plane& light, float there, Plane& code) {
      const float* from = light.row(y);
      float* to = code.row(y);
      const float dark = 1 - there;
      for (int x = 0; x < light.width; ++x) to[x] = tone.code(1 - dark * transmitted(style.exposure * from[x]));
    };
    fill(glow.red, room.red, codes.red);
    fill(glow.green, room.green, codes.green);
    fill(glow.blue, room.blue, codes.blue);
  }
}

void LiveFlames::State::mark_bright(int y) {
  std::fill(bright.begin(), bright.end(), std::uint8_t{0});
  for (const PixelBox& box : lit) {
    if (y >= box.y && y < box.y + box.height) std::fill_n(bright.begin() + box.x, box.width, std::uint8_t{1});
  }
}

void LiveFlames::State::show_row(Image& image, int y) {
  const Tone& tone = Tone::get();
  const Between place(y, glow.height());
  spread(codes, place, scratch, code_row, width());
  spread(glow, place, scratch, light_row, width());
  mark_bright(y);
  std::uint32_t* pixels = image.row(y).data();
  const std::uint32_t* empty = night.row(y).data();
  const std::array<const float*, 3> flame{own.red.row(y), own.green.row(y), own.blue.row(y)};
  const auto plain = [&](int x) { return !bright[x] && pixels[x] == empty[x]; };
  const auto lit_pixel = [&](int x) {
    const auto channel = [&](int k, int shift) {
      const float there = tone.linear(pixels[x] >> shift & 0xFFU);
      const float light = style.exposure * (flame[k][x] + light_row[k][x]);
      return static_cast<std::uint32_t>(
          std::min(255.0F, tone.code(1 - (1 - there) * transmitted(light)) + dither.row(y)[x]));
    };
    return 0xFF000000U | channel(0, 16) << 16 | channel(1, 8) << 8 | channel(2, 0);
  };
  for (int x = 0; x < width();) {
    const int first = x;
    while (x < width() && plain(x)) ++x;
    write_codes(code_row, dither.row(y), pixels, first, x);
    for (; x < width() && !plain(x); ++x) pixels[x] = lit_pixel(x);
  }
}

void LiveFlames::State::show(Image& image) {
  for (int y = 0; y < height(); ++y) show_row(image, y);
}

LiveFlames::LiveFlames(int width, int height, const FlameStyle& style)
    : state_(std::make_unique<State>(width, height, style)) {
  assert(width >= 1 && height >= 1 && width <= kLargestImageSide && height <= kLargestImageSide);
}
LiveFlames::LiveFlames(LiveFlames&&) noexcept = default;
LiveFlames& LiveFlames::operator=(LiveFlames&&) noexcept = default;
LiveFlames::~LiveFlames() = default;

void LiveFlames::draw(Image& image, std::span<const Flame> flames) {
  State& state = *state_;
  image = state.night;
  for (const PixelBox& box : state.lit) clear(state.own, box);
  state.lit.clear();
  if (flames.empty()) return;
  std::vector<Candle> candles;
  for (const Flame& flame : flames) candles.push_back(prepared(flame, state.style, state.width(), state.height()));
  draw_behind(image, candles, state.style);
  for (const Candle& candle : candles) {
    add_own_light(state.own, candle, state.style);
    const PixelBox box = own_light_box(candle, state.width(), state.height());
    if (box.width > 0) state.lit.push_back(box);
  }
  if (state.lit.empty()) return;
  state.add_glow(candles);
  state.make_codes();
  state.show(image);
}

}  // namespace wisp
