#pragma once
// The capture's verdict on a recording, stored in it, so that learning from the file can report it.

#include <optional>
#include <span>
#include <string>

#include "wisp/base/report.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Verdict whether a recording can be learned from, stored as attributes `usable` (yes or no) and `usable_reason`.
struct RecordingVerdict {
  bool usable = true;
  std::string reason;
};

/// Returns the verdict; nothing if the recording has none.
std::optional<RecordingVerdict> verdict_of(const Recording& recording);

/// Returns a reason if one of these recordings was captured as not usable: a model of them is then not usable, however
/// well it plays. Nothing if none was.
std::optional<std::string> refused_by_capture(std::span<const Recording> recordings);

void set_verdict(Recording& recording, bool usable, const std::string& reason);

/// Returns the deviation of a flame filmed by several cameras from rotational symmetry (attribute `symmetry`, percent
/// and its 95 % interval; absent after too few blows).
ReportEntry symmetry_entry(const Recording& recording);

}  // namespace wisp
