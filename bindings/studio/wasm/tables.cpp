// Reads tables and recordings for display. Those to be learned from are added in learning.cpp.

#include "reported.hpp"
#include "settings.hpp"
#include "wisp/learn/advice.hpp"

using namespace wisp;
using namespace wisp::studio;

extern "C" {

// Reads a table or a recording: {name, rate, inputs, outputs}.
WISP_STUDIO(table) int studio_table(const char* bytes, std::size_t size, const char* text, std::size_t text_size) {
  const auto recording = read_recording(bytes, size, parsed(text, text_size));
  if (!recording) return fail(recording.error());
  return hand_over(*recording, {});
}

// Reads a table and reports remarks that need no model, without series, as the answer has the samples already.
WISP_STUDIO(advise) int studio_advise(const char* bytes, std::size_t size, const char* text, std::size_t text_size) {
  const auto recording = read_recording(bytes, size, parsed(text, text_size));
  if (!recording) return fail(recording.error());
  Report report = advise(*recording);
  for (ReportSection& section : report.sections) section.series.clear();
  return hand_over(*recording, report);
}
}
