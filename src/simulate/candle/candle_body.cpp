#include "simulate/candle/candle_body.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::flow {
namespace {

constexpr double kNearWickMm = 2;
constexpr double kReach = 1.7;

struct Box {
  double left, right, bottom, top;
};

// A smooth hump over the box's inscribed ellipse, reaching a little beyond it, averaged over cell (i, j): 0 outside,
// 1 in the middle. A box with corners would show them in the flame's base in wind.
double hump(int i, int j, const Box& box) {
  constexpr int kSamples = 4;
  const double across = kReach * (box.right - box.left) / 2;
  const double upward = kReach * (box.top - box.bottom) / 2;
  double sum = 0;
  for (int a = 0; a < kSamples; ++a)
    for (int b = 0; b < kSamples; ++b) {
      const double x = (i + (a + 0.5) / kSamples - (box.left + box.right) / 2) / across;
      const double y = (j + (b + 0.5) / kSamples - (box.bottom + box.top) / 2) / upward;
      sum += std::pow(std::max(0.0, 1 - x * x - y * y), 2);
    }
  return sum / (kSamples * kSamples);
}

bool inside(int i, int j, const Box& box) {
  return i + 0.5 > box.left && i + 0.5 < box.right && j + 0.5 > box.bottom && j + 0.5 < box.top;
}

// The axis lies on a line between cells where the candle is an even number of cells wide, else in the middle of one,
// so that the wax is as wide to its left as to its right.
double axis_of(const FlowGrid& grid, const CandleRigOptions& options) {
  const int half_cells = static_cast<int>(std::lround(kCandleWidthMm / options.cell_mm));
  const double wanted = options.position * grid.nx;
  return half_cells % 2 == 0 ? std::round(wanted) : std::floor(wanted) + 0.5;
}

}  // namespace

CandleBody candle_body(const FlowGrid& grid, const CandleRigOptions& o) {
  const double cells = 1 / o.cell_mm;
  const double axis = axis_of(grid, o);
  const double rim = std::round(kCandleHeightMm * cells);
  const double foot = rim + kWickGapMm * cells;
  const Box wax = {axis - kCandleWidthMm * cells / 2, axis + kCandleWidthMm * cells / 2, 0, rim};
  const Box wick = {axis - kWickWidthMm * cells / 2, axis + kWickWidthMm * cells / 2, foot,
                    foot + kWickHeightMm * cells};
  const double near = kNearWickMm * cells;
  const Box near_wick = {wick.left - near, wick.right + near, wick.bottom - near, wick.top + near};

  CandleBody body;
  body.open_x = body.open_y = body.fuel_share = body.drag = Plane(grid.size(), 0.0F);
  const auto solid = [&](int i, int j) { return inside(i, j, wax); };
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      const int cell = grid.at(i, j);
      body.open_x[cell] = j < grid.ny && !solid(i, j) && !solid(i - 1, j) ? 1.0F : 0.0F;
      body.open_y[cell] = i < grid.nx && !solid(i, j) && !solid(i, j - 1) ? 1.0F : 0.0F;
      if (i == grid.nx || j == grid.ny || solid(i, j)) continue;
      body.drag[cell] = static_cast<float>(hump(i, j, wick));
      if (body.drag[cell] > 0) body.fuel_cells.push_back(cell);
      if (inside(i, j, near_wick)) body.near_wick.push_back(cell);
    }
  double sum = 0;
  for (const int cell : body.fuel_cells) sum += static_cast<double>(body.drag[cell]);
  const double area = sum * static_cast<double>(grid.h) * static_cast<double>(grid.h);
  for (const int cell : body.fuel_cells)
    body.fuel_share[cell] = static_cast<float>(static_cast<double>(body.drag[cell]) / area);
  body.axis = static_cast<float>(axis) * grid.h;
  body.rim = static_cast<float>(rim) * grid.h;
  return body;
}

}  // namespace wisp::flow
