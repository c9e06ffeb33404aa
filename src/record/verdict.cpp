#include "record/verdict.hpp"

namespace wisp {

std::optional<RecordingVerdict> verdict_of(const Recording& recording) {
  const auto usable = find_attribute(recording, "usable");
  if (!usable) return std::nullopt;
  const auto reason = find_attribute(recording, "usable_reason");
  return RecordingVerdict{*usable != "no", reason ? std::string(*reason) : std::string()};
}

std::optional<std::string> refused_by_capture(std::span<const Recording> recordings) {
  for (const Recording& recording : recordings) {
    const auto verdict = verdict_of(recording);
    if (verdict && !verdict->usable) return recording.source + " was captured as not usable: " + verdict->reason;
  }
  return std::nullopt;
}

void set_verdict(Recording& recording, bool usable, const std::string& reason) {
  std::erase_if(recording.attributes, [](const Attribute& attribute) {
    return attribute.name == "usable" || attribute.name == "usable_reason";
  });
  recording.attributes.push_back({"usable", usable ? "yes" : "no"});
  recording.attributes.push_back({"usable_reason", reason});
}

ReportEntry symmetry_entry(const Recording& recording) {
  ReportEntry entry{"symmetry_differs", {}, "lean differs with the wind's direction by", "%", {}, ""};
  const auto told = numbers_attribute(recording, "symmetry");
  if (!told || !*told || (*told)->size() != 3) {
    entry.meaning = "unknown: expected at least nine blows, from all round";
    return entry;
  }
  entry.value = (**told)[0];
  entry.interval = {(**told)[1], (**told)[2]};
  entry.meaning = "a flame that is the same from all sides, as it is played: an interval that begins at 0";
  return entry;
}

}  // namespace wisp
