#pragma once
// What capturing thought of a recording travels with it, so that whoever learns from the file hears of it.

#include <optional>
#include <span>
#include <string>

#include "wisp/base/report.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Whether a recording can be learned from, and why (attributes `usable`, yes or no, and `usable_reason`).
struct RecordingVerdict {
  bool usable = true;
  std::string reason;
};

/// Nothing where the recording does not say.
std::optional<RecordingVerdict> verdict_of(const Recording& recording);

/// Why a model of these recordings is not usable, however well it plays: one of them was captured as not usable.
/// Nothing: none was.
std::optional<std::string> refused_by_capture(std::span<const Recording> recordings);

/// Says it.
void set_verdict(Recording& recording, bool usable, const std::string& reason);

/// How far a flame that several cameras filmed is from being the same from all sides (attribute `symmetry`, percent and
/// its 95 % interval; absent where too few blows told it).
ReportEntry symmetry_entry(const Recording& recording);

}  // namespace wisp
