#include "capture/vision/threshold.hpp"

#include <cassert>

namespace wisp {

void add_to_histogram(Histogram& histogram, const ImageView& image, int step) {
  assert(step >= 1);
  // Neighbours are mostly alike, and a count has to be finished before it can be raised again: four take turns.
  std::array<std::array<std::uint32_t, 256>, 4> counts{};
  for (int y = step / 2; y < image.height; y += step) {
    const std::uint8_t* row = image.row(y);
    int turn = 0;
    for (int x = step / 2; x < image.width; x += step) ++counts[turn++ & 3][row[x]];
  }
  for (const auto& count : counts) {
    for (int v = 0; v < 256; ++v) histogram[v] += count[v];
  }
}

TwoClusters split_histogram(const Histogram& histogram) {
  double count = 0, sum = 0, square_sum = 0;
  for (int v = 0; v < 256; ++v) {
    const double n = static_cast<double>(histogram[v]);
    count += n;
    sum += n * v;
    square_sum += n * v * v;
  }
  TwoClusters best;
  if (count == 0) return best;
  const double mean = sum / count, variance = square_sum / count - mean * mean;
  best.dark_mean = best.bright_mean = mean;
  double dark_count = 0, dark_sum = 0, best_between = 0;
  for (int v = 0; v < 255; ++v) {
    dark_count += static_cast<double>(histogram[v]);
    dark_sum += static_cast<double>(histogram[v]) * v;
    const double bright_count = count - dark_count;
    if (dark_count == 0 || bright_count == 0) continue;
    const double dark_mean = dark_sum / dark_count, bright_mean = (sum - dark_sum) / bright_count;
    const double apart = bright_mean - dark_mean;
    const double between = dark_count * bright_count / (count * count) * apart * apart;
    if (between <= best_between) continue;
    best_between = between;
    best = {v, between / variance, dark_mean, bright_mean, bright_count / count};
  }
  return best;
}

}  // namespace wisp
