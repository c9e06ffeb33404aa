#include "simulate/candle/virtual_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp::flow {
namespace {

std::array<double, 4> cubic_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
}

}  // namespace

SamplePlaces sample_places(int count, double start, double step, int cells) {
  SamplePlaces places;
  for (int k = 0; k < count; ++k) {
    const double x = start + step * k;
    const int lower = static_cast<int>(std::floor(x));
    const std::array<double, 4> kernel = cubic_weights(x - lower);
    const int first = std::clamp(lower - 1, 0, cells - 4);
    std::array<float, 4> weight{};
    for (int n = 0; n < 4; ++n) {
      const int slot = lower - 1 + n - first;
      if (slot >= 0 && slot < 4) weight[slot] = static_cast<float>(kernel[n]);
    }
    places.first.push_back(first);
    places.weight.insert(places.weight.end(), weight.begin(), weight.end());
  }
  return places;
}

void mix_rows(std::span<const float> values, int columns, const SamplePlaces& rows, int row, std::span<float> out) {
  const float* w = rows.weight.data() + 4 * static_cast<std::size_t>(row);
  const float* a = values.data() + static_cast<std::size_t>(rows.first[row]) * columns;
  const float* b = a + columns;
  const float* c = b + columns;
  const float* d = c + columns;
  for (int i = 0; i < columns; ++i) out[i] = (w[0] * a[i] + w[1] * b[i]) + (w[2] * c[i] + w[3] * d[i]);
}

float sample(std::span<const float> mixed, const SamplePlaces& columns, int place) {
  const float* x = mixed.data() + columns.first[place];
  const float* w = columns.weight.data() + 4 * static_cast<std::size_t>(place);
  return (w[0] * x[0] + w[1] * x[1]) + (w[2] * x[2] + w[3] * x[3]);
}

}  // namespace wisp::flow

