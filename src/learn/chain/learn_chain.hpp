#pragma once
// Learns segment chains from recorded motion, and validates them on other recordings.

#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Learns a chain, with its gust response where two recordings are a pair, and judges it on the held-out stretches
/// (without any, on the training stretches). Errors, with the file's name: as check_motion(); an invalid pair, or a
/// pair without other falls; no event, or fewer segments than modes; a recipe out of range; stopped by `progress`.
Result<Fit> learn_chain(std::span<const Recording> recordings, const ChainRecipe& recipe,
                        const Progress& progress = {});

/// Compares falls that the model makes with recorded ones, which should be unseen in training; or, given a windy
/// and a calm recording with one attribute `pair`, the effect of gusts. The report's series are recorded and played
/// tracks. Errors: as check_motion(); the model is no chain, or lacks its segmentation options; rates that differ; an
/// invalid pair; stopped by `progress`.
Result<Report> validate_chain(const Model& model, std::span<const Recording> recordings, std::uint64_t seed,
                              const Progress& progress = {});

namespace chain {

bool is_calm(const Recording& recording);

/// Recordings split by the attribute `pair`, whose value is shared by recordings that differ only in their wind.
struct SortedRecordings {
  std::vector<Recording> falls;
  std::vector<Recording> paired;  ///< the windy recording and its calm twin, or empty
};

/// Errors: as check_motion(); paired recordings other than one windy recording and its calm twin.
Result<SortedRecordings> sorted_recordings(std::span<const Recording> recordings);

}  // namespace chain
}  // namespace wisp
