#pragma once
// Light between the cells: a grid of values smoothed by the cubic B-spline kernel, sampled on finer, regular rows.
//
// The kernel is never negative and has no corners, like a lens that does not quite resolve a cell.

#include <span>
#include <vector>

namespace wisp::flow {

/// Sample positions along one axis: for each, the first of four cells and their weights.
struct SamplePlaces {
  std::vector<int> first;
  std::vector<float> weight;  ///< four for each place

  int size() const { return static_cast<int>(first.size()); }
};

/// `count` places start, start + step, … in cells (cell k's middle is k), over an axis of `cells`. What lies outside
/// of the axis has no weight.
SamplePlaces sample_places(int count, double start, double step, int cells);

/// Mixes four rows of `columns` values into one.
///
/// Precondition: out has `columns` entries, values at least columns × (highest used row + 1).
void mix_rows(std::span<const float> values, int columns, const SamplePlaces& rows, int row, std::span<float> out);

/// One sample of a mixed row.
float sample(std::span<const float> mixed, const SamplePlaces& columns, int place);

}  // namespace wisp::flow
