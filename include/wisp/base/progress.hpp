#pragma once
// How long work is watched and stopped.

#include <functional>
#include <string_view>

namespace wisp {

/// Called now and then from the working thread with the stage in words ("capturing", "searching orders") and the share
/// of it that is done, 0 to 1, or negative where its length is unknown. Returns whether to go on: after false the work
/// ends with the error kStopped and leaves nothing half-written. May be empty.
using Progress = std::function<bool(std::string_view stage, double share)>;

/// The message of the error that stopped work ends with.
inline constexpr std::string_view kStopped = "stopped";

/// Whether to go on.
inline bool go_on(const Progress& progress, std::string_view stage, double share) {
  return !progress || progress(stage, share);
}

}  // namespace wisp
