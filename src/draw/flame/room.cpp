#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "draw/flame/flame_layers.hpp"

namespace wisp::drawing {
namespace {

// Distances from the picture's top, as shares of its height: the table's edge at the wall; the table plane's horizon.
constexpr float kTableEdge = 0.70F, kHorizon = 0.46F;

// Distance of the wall behind the flames, in model units.
constexpr float kBehind = 1.7F;

// Aspect ratio (height / width) in the picture of a circle on the table.
constexpr float kTableFlatness = 0.24F;

constexpr Light kPlaster{0.120F, 0.057F, 0.027F};
constexpr Light kWood{0.260F, 0.098F, 0.036F};
constexpr Light kNight{0.0052F, 0.0062F, 0.0098F};
constexpr Light kMoon{0.0115F, 0.0140F, 0.0210F};

// Adaptation of the eye: brightening of a room without flames, and dimming by bright flames.
constexpr float kOpens = 1.9F, kNarrows = 1.3F;

// Returns smooth noise over a plane, 0 to 1.
float noise_at(float x, float y, std::uint64_t seed) {
  const float i = std::floor(x), j = std::floor(y);
  const auto knot = [&](float a, float b) {
    return random_at(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(a) * 7919 +
                                                      static_cast<std::int64_t>(b) + (1 << 20)));
  };
  const float u = smooth_step(0, 1, x - i), v = smooth_step(0, 1, y - j);
  const float top = knot(i, j) + u * (knot(i + 1, j) - knot(i, j));
  const float bottom = knot(i, j + 1) + u * (knot(i + 1, j + 1) - knot(i, j + 1));
  return top + v * (bottom - top);
}

// Returns the wood grain of the table at a position, x across and z towards the eye, in about candle widths.
float grain_at(float x, float z) {
  const float plank = z * 2.6F + 40;
  const float seam = std::abs(plank - std::floor(plank) - 0.5F);
  const auto which = static_cast<std::uint64_t>(plank);
  const float along = 1.3F * x + 10 * random_at(5, which) + 64;
  const float fine = noise_at(along, 26 * z + 80, 31) * 0.6F + noise_at(3 * along, 61 * z + 200, 37) * 0.4F;
  return (0.62F + 0.62F * fine) * (0.86F + 0.28F * random_at(11, which)) * (1 - 0.55F * smooth_step(0.46F, 0.5F, seam));
}

// Returns the moonlight on the wall, through a window with nine panes, at a position in picture sizes: 0 to 1.
float pane_at(float x, float y) {
  constexpr float kLeft = 0.70F, kTop = 0.10F, kWide = 0.15F, kHigh = 0.34F, kSlant = 0.16F;
  const float v = (y - kTop) / kHigh, u = (x - kLeft - kSlant * (v - 0.5F) * kHigh) / kWide;
  if (u <= 0 || u >= 1 || v <= 0 || v >= 1) return 0;
  const auto bar = [](float share) {
    const float in = 3 * share - std::floor(3 * share);
    return smooth_step(0.02F, 0.09F, std::min(in, 1 - in));
  };
  return bar(u) * bar(v);
}

// A pixel's position on the table, model units; the origin is in mid-picture, as deep as a candle's foot.
struct TableSpot {
  float x = 0;
  float z = 0;  // towards the eye
};

class TableView {
 public:
  TableView(const Stand& stand, int width, int height)
      : middle_(0.5F * static_cast<float>(width)), horizon_(kHorizon * static_cast<float>(height)), unit_(stand.unit) {
    drop_ = std::max(0.1F * static_cast<float>(height), stand.foot.y - horizon_);
    distance_ = drop_ / unit_ / kTableFlatness;
  }

  TableSpot at(float x, float y) const {
    const float share = drop_ / std::max(1.0F, y - horizon_);
    return {(x - middle_) / unit_ * share, distance_ * (1 - share)};
  }

