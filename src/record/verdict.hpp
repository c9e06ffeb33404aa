#pragma once
// What capturing thought of a recording travels with it, so that whoever learns from the file hears of it.

#include <optional>
#include <string>

#include "wisp/record/recording.hpp"

namespace wisp {

/// Whether a recording can be learned from, and why (attributes `usable`, yes or no, and `usable_reason`).
struct RecordingVerdict {
  bool usable = true;
  std::string reason;
};

/// Nothing where the recording does not say.
std::optional<RecordingVerdict> verdict_of(const Recording& recording);

/// Says it.
void set_verdict(Recording& recording, bool usable, const std::string& reason);

}  // namespace wisp
