#pragma once
// Recordings and reports as answers.

#include <nlohmann/json.hpp>

#include "answer.hpp"
#include "wisp/base/report.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::studio {

/// The report as the program's --json has it, its text and, for pictures, its series.
nlohmann::json report_json(const Report& report);

/// A recording: its CSV as bytes, its channels' samples as numbers, one channel after the other.
int hand_over(const Recording& recording, const Report& report);

}  // namespace wisp::studio
