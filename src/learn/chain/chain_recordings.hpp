#pragma once
// Prepares recordings for chains: falls, and windy–calm pairs that show the effect of wind.

#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

/// Whether all inputs of a recording are 0 throughout.
bool is_calm(const Recording& recording);

/// Recordings split by the attribute `pair`, whose value is shared by recordings that differ only in their wind.
struct SortedRecordings {
  std::vector<Recording> falls;
  std::vector<Recording> paired;  ///< the windy recording and its calm twin, or empty
};

/// Errors: as check_motion(); paired recordings other than one windy recording and its calm twin.
Result<SortedRecordings> sorted_recordings(std::span<const Recording> recordings);

/// Number of episodes that repeat an earlier one row by row. They add nothing to training or to validation.
struct Repeats {
  std::size_t episodes = 0;
  std::size_t repeated = 0;
};
Repeats repeats_in(std::span<const Recording> recordings);

/// Mean speed of all rows, metres a second.
double mean_speed(std::span<const Recording> recordings);

}  // namespace wisp::chain