 private:
  float middle_, horizon_, unit_;
  float drop_ = 1, distance_ = 1;
};

void spread_channel(const Plane& grid, const Between& y, std::vector<float>& row, float* out, int width) {
  const float* a = grid.row(y.first);
  const float* b = grid.row(y.second);
  for (int k = 0; k < grid.width; ++k) row[k + 1] = a[k] + y.share * (b[k] - a[k]);
  row[0] = row[1];
  row[grid.width + 1] = row[grid.width];
  // Each group of pixels lies between the centres of two cells; the first and last group extend beyond the edge.
  const int groups = (width + kCell / 2 + kCell - 1) / kCell;
  float* group = out;
  for (int k = 0; k < groups; ++k, group += kCell) {
    const float from = row[k], step = (row[std::min(k + 1, grid.width + 1)] - from) / (2 * kCell);
    for (int r = 0; r < kCell; ++r) group[r] = from + static_cast<float>(2 * r + 1) * step;
  }
}

}  // namespace

void spread(const LightField& grid, const Between& y, std::vector<float>& scratch, Row& row, int width) {
  spread_channel(grid.red, y, scratch, row.channels[0].data(), width);
  spread_channel(grid.green, y, scratch, row.channels[1].data(), width);
  spread_channel(grid.blue, y, scratch, row.channels[2].data(), width);
}

// Without branches, so that compilers vectorise the loop.
void write_codes(const Row& codes, const float* dither, std::uint32_t* out, int first, int last) {
  const float *red = codes[0], *green = codes[1], *blue = codes[2];
  for (int x = first; x < last; ++x) {
    const auto r = static_cast<std::int32_t>(std::min(255.0F, red[x] + dither[x]));
    const auto g = static_cast<std::int32_t>(std::min(255.0F, green[x] + dither[x]));
    const auto b = static_cast<std::int32_t>(std::min(255.0F, blue[x] + dither[x]));
    out[x] = static_cast<std::uint32_t>(-0x1000000 | r << 16 | g << 8 | b);
  }
}

Stand stand_of(const FlameScene& scene, const FlameStyle& style, const Lamp& lamp) {
  const float height = style.candle ? kCandleHeight : 0;
  const float unit = scene.pixels_per_unit;
  return {.lamp = lamp,
          .foot = {scene.base.x, scene.base.y + (kWickGap + kCandleHeight) * unit},
          .unit = unit,
          .half = 0.5F * style.candle_width,
          .height = height};
}

Room::Room(int width, int height)
    : width_(width),
      height_(height),
      wood_(cells(width), cells(height)),
      moon_(cells(width), cells(height)),
      flames_((cells(width) + 1) / 2 + 1, (cells(height) + 1) / 2 + 1),
      light_(cells(width), cells(height)) {
  const float tall = static_cast<float>(height), wide = static_cast<float>(width);
  for (int j = 0; j < wood_.height(); ++j) {
    for (int i = 0; i < wood_.width(); ++i) {
      const float x = kCell * (static_cast<float>(i) + 0.5F), y = kCell * (static_cast<float>(j) + 0.5F);
      const float u = (x - 0.5F * wide) / tall, v = y / tall;
      const float table = smooth_step(kTableEdge - 0.004F, kTableEdge + 0.004F, v);
      const float far = 1 / std::max(0.05F, v - kHorizon);
      const float mottled = 0.9F + 0.2F * noise_at(9 * u + 50, 9 * v, 3);
      const float wood = grain_at(0.55F * u * far, -0.42F * far);
      // The corner of wall and table is dimmer.
      const float corner = 1 - 0.6F * std::exp(-std::max(0.0F, kTableEdge - v) / 0.05F);
      const float sheen = 0.35F * smooth_step(1.0F, kTableEdge, v);
      const float behind = smooth_step(kTableEdge, kTableEdge + 0.05F, v);
      const Light back = (1 - table) * mottled * corner * kPlaster + table * behind * wood * kWood;
      const float aspect = std::min(1.0F, wide / tall);
      const Light dark = (1 - table) * (kNight + pane_at(0.5F + u / std::max(1.0F, 1.2F * aspect), v) * kMoon) +
                         table * wood * (0.45F + sheen) * kNight;
      wood_.add(i, j, back);
      moon_.add(i, j, (1 - 0.5F * v) * dark);
    }
  }
}

