#include "capture/clip/fall/falls.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/statistics.hpp"
#include "capture/vision/film_look.hpp"

namespace wisp::fall {
namespace {

constexpr std::size_t kSamples = 61;     // maximum number of frames from which the wall is estimated
constexpr std::size_t kGainSpots = 997;  // approximate number of pixels used to measure exposure
constexpr float kMinGround = 16;         // grey levels: minimum brightness of pixels used to measure exposure
constexpr float kMinDifference = 8;      // grey levels: minimum tolerance, above coding noise
constexpr float kSigmas = 5;             // tolerance in standard deviations
constexpr double kUnsteady = 5;          // grey levels: a pixel that deviates by more in 30 % of the frames is unsteady
constexpr int kMinPixels = 4;            // minimum size of an object in pixels beyond the tolerance
constexpr double kTypical = 0.9;  // an object's contrast is this quantile of its pixels' differences: edges differ less
constexpr double kShadow = 0.35;  // share of the contrast below which a pixel is shadow or blur
constexpr double kPixelVariance = 1.0 / 12;

// Returns the brightness of the wall in a frame relative to its median over the film: cameras adapt their exposure.
float gain_of(const Frame& frame, const std::vector<float>& brightness) {
  std::vector<float> ratios;
  const std::size_t step = std::max<std::size_t>(1, frame.size() / kGainSpots);
  for (std::size_t p = 0; p < frame.size(); p += step) {
    if (brightness[p] >= kMinGround) ratios.push_back(static_cast<float>(frame[p]) / brightness[p]);
  }
  return ratios.size() < 16 ? 1 : quantile(ratios, 0.5);
}

std::vector<const Frame*> samples_of(std::span<const Frame> frames) {
  std::vector<const Frame*> all, out;
  for (const Frame& frame : frames) {
    if (!frame.empty()) all.push_back(&frame);
  }
  const std::size_t count = std::min(kSamples, all.size());
  for (std::size_t k = 0; k < count; ++k) out.push_back(all[(2 * k + 1) * all.size() / (2 * count)]);
  return out;
}

// Calls `take` for pixel `p` and its up to eight neighbours.
template <class Take>
void for_neighbours(int p, const Wall& wall, Take take) {
  const int x = p % wall.width, y = p / wall.width;
  for (int v = std::max(0, y - 1); v <= std::min(wall.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(wall.width - 1, x + 1); ++u) take(v * wall.width + u);
  }
}

// Marks pixels beyond the tolerance and their neighbours, so that an object partly as bright as the wall stays whole.
std::vector<std::uint8_t> mask_of(const std::vector<float>& difference, const Wall& wall) {
  std::vector<std::uint8_t> mask(difference.size(), 0);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (std::abs(difference[p]) <= wall.tolerance[p]) continue;
    for_neighbours(static_cast<int>(p), wall, [&](int near) { mask[static_cast<std::size_t>(near)] = 1; });
  }
  return mask;
}

// Removes the connected component at a pixel from the mask and returns its pixels.
std::vector<int> component_at(int seed, std::vector<std::uint8_t>& mask, const Wall& wall) {
  std::vector<int> pixels{seed};
  mask[static_cast<std::size_t>(seed)] = 0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    for_neighbours(pixels[k], wall, [&](int p) {
      if (std::exchange(mask[static_cast<std::size_t>(p)], 0) != 0) pixels.push_back(p);
    });
  }
  return pixels;
}

bool touches_border(const std::vector<int>& pixels, const Wall& wall) {
  return std::any_of(pixels.begin(), pixels.end(), [&](int p) {
    const int x = p % wall.width, y = p / wall.width;
    return x == 0 || y == 0 || x == wall.width - 1 || y == wall.height - 1;
  });
}