namespace wisp {
namespace {

constexpr double kPixelsPerMm = 7.5;  // a calm flame is about 260 pixels high
constexpr double kWickX = 0.35;       // x of the candle's axis, as a share of the width from the left
constexpr double kRimY = 0.06;        // y of the candle's upper rim, as a share of the height from below
constexpr double kContrast = 1.8;     // steepness of the tone curve: higher gives the flame a sharper edge

// Tones are in sixteenths of an 8-bit step until noise has been added.
constexpr int kToneUnit = 16;
constexpr int kTones = 8192;
constexpr float kBrightest = 25.0F;  // upper end of the tables' exposure, where every channel is white
constexpr int kNoiseValues = 1 << 14;

// Sensitivity of each channel to glowing soot and to the reaction's own light.
constexpr std::array<float, 3> kSootColour = {1.0F, 0.56F, 0.21F};
constexpr std::array<float, 3> kBlueColour = {0.15F, 0.36F, 1.0F};
constexpr float kBlueGain = 0.013F;  // exposure per 1/s of fuel burnt
constexpr float kBlueVeil = 5.0F;    // attenuation of the blue light: by 1 / (1 + kBlueVeil · soot light)
constexpr double kBlueFullMm = 4;    // height above the rim up to which blue is full: a candle is blue at its base
constexpr double kBlueGoneMm = 16;   // height above which there is none: a planar flow has more blue than a camera sees
constexpr double kGlowReachMm = 2.5;
constexpr float kDark = 2e-4F;  // light below which every channel is black

Result<void> check(const VirtualCameraOptions& o) {
  const auto ranges = flow::check_ranges("virtual camera", {
                                                               {"width", double(o.width), 16, 4096},
                                                               {"height", double(o.height), 16, 4096},
                                                               {"gain", o.gain, 0.01, 100},
                                                               {"glow", o.glow, 0, 1},
                                                               {"noise", o.noise, 0, 50},
                                                           });
  if (!ranges) return ranges.error();
  if (o.width % 2 != 0 || o.height % 2 != 0)
    return Error{"virtual camera: a picture of " + std::to_string(o.width) + " × " + std::to_string(o.height) +
                 " pixels, expected even numbers, as video encoders do"};
  return {};
}

// Computes a running mean of 2 reach + 1 values along one axis; outside is dark.
void box_blur(std::vector<float>& values, int lines, int line_step, int length, int step, int reach) {
  std::vector<float> line(length);
  const float share = 1.0F / static_cast<float>(2 * reach + 1);
  for (int l = 0; l < lines; ++l) {
    float* first = values.data() + static_cast<std::size_t>(l) * line_step;
    for (int k = 0; k < length; ++k) line[k] = first[static_cast<std::size_t>(k) * step];
    float sum = 0;
    for (int k = 0; k < std::min(reach, length); ++k) sum += line[k];
    for (int k = 0; k < length; ++k) {
      if (k + reach < length) sum += line[k + reach];
      if (k - reach - 1 >= 0) sum -= line[k - reach - 1];
      first[static_cast<std::size_t>(k) * step] = share * std::max(sum, 0.0F);
    }
  }
}

float smooth_fall(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return static_cast<float>(1 - t * t * (3 - 2 * t));
}

}  // namespace

double CameraView::pixel_x(double mm) const { return origin_x + mm * pixels_per_mm; }
double CameraView::pixel_y(double mm) const { return origin_y - mm * pixels_per_mm; }

std::int16_t VirtualCamera::tone(float exposure) const {
  return tones_[static_cast<int>(std::min(exposure, kBrightest) * ((kTones - 1) / kBrightest))];
}

VirtualCamera::VirtualCamera(const VirtualCameraOptions& o)
    : options_(o),
      line_(3 * static_cast<std::size_t>(o.width)),
      picture_(3 * static_cast<std::size_t>(o.width) * o.height) {
  view_ = {kWickX * o.width - 0.5, (1 - kRimY) * o.height - 0.5, kPixelsPerMm};
  for (int k = 0; k < kTones; ++k) {
    const double exposure = static_cast<double>(kBrightest) * k / (kTones - 1);
    steep_.push_back(static_cast<float>(std::pow(exposure, kContrast)));
    tones_.push_back(static_cast<std::int16_t>(std::lround(255 * kToneUnit * (1 - std::exp(-exposure)))));
  }
  flow::RandomNumbers random(o.seed, 0x6e6f697365U);
  for (int k = 0; k < kNoiseValues; ++k)
    noise_.push_back(static_cast<std::int16_t>(std::lround(o.noise * kToneUnit * random.normal())));
}

void VirtualCamera::set_places(const RigLight& light) {
  const bool same = seen_.columns == light.columns && seen_.rows == light.rows && seen_.cell_mm == light.cell_mm &&
                    seen_.wick_x_mm == light.wick_x_mm && seen_.wick_y_mm == light.wick_y_mm;
  if (same) return;
  seen_ = {light.columns, light.rows, light.cell_mm, light.wick_x_mm, light.wick_y_mm, {}, {}};
  const double step = 1 / (view_.pixels_per_mm * light.cell_mm);
  columns_ = flow::sample_places(options_.width, light.wick_x_mm / light.cell_mm - 0.5 - view_.origin_x * step, step,
                                 light.columns);
  rows_ = flow::sample_places(options_.height, light.wick_y_mm / light.cell_mm - 0.5 + view_.origin_y * step, -step,
                              light.rows);
  mixed_soot_.resize(light.columns);
  mixed_blue_.resize(light.columns);
}

// Sets soot_ to the soot's light plus its scatter in the lens: three running means approximate a Gaussian.
void VirtualCamera::scatter(const RigLight& light) {
  soot_ = light.soot;
  if (options_.glow <= 0) return;
  scattered_ = light.soot;
  const int reach = std::max(1, static_cast<int>(std::lround(kGlowReachMm / light.cell_mm)));
  for (int pass = 0; pass < 3; ++pass) {
    box_blur(scattered_, light.rows, light.columns, light.columns, 1, reach);
    box_blur(scattered_, light.columns, 1, light.rows, light.columns, reach);
  }
  const auto share = static_cast<float>(options_.glow);
  for (std::size_t k = 0; k < soot_.size(); ++k) soot_[k] += share * scattered_[k];
}

void VirtualCamera::expose_row(const RigLight& light, int row) {
  flow::mix_rows(soot_, light.columns, rows_, row, mixed_soot_);
  const double height_mm = (view_.origin_y - row) / view_.pixels_per_mm;
  const float fade = kBlueGain * smooth_fall(height_mm, kBlueFullMm, kBlueGoneMm);
  flow::mix_rows(light.blue, light.columns, rows_, row, mixed_blue_);
  for (float& value : mixed_blue_) value *= fade;

  std::fill(line_.begin(), line_.end(), std::int16_t{0});
  const auto gain = static_cast<float>(options_.gain);
  for (int x = 0; x < options_.width; ++x) {
    const float body = flow::sample(mixed_soot_, columns_, x);
    const float veiled = flow::sample(mixed_blue_, columns_, x) / (1.0F + kBlueVeil * body);
    if (body + veiled < kDark) continue;
    const float glowing = steep_[static_cast<int>(std::min(gain * body, kBrightest) * ((kTones - 1) / kBrightest))];
    for (int c = 0; c < 3; ++c) line_[3 * x + c] = tone(kSootColour[c] * glowing + kBlueColour[c] * gain * veiled);
  }
}

Result<VirtualCamera> VirtualCamera::create(const VirtualCameraOptions& options) {
  if (auto good = check(options); !good) return good.error();
  return VirtualCamera(options);
}

std::span<const std::uint8_t> VirtualCamera::picture(const RigLight& light, std::uint64_t frame) {
  set_places(light);
  scatter(light);
  const int values = 3 * options_.width;
  for (int row = 0; row < options_.height; ++row) {
    expose_row(light, row);
    const std::uint64_t start = flow::random_word(options_.seed, frame, row) % (kNoiseValues - values);
    const std::int16_t* noise = noise_.data() + start;
    std::uint8_t* out = picture_.data() + static_cast<std::size_t>(row) * values;
    for (int k = 0; k < values; ++k)
      out[k] = static_cast<std::uint8_t>(std::clamp((line_[k] + noise[k] + kToneUnit / 2) / kToneUnit, 0, 255));
  }
  return picture_;
}

}  // namespace wisp