void Room::light_wall(std::span<const Stand> stands) {
  constexpr int kPixels = 2 * kCell;
  const int rows = std::min(flames_.height, static_cast<int>(kTableEdge * static_cast<float>(height_)) / kPixels + 1);
  for (const Stand& stand : stands) {
    if (stand.lamp.power <= 0) continue;
    const float per = 1 / stand.unit;
    for (int j = 0; j < rows; ++j) {
      const float dy = (kPixels * (static_cast<float>(j) + 0.5F) - stand.lamp.place.y) * per;
      float* out = flames_.row(j);
      const float up = dy * dy + kBehind * kBehind;
      for (int i = 0; i < flames_.width; ++i) {
        const float dx = (kPixels * (static_cast<float>(i) + 0.5F) - stand.lamp.place.x) * per;
        const float square = dx * dx + up;
        out[i] += stand.lamp.power * kBehind * kBehind * kBehind / (square * std::sqrt(square));
      }
    }
  }
}

// Adds a flame's light on the table. Points whose line to the flame passes through the circle of the candle's rim are
// in the candle's shadow, so the shadow moves against the flame.
void Room::light_table(const Stand& stand) {
  constexpr int kPixels = 2 * kCell;
  if (stand.lamp.power <= 0) return;
  const TableView view(stand, width_, height_);
  const TableSpot foot = view.at(stand.foot.x, stand.foot.y);
  const float high = std::max(0.3F, (stand.foot.y - stand.lamp.place.y) / stand.unit);
  const float aside = foot.x + (stand.lamp.place.x - stand.foot.x) / stand.unit;
  const float rim = std::min(0.95F, stand.height / high);
  for (int j = std::max(0, static_cast<int>(kTableEdge * static_cast<float>(height_)) / kPixels + 1);
       j < flames_.height; ++j) {
    float* out = flames_.row(j);
    for (int i = 0; i < flames_.width; ++i) {
      const TableSpot p = view.at(kPixels * (static_cast<float>(i) + 0.5F), kPixels * (static_cast<float>(j) + 0.5F));
      const float dx = p.x - aside, dz = p.z - foot.z;
      const float square = dx * dx + dz * dz + high * high;
      // Intersection of the point's line to the flame with the plane of the rim.
      const float qx = p.x + rim * (aside - p.x) - foot.x, qz = (1 - rim) * dz;
      const float open = stand.height > 0 ? smooth_step(0.75F, 1.35F, std::sqrt(qx * qx + qz * qz) / stand.half) : 1;
      out[i] += stand.lamp.power * (0.08F + 0.92F * open) * 2.2F * high / (square * std::sqrt(square));
    }
  }
}

const LightField& Room::lit(std::span<const Stand> stands) {
  std::ranges::fill(flames_.values, 0.0F);
  light_wall(stands);
  for (const Stand& stand : stands) light_table(stand);
  float power = 0;
  for (const Stand& stand : stands) power += stand.lamp.power;
  const float dark = 1 + (kOpens - 1) * std::max(0.0F, 1 - power);
  const float bright = (1 + kNarrows) / (std::max(1.0F, power) + kNarrows);
  for (int j = 0; j < light_.height(); ++j) {
    // Linear interpolation to the grid of twice the resolution.
    const float v = 0.5F * (static_cast<float>(j) + 0.5F) - 0.5F;
    const int above = std::max(0, static_cast<int>(std::floor(v)));
    const float b = std::clamp(v - static_cast<float>(above), 0.0F, 1.0F);
    const float *top = flames_.row(above), *bottom = flames_.row(std::min(above + 1, flames_.height - 1));
    const std::array<std::array<const float*, 2>, 3> from{{{wood_.red.row(j), moon_.red.row(j)},
                                                           {wood_.green.row(j), moon_.green.row(j)},
                                                           {wood_.blue.row(j), moon_.blue.row(j)}}};
    const std::array<float*, 3> to{light_.red.row(j), light_.green.row(j), light_.blue.row(j)};
    for (int i = 0; i < light_.width(); ++i) {
      const int left = std::max(0, (i - 1) / 2), right = std::min(left + 1, flames_.width - 1);
      const float a = i == 0 ? 0 : (i % 2 != 0 ? 0.25F : 0.75F);
      const float here = (1 - b) * (top[left] + a * (top[right] - top[left])) +
                         b * (bottom[left] + a * (bottom[right] - bottom[left]));
      for (int c = 0; c < 3; ++c) to[c][i] = std::min(0.9F, dark * from[c][1][i] + bright * here * from[c][0][i]);
    }
  }
  return light_;
}

