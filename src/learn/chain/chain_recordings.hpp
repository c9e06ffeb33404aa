#pragma once
// Recordings as chains are learned from them: falls, and pairs that tell what wind does.

#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

/// Whether all inputs of a recording are 0 throughout.
bool is_calm(const Recording& recording);

/// Recordings by whether they have the attribute `pair`, whose value those share that differ only in their wind.
struct SortedRecordings {
  std::vector<Recording> falls;
  std::vector<Recording> paired;  ///< the windy one and its calm twin, or none
};

/// Errors: as check_motion(); paired ones that are not a windy recording and its calm twin.
Result<SortedRecordings> sorted_recordings(std::span<const Recording> recordings);

/// How many episodes repeat an earlier one, row by row: they teach nothing, and judge nothing where they are held out.
struct Repeats {
  std::size_t episodes = 0;
  std::size_t repeated = 0;
};
Repeats repeats_in(std::span<const Recording> recordings);

/// Mean speed of all rows, metres a second.
double mean_speed(std::span<const Recording> recordings);

}  // namespace wisp::chain
