#include "wisp/base/report.hpp"

#include <iterator>

namespace wisp {

ReportSection& Report::add(std::string title) { return sections.emplace_back(ReportSection{std::move(title)}); }

const ReportEntry* Report::find(std::string_view id) const {
  for (const ReportSection& section : sections) {
    for (const ReportEntry& entry : section.entries) {
      if (entry.id == id) return &entry;
    }
  }
  return nullptr;
}

void Report::append(Report other) {
  std::move(other.warnings.begin(), other.warnings.end(), std::back_inserter(warnings));
  std::move(other.sections.begin(), other.sections.end(), std::back_inserter(sections));
}

}  // namespace wisp