namespace {

// Resolution in grid cells per standard deviation at which a Gaussian looks smooth. Wide Gaussians are blurred on
// coarser grids, each of half the resolution.
constexpr float kCellsPerSigma = 1.6F;
constexpr int kMaxLevels = 12;

// Adds `coarse`, enlarged bilinearly to twice its size, to `fine`: the inverse placement of halved().
void add_doubled(const Plane& coarse, Plane& fine) {
  std::vector<float> blend(coarse.width + 2);
  for (int y = 0; y < fine.height; ++y) {
    const int near = y / 2;
    const int far = std::clamp(near + (y % 2 != 0 ? 1 : -1), 0, coarse.height - 1);
    const float* a = coarse.row(near);
    const float* b = coarse.row(far);
    for (int x = 0; x < coarse.width; ++x) blend[x + 1] = 0.75F * a[x] + 0.25F * b[x];
    blend.front() = blend[1];
    blend.back() = blend[coarse.width];
    float* out = fine.row(y);
    for (int x = 0; x + 1 < fine.width; x += 2) {
      const float* middle = blend.data() + x / 2 + 1;
      out[x] += 0.75F * middle[0] + 0.25F * middle[-1];
      out[x + 1] += 0.75F * middle[0] + 0.25F * middle[1];
    }
    if (fine.width % 2 != 0) {
      const float* middle = blend.data() + fine.width / 2 + 1;
      out[fine.width - 1] += 0.75F * middle[0] + 0.25F * middle[-1];
    }
  }
}

std::vector<float> gaussian_kernel(float sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
  std::vector<float> kernel(radius + 1);
  float sum = 0;
  for (int k = 0; k <= radius; ++k) {
    kernel[k] = std::exp(-0.5F * static_cast<float>(k * k) / (sigma * sigma));
    sum += k == 0 ? kernel[k] : 2 * kernel[k];
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

Plane blurred(const Plane& plane, float sigma) {
  const std::vector<float> kernel = gaussian_kernel(sigma);
  const int radius = static_cast<int>(kernel.size()) - 1;
  Plane across(plane.width, plane.height);
  std::vector<float> padded(plane.width + 2 * radius);
  for (int y = 0; y < plane.height; ++y) {
    std::copy_n(plane.row(y), plane.width, padded.begin() + radius);
    float* out = across.row(y);
    for (int k = -radius; k <= radius; ++k) {
      const float weight = kernel[std::abs(k)];
      const float* from = padded.data() + radius + k;
      for (int x = 0; x < plane.width; ++x) out[x] += weight * from[x];
    }
  }
  Plane result(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y) {
    float* out = result.row(y);
    for (int k = std::max(-radius, -y); k <= std::min(radius, plane.height - 1 - y); ++k) {
      const float weight = kernel[std::abs(k)];
      const float* from = across.row(y + k);
      for (int x = 0; x < plane.width; ++x) out[x] += weight * from[x];
    }
  }
  return result;
}

void add_scaled(const Plane& from, float scale, Plane& to) {
  for (std::size_t k = 0; k < from.values.size(); ++k) to.values[k] += scale * from.values[k];
}

int level_of(const HaloRing& ring) {
  const float cells = std::max(1.0F, ring.sigma / kCellsPerSigma);
  return std::clamp(static_cast<int>(std::floor(std::log2(cells))), 0, kMaxLevels);
}

}  // namespace

// Uses the kernel 1-3-3-1 over 8, which keeps the centre in place, so that the halo follows a swaying flame smoothly
// and not from cell to cell.
Plane halved(const Plane& fine) {
  Plane across((fine.width + 1) / 2, fine.height);
  std::vector<float> padded(2 * across.width + 2);
  for (int y = 0; y < fine.height; ++y) {
    std::copy_n(fine.row(y), fine.width, padded.begin() + 1);
    float* out = across.row(y);
    for (int x = 0; x < across.width; ++x) {
      const float* from = padded.data() + 2 * x;
      out[x] = 0.125F * (from[0] + from[3]) + 0.375F * (from[1] + from[2]);
    }
  }
  Plane coarse(across.width, (fine.height + 1) / 2);
  for (int y = 0; y < coarse.height; ++y) {
    float* out = coarse.row(y);
    for (int k = 0; k < 4; ++k) {
      const int from = 2 * y + k - 1;
      if (from < 0 || from >= across.height) continue;
      const float weight = k == 0 || k == 3 ? 0.125F : 0.375F;
      const float* row = across.row(from);
      for (int x = 0; x < across.width; ++x) out[x] += weight * row[x];
    }
  }
  return coarse;
}

// Approximates e^(−x) by 1/(1 + x + x²/2 + x³/6 + x⁴/24), within 1.2 % of full scale.
float transmitted(float light) {
  const float x = light;
  return 1 / (1 + x * (1 + x * (1.0F / 2 + x * (1.0F / 6 + x * (1.0F / 24)))));
}

int finest_level(std::span<const HaloRing> rings) {
  int finest = kMaxLevels;
  for (const HaloRing& ring : rings) finest = std::min(finest, level_of(ring));
  return finest;
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

void add_halo(LightField& field, std::span<const HaloRing> rings) {
  add_halo(luminance_in(field, {0, 0, field.width(), field.height()}), rings, field);
}

void add_halo(Plane luminance, std::span<const HaloRing> rings, LightField& field) {
  int top = 0;
  for (const HaloRing& ring : rings) top = std::max(top, level_of(ring));
  std::vector<Plane> levels;
  levels.push_back(std::move(luminance));
  while (static_cast<int>(levels.size()) <= top) levels.push_back(halved(levels.back()));

  // From the coarsest grid down, adds each level's rings to the sum of the coarser levels.
  LightField sum(levels.back().width, levels.back().height);
  for (int level = top;; --level) {
    const Plane& plane = levels[level];
    LightField here = level == 0 ? LightField(0, 0) : LightField(plane.width, plane.height);
    LightField& into = level == 0 ? field : here;
    if (level != top) {
      add_doubled(sum.red, into.red);
      add_doubled(sum.green, into.green);
      add_doubled(sum.blue, into.blue);
    }
    for (const HaloRing& ring : rings) {
      if (level_of(ring) != level) continue;
      const Plane soft = blurred(plane, ring.sigma / static_cast<float>(1 << level));
      add_scaled(soft, ring.tint.red, into.red);
      add_scaled(soft, ring.tint.green, into.green);
      add_scaled(soft, ring.tint.blue, into.blue);
    }
    if (level == 0) return;
    sum = std::move(here);
  }
}

void add_light(Image& image, const LightField& field) {
  assert(image.width() == field.width() && image.height() == field.height());
  // Light below this is invisible: a thousandth of the darkest code.
  constexpr float kDarkest = 3e-7F;
  const Tone& tone = Tone::get();
  for (int y = 0; y < image.height(); ++y) {
    const auto pixels = image.row(y);
    const float* red = field.red.row(y);
    const float* green = field.green.row(y);
    const float* blue = field.blue.row(y);
    for (int x = 0; x < image.width(); ++x) {
      if (red[x] + green[x] + blue[x] < kDarkest) continue;
      const std::uint32_t before = pixels[x];
      const float dither = dither_at(x, y);
      const auto lit = [&](int shift, float light) {
        const float there = tone.linear(before >> shift & 0xFFU);
        return dithered(tone.code(1 - (1 - there) * transmitted(light)), dither);
      };
      const std::uint32_t r = lit(16, red[x]);
      const std::uint32_t g = lit(8, green[x]);
      const std::uint32_t b = lit(0, blue[x]);
      // On a transparent picture the opacity is at least the brightest channel.
      const std::uint32_t opacity = std::max({before >> 24, r, g, b});
      pixels[x] = opacity << 24 | r << 16 | g << 8 | b;
    }
  }
}

}  // namespace wisp::drawing
