#pragma once
// Free simulation of an ARX model along a recording's inputs.

#include <cstddef>
#include <functional>

#include "learn/arx/rows/arx_rows.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// Takes simulated deviations of all outputs, row after row, from row `first` of the recording on.
using SimulatedRows = std::function<void(std::size_t first, std::size_t rows, const double* values)>;

/// Where simulations start.
struct FreeRunStart {
  InitialState initial = InitialState::kMeasured;
  int first_sample = 0;    ///< first row of an episode, at least the model's history
  bool as_played = false;  ///< in single precision, as run/ steps the stored model
};

/// Simulates one recording block by block. Every episode starts anew, and so does every stretch after a gap in the
/// inputs. Rows that cannot be simulated are not visited.
///
/// Precondition: the signals' offsets are the model's operating point.
void free_run(const ArxModel& model, const Signals& signals, std::size_t recording, const FreeRunStart& start,
              const SimulatedRows& visit);

}  // namespace wisp
