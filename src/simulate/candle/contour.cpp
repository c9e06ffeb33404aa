#include "simulate/candle/contour.hpp"

#include <array>

namespace wisp::flow {
namespace {

// Sides of a square: lower, right, upper, left.
enum Side { kLower, kRight, kUpper, kLeft };

struct Lattice {
  std::span<const float> values;
  int columns;
  int rows;
  float level;

  float at(int i, int j) const { return values[static_cast<std::size_t>(j) * columns + i]; }

  // Lattice edges are numbered by their lower left end: even ones go right, odd ones go up.
  int edge(int i, int j, int side) const {
    switch (side) {
      case kLower:
        return 2 * (j * columns + i);
      case kUpper:
        return 2 * ((j + 1) * columns + i);
      case kLeft:
        return 2 * (j * columns + i) + 1;
      default:
        return 2 * (j * columns + i + 1) + 1;
    }
  }

  PointMm crossing(int edge) const {
    const int i = edge / 2 % columns;
    const int j = edge / 2 / columns;
    const bool up = edge % 2 != 0;
    const double a = static_cast<double>(at(i, j));
    const double b = static_cast<double>(up ? at(i, j + 1) : at(i + 1, j));
    const double t = (static_cast<double>(level) - a) / (b - a);
    return up ? PointMm{static_cast<double>(i), j + t} : PointMm{i + t, static_cast<double>(j)};
  }
};

// Sends the contour through square (i, j): next[edge it enters by] = edge it leaves by, with the inside on its right.
void link_square(const Lattice& lattice, int i, int j, std::vector<int>& next) {
  const std::array<bool, 4> inside = {lattice.at(i, j) > lattice.level, lattice.at(i + 1, j) > lattice.level,
                                      lattice.at(i + 1, j + 1) > lattice.level, lattice.at(i, j + 1) > lattice.level};
  // Going round the corners counter-clockwise, the contour enters by a side where inside turns to outside (then the
  // inside is behind and so on its right) and leaves by one where outside turns to inside.
  std::array<int, 2> enters{};
  std::array<int, 2> leaves{};
  int count = 0;
  int left = 0;
  for (int side = 0; side < 4; ++side) {
    const bool from = inside[side];
    const bool to = inside[(side + 1) % 4];
    if (from && !to) leaves[left++] = side;
    if (!from && to) enters[count++] = side;
  }
  if (count == 0) return;
  if (count == 1) {
    next[lattice.edge(i, j, enters[0])] = lattice.edge(i, j, leaves[0]);
    return;
  }
  const float mean =
      0.25F * (lattice.at(i, j) + lattice.at(i + 1, j) + lattice.at(i, j + 1) + lattice.at(i + 1, j + 1));
  const bool joined = mean > lattice.level;
  for (int k = 0; k < 2; ++k) {
    // A corner that is inside lies between the side where the contour enters and the next side. Apart, each inside
    // corner is cut off by itself; joined, each outside corner is.
    const int partner = joined ? (enters[k] + 3) % 4 : (enters[k] + 1) % 4;
    next[lattice.edge(i, j, enters[k])] = lattice.edge(i, j, partner);
  }
}

}  // namespace

std::vector<std::vector<PointMm>> closed_contours(std::span<const float> values, int columns, int rows, float level) {
  const Lattice lattice{values, columns, rows, level};
  std::vector<int> next(2 * static_cast<std::size_t>(columns) * rows, -1);
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) link_square(lattice, i, j, next);

  std::vector<std::vector<PointMm>> contours;
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (next[start] < 0) continue;
    std::vector<PointMm> contour;
    int edge = static_cast<int>(start);
    while (edge >= 0 && next[edge] >= 0) {
      contour.push_back(lattice.crossing(edge));
      const int following = next[edge];
      next[edge] = -1;
      edge = following;
    }
    if (edge == static_cast<int>(start)) contours.push_back(std::move(contour));
  }
  return contours;
}

double clockwise_area(std::span<const PointMm> polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PointMm& a = polygon[k];
    const PointMm& b = polygon[(k + 1) % polygon.size()];
    twice += b.x * a.y - a.x * b.y;
  }
  return twice / 2;
}

}  // namespace wisp::flow
