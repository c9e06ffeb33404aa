#pragma once
// Callback that reports the progress of long work and can stop it.

#include <functional>
#include <string_view>

namespace wisp {

/// Called now and then from the working thread with the stage in words ("capturing", "searching orders") and the
/// stage's finished share, 0 to 1, or negative if its length is unknown. Returns whether to continue: after false the
/// work ends with the error kStopped and leaves no partial output. An empty Progress receives no reports.
using Progress = std::function<bool(std::string_view stage, double share)>;

/// Message of the error with which stopped work ends.
inline constexpr std::string_view kStopped = "stopped";

/// Reports progress. Returns whether to continue; true where `progress` is empty.
inline bool go_on(const Progress& progress, std::string_view stage, double share) {
  return !progress || progress(stage, share);
}

}  // namespace wisp
