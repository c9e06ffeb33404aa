#pragma once
// Samples light between cells: a grid smoothed by the cubic B-spline kernel, sampled on finer, regular rows.
//
// The kernel is nonnegative and smooth, like a lens that does not quite resolve a cell.

#include <span>
#include <vector>

namespace wisp::flow {

/// Sample positions along one axis: for each, the first of four cells and their weights.
struct SamplePlaces {
  std::vector<int> first;
  std::vector<float> weight;  ///< four weights per position

  int size() const { return static_cast<int>(first.size()); }
};

/// Returns `count` positions start, start + step, … in cells (cell k's centre is k), over an axis of `cells`. Cells
/// outside of the axis have no weight.
SamplePlaces sample_places(int count, double start, double step, int cells);

/// Interpolates one row from four rows of `columns` values.
///
/// Precondition: out has `columns` entries, values at least columns × (highest used row + 1).
void mix_rows(std::span<const float> values, int columns, const SamplePlaces& rows, int row, std::span<float> out);

/// Returns one sample of an interpolated row.
float sample(std::span<const float> mixed, const SamplePlaces& columns, int place);

}  // namespace wisp::flow
