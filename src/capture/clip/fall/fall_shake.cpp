// Lucas and Kanade, An iterative image registration technique, 1981: one step of it from the wall to a frame. Taken
// block by block, and of the blocks the median: what moves before the wall, or lies there for a while, is in few. One
// step goes as far as a mark is wide, so it is taken on pictures that are four times as coarse.

#include <algorithm>
#include <cmath>

#include "capture/clip/fall/fall_scene.hpp"

namespace wisp::fall {
namespace {

constexpr int kBlocks = 6;               // either way
constexpr std::size_t kMinInformed = 6;  // of 36: fewer may all be of what lies there
constexpr double kMinSlope = 1.5;        // grey levels a coarse pixel, root mean square: a wall with marks on it

struct Block {
  double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;  // sums of products of both slopes and the difference
  int pixels = 0;

  // Whether the wall has marks both ways.
  bool informs() const {
    const double middle = (xx + yy) / 2, radius = std::hypot((xx - yy) / 2, xy);
    return middle - radius > kMinSlope * kMinSlope * pixels;
  }
};

constexpr int kCoarse = 4;  // pixels to one, either way

struct Coarse {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  double at(int x, int y) const { return values[static_cast<std::size_t>(y) * width + x]; }
};

template <class T>
Coarse coarse(const std::vector<T>& fine, const Wall& wall) {
  Coarse out{wall.width / kCoarse, wall.height / kCoarse, {}};
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      double sum = 0;
      for (int k = 0; k < kCoarse * kCoarse; ++k) {
        const auto row = static_cast<std::size_t>(kCoarse) * y + k / kCoarse;
        sum += fine[row * wall.width + kCoarse * x + k % kCoarse];
      }
      out.values.push_back(sum / (kCoarse * kCoarse));
    }
  }
  return out;
}

Block block_of(const Coarse& frame, const Coarse& wall, double gain, int column, int row) {
  const int bottom = std::min((row + 1) * wall.height / kBlocks, wall.height - 1);
  const int right = std::min((column + 1) * wall.width / kBlocks, wall.width - 1);
  Block block;
  for (int y = std::max(1, row * wall.height / kBlocks); y < bottom; ++y) {
    for (int x = std::max(1, column * wall.width / kBlocks); x < right; ++x) {
      const double u = gain * (wall.at(x + 1, y) - wall.at(x - 1, y)) / 2;
      const double v = gain * (wall.at(x, y + 1) - wall.at(x, y - 1)) / 2;
      const double difference = gain * wall.at(x, y) - frame.at(x, y);
      block.xx += u * u, block.xy += u * v, block.yy += v * v;
      block.xd += u * difference, block.yd += v * difference;
      ++block.pixels;
    }
  }
  return block;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double shift_of(const Frame& frame, const Wall& wall, float gain) {
  const Coarse still = coarse(wall.brightness, wall), now = coarse(frame, wall);
  std::vector<double> x, y;
  for (int row = 0; row < kBlocks; ++row) {
    for (int column = 0; column < kBlocks; ++column) {
      const Block block = block_of(now, still, gain, column, row);
      if (!block.informs()) continue;
      const double determinant = block.xx * block.yy - block.xy * block.xy;
      x.push_back((block.yy * block.xd - block.xy * block.yd) / determinant);
      y.push_back((block.xx * block.yd - block.xy * block.xd) / determinant);
    }
  }
  return x.size() < kMinInformed ? 0 : kCoarse * std::hypot(median(x), median(y));
}

}  // namespace wisp::fall
