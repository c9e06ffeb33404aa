#pragma once
// Recordings as they come, and as answers, as reports are.

#include <nlohmann/json.hpp>

#include "answer.hpp"
#include "wisp/base/report.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::studio {

/// The report as the program's --json has it, its text and, for pictures, its series.
nlohmann::json report_json(const Report& report);

/// A table or a recording, as CSV: {name, rate, inputs, outputs}.
Result<Recording> read_recording(const char* bytes, std::size_t size, const nlohmann::json& settings);

/// A recording: its CSV as bytes, its channels' samples as numbers, one channel after the other.
int hand_over(const Recording& recording, const Report& report);

}  // namespace wisp::studio