// Computes an object from moments, each pixel weighted by the share of its area that the object covers.
Thing thing_of(const std::vector<int>& pixels, double contrast, const std::vector<float>& difference, int width) {
  double sum = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const int p : pixels) {
    const double cover = std::min(1.0, std::abs(difference[static_cast<std::size_t>(p)]) / contrast);
    const double weight = std::max(0.0, cover - kShadow) / (1 - kShadow);
    const int px = p % width, py = p / width;
    sum += weight;
    x += weight * px;
    y += weight * py;
    xx += weight * px * px;
    xy += weight * px * py;
    yy += weight * py * py;
  }
  Thing thing{.x = x / sum, .y = y / sum, .contrast = contrast};
  const auto [left, right] =
      std::minmax_element(pixels.begin(), pixels.end(), [&](int a, int b) { return a % width < b % width; });
  thing.left = *left % width, thing.right = *right % width;
  thing.bottom = *std::max_element(pixels.begin(), pixels.end()) / width;
  xx = xx / sum - thing.x * thing.x, yy = yy / sum - thing.y * thing.y, xy = xy / sum - thing.x * thing.y;
  const double middle = (xx + yy) / 2, radius = std::hypot((xx - yy) / 2, xy);
  const double across = std::max(middle - radius - kPixelVariance, kPixelVariance);
  thing.angle = -std::atan2(2 * xy, xx - yy) / 2;  // y points down
  thing.aspect = std::sqrt(std::max(1.0, (middle + radius - kPixelVariance) / across));
  return thing;
}

// Returns the shift of a frame from the wall in reduced pixels, by sums of columns and rows; 0 without wall texture.
double shift_of(const Frame& frame, const Wall& wall, float gain) {
  const auto width = static_cast<std::size_t>(wall.width);
  std::vector<double> across(width), down(static_cast<std::size_t>(wall.height)), across_then = across,
                                                                                  down_then = down;
  for (std::size_t p = 0; p < frame.size(); ++p) {
    across[p % width] += frame[p], down[p / width] += frame[p];
    across_then[p % width] += gain * wall.brightness[p], down_then[p / width] += gain * wall.brightness[p];
  }
  return std::hypot(wall.width * step_between(across_then, across), wall.height * step_between(down_then, down));
}

}  // namespace

Wall wall_of(std::span<const Frame> frames, int width, int height) {
  const std::vector<const Frame*> samples = samples_of(frames);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Wall wall{.width = width, .height = height, .brightness = std::vector<float>(pixels), .tolerance = {}};
  std::vector<float> values(samples.size());
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t k = 0; k < samples.size(); ++k) values[k] = (*samples[k])[p];
    wall.brightness[p] = quantile(values, 0.5);
  }
  std::vector<float> gains;
  double square = 0;
  for (const Frame* sample : samples) {
    gains.push_back(gain_of(*sample, wall.brightness));
    const double shift = shift_of(*sample, wall, gains.back());
    square += shift * shift;
  }
  wall.shake = std::sqrt(square / static_cast<double>(samples.size()));
  std::vector<float> sigmas(pixels);
  std::size_t unsteady = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t k = 0; k < samples.size(); ++k)
      values[k] = std::abs((*samples[k])[p] - gains[k] * wall.brightness[p]);
    sigmas[p] = 1.4826F * quantile(values, 0.5);  // the median of a Gaussian's absolute values is 1 / 1.4826
    unsteady += quantile(values, 0.7) > kUnsteady;
  }
  const float noise = quantile(sigmas, 0.5);
  for (const float sigma : sigmas) wall.tolerance.push_back(std::max(kMinDifference, kSigmas * std::max(sigma, noise)));
  wall.noise = noise;
  wall.unsteady = static_cast<double>(unsteady) / static_cast<double>(pixels);
  return wall;
}

Seen seen_in(const Frame& frame, const Wall& wall) {
  const float gain = gain_of(frame, wall.brightness);
  std::vector<float> difference(frame.size());
  for (std::size_t p = 0; p < frame.size(); ++p) difference[p] = frame[p] - gain * wall.brightness[p];
  std::vector<std::uint8_t> mask = mask_of(difference, wall);
  Seen seen;
  std::vector<double> beyond;
  for (std::size_t seed = 0; seed < mask.size(); ++seed) {
    if (mask[seed] == 0) continue;
    const std::vector<int> pixels = component_at(static_cast<int>(seed), mask, wall);
    beyond.clear();
    for (const int p : pixels) {
      const double far = std::abs(difference[static_cast<std::size_t>(p)]);
      if (far > wall.tolerance[static_cast<std::size_t>(p)]) beyond.push_back(far);
    }
    if (beyond.size() < kMinPixels) continue;
    if (touches_border(pixels, wall)) {
      seen.at_border = true;
      continue;
    }
    seen.things.push_back(thing_of(pixels, quantile(beyond, kTypical), difference, wall.width));
  }
  return seen;
}

}  // namespace wisp::fall
