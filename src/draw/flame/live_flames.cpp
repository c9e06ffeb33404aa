#include "wisp/draw/live_flames.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "draw/flame/flame_layers.hpp"

namespace wisp {

using namespace drawing;

namespace {

// Radius in standard deviations beyond which a ring of the glow is invisible.
constexpr float kRingReach = 3.5F;

PixelBox grown(PixelBox box, int by, int width, int height) {
  const int left = std::max(0, box.x - by), top = std::max(0, box.y - by);
  const int right = std::min(width, box.x + box.width + by), bottom = std::min(height, box.y + box.height + by);
  if (left >= right || top >= bottom) return {};
  return {left, top, right - left, bottom - top};
}

// Extends a box to whole cells, and by the cells into which halved() spreads its light.
PixelBox on_grid(PixelBox box, int width, int height) {
  const int left = std::max(0, box.x / kCell - 2) * kCell, top = std::max(0, box.y / kCell - 2) * kCell;
  const int right = std::min(width, (cells(box.x + box.width) + 2) * kCell);
  const int bottom = std::min(height, (cells(box.y + box.height) + 2) * kCell);
  return {left, top, right - left, bottom - top};
}

void clear(LightField& field, PixelBox box) {
  for (Plane* plane : {&field.red, &field.green, &field.blue}) {
    for (int y = box.y; y < box.y + box.height; ++y) std::fill_n(plane->row(y) + box.x, box.width, 0.0F);
  }
}

PixelBox around(PixelBox a, PixelBox b) {
  const int left = std::min(a.x, b.x), top = std::min(a.y, b.y);
  const int right = std::max(a.x + a.width, b.x + b.width), bottom = std::max(a.y + a.height, b.y + b.height);
  return {left, top, right - left, bottom - top};
}

// Returns the box of a candle's own light: flame and ember.
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

// Merges overlapping boxes, so that light is added to each pixel once.
void merge_meeting(std::vector<PixelBox>& boxes) {
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    for (std::size_t other = k + 1; other < boxes.size(); ++other) {
      if (!meet(boxes[k], boxes[other])) continue;
      boxes[k] = around(boxes[k], boxes[other]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(other));
      k = other = 0;  // The larger box may overlap any other now.
    }
  }
}

}  // namespace

struct LiveFlames::State {
  State(int width, int height, const FlameStyle& asked)
      : style(clamped(asked)),
        room(width, height),
        behind(width, height),
        dither(width, height),
        own(width, height),
        glow(cells(width), cells(height)),
        codes(cells(width), cells(height)),
        light_row(width),
        code_row(width),
        scratch(static_cast<std::size_t>(cells(width)) + 2),
        bright(static_cast<std::size_t>(width) + 1) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) dither.row(y)[x] = rounding_at(x, y);
    }
  }

  int width() const { return behind.width(); }
  int height() const { return behind.height(); }

  void add_glow(std::span<const Candle> candles);
  void add_narrow_rings(std::span<const HaloRing> rings, PixelBox lit);
  void gather(Plane& luminance, PixelBox lit) const;
  void draw_room(std::span<const Candle> candles);
  void make_codes();
  void show_row(Image& image, int y);
  void mark_bright(int y);

  FlameStyle style;
  Room room;
  const LightField* room_light = nullptr;  // light of the room in the current picture
  Image behind;                            // picture of the room alone
  Plane dither;
  LightField own;   // flames and embers, in pixels; dark outside `lit`
  LightField glow;  // glow around them, in cells
  LightField codes;
  Row light_row, code_row;
  std::vector<float> scratch;
  std::vector<std::uint8_t> bright;  // per pixel of a row: 1 inside a box of `lit`
  std::vector<PixelBox> lit;
};

// Transfers the luminance in a part of the picture to the grid.
void LiveFlames::State::gather(Plane& luminance, PixelBox box) const {
  const PixelBox part = on_grid(box, width(), height());
  Plane soft = luminance_in(own, part);
  for (int k = 0; k < kHalvings; ++k) soft = halved(soft);
  const int left = part.x / kCell, top = part.y / kCell;
  for (int y = 0; y < soft.height; ++y) {
    // Parts overlap at their edges, where each may lack light of the other; the larger value is complete.
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

void LiveFlames::State::draw_room(std::span<const Candle> candles) {
  std::vector<Stand> stands;
  for (const Candle& candle : candles) stands.push_back(stand_of(candle.scene, style, candle.lamp));
  room_light = &room.lit(stands);
  const Tone& tone = Tone::get();
  for (const auto& [from, to] : {std::pair{&room_light->red, &codes.red}, std::pair{&room_light->green, &codes.green},
                                 std::pair{&room_light->blue, &codes.blue}}) {
    std::ranges::transform(from->values, to->values.begin(), [&](float light) { return tone.code(light); });
  }
  for (int y = 0; y < height(); ++y) {
    spread(codes, Between(y, codes.height()), scratch, code_row, width());
    write_codes(code_row, dither.row(y), behind.row(y).data(), 0, width());
  }
}

// Computes the screen codes of room and glow, which are shown where no candle or smoke is in front of them.
void LiveFlames::State::make_codes() {
  const Tone& tone = Tone::get();
  for (int y = 0; y < glow.height(); ++y) {
    const auto fill = [&](const Plane& light, const Plane& there, Plane& code) {
      const float *from = light.row(y), *behind_it = there.row(y);
      float* to = code.row(y);
      for (int x = 0; x < light.width; ++x) to[x] = tone.code(1 - (1 - behind_it[x]) * transmitted(from[x]));
    };
    fill(glow.red, room_light->red, codes.red);
    fill(glow.green, room_light->green, codes.green);
    fill(glow.blue, room_light->blue, codes.blue);
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
  const std::uint32_t* empty = behind.row(y).data();
  const std::array<const float*, 3> flame{own.red.row(y), own.green.row(y), own.blue.row(y)};
  const auto plain = [&](int x) { return !bright[x] && pixels[x] == empty[x]; };
  const auto lit_pixel = [&](int x) {
    const auto channel = [&](int k, int shift) {
      const float there = tone.linear(pixels[x] >> shift & 0xFFU);
      const float light = flame[k][x] + light_row[k][x];
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

LiveFlames::LiveFlames(int width, int height, const FlameStyle& style)
    : state_(std::make_unique<State>(width, height, style)) {
  assert(width >= 1 && height >= 1 && width <= kLargestImageSide && height <= kLargestImageSide);
}
LiveFlames::LiveFlames(LiveFlames&&) noexcept = default;
LiveFlames& LiveFlames::operator=(LiveFlames&&) noexcept = default;
LiveFlames::~LiveFlames() = default;

void LiveFlames::draw(Image& image, std::span<const Flame> flames) {
  State& state = *state_;
  for (const PixelBox& box : state.lit) clear(state.own, box);
  state.lit.clear();
  std::vector<Candle> candles;
  for (const Flame& flame : flames) candles.push_back(prepared(flame, state.width(), state.height()));
  state.draw_room(candles);
  image = state.behind;
  draw_behind(image, candles, state.style);
  for (const Candle& candle : candles) {
    add_own_light(state.own, candle, state.style);
    const PixelBox box = own_light_box(candle, state.width(), state.height());
    if (box.width > 0) state.lit.push_back(box);
  }
  if (state.lit.empty()) return;
  state.add_glow(candles);
  state.make_codes();
  for (int y = 0; y < state.height(); ++y) state.show_row(image, y);
}

}  // namespace wisp
