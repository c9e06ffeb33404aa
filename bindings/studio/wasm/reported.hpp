#pragma once
// Reads recordings, and returns recordings and reports as answers.

#include <nlohmann/json.hpp>

#include "answer.hpp"
#include "wisp/base/report.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::studio {

/// Returns {report, curves, text}: the report as the program prints it with --json, its series, and as text.
nlohmann::json report_json(const Report& report);

/// Reads a table or a recording from CSV: {name, rate, inputs, outputs}.
Result<Recording> read_recording(const char* bytes, std::size_t size, const nlohmann::json& settings);

/// Answers with a recording: its CSV as bytes, its samples as numbers, channel after channel.
int hand_over(const Recording& recording, const Report& report);

}  // namespace wisp::studio
