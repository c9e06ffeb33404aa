#include "draw/flame/cells.hpp"

#include <cstdint>

namespace wisp::drawing {
namespace {

void spread_channel(const Plane& grid, const Between& y, std::vector<float>& row, float* out, int width) {
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

}  // namespace

void spread(const LightField& grid, const Between& y, std::vector<float>& scratch, Row& row, int width) {
  spread_channel(grid.red, y, scratch, row.channels[0].data(), width);
  spread_channel(grid.green, y, scratch, row.channels[1].data(), width);
  spread_channel(grid.blue, y, scratch, row.channels[2].data(), width);
}

// A loop that compilers make wide.
void write_codes(const Row& codes, const float* dither, std::uint32_t* out, int first, int last) {
  const float *red = codes[0], *green = codes[1], *blue = codes[2];
  for (int x = first; x < last; ++x) {
    const auto r = static_cast<std::int32_t>(std::min(255.0F, red[x] + dither[x]));
    const auto g = static_cast<std::int32_t>(std::min(255.0F, green[x] + dither[x]));
    const auto b = static_cast<std::int32_t>(std::min(255.0F, blue[x] + dither[x]));
    out[x] = static_cast<std::uint32_t>(-0x1000000 | r << 16 | g << 8 | b);
  }
}

}  // namespace wisp::drawing
