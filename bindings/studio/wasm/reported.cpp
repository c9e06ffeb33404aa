#include "reported.hpp"

#include <span>

#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::studio {
namespace {

using nlohmann::json;

const char* role_name(Role role) {
  return role == Role::kInput ? "input" : role == Role::kOutput ? "output" : "motion";
}

}  // namespace

json report_json(const Report& report) {
  json out = json::parse(to_json(report, -1), nullptr, false);
  json curves = json::array();
  for (const ReportSection& section : report.sections) {
    for (const ReportSeries& series : section.series) {
      curves.push_back({{"id", series.id},
                        {"label", series.label},
                        {"x_label", series.x_label},
                        {"y_label", series.y_label},
                        {"x", series.x},
                        {"y", series.y}});
    }
  }
  return json{{"report", std::move(out)}, {"curves", std::move(curves)}, {"text", to_text(report)}};
}

int hand_over(const Recording& recording, const Report& report) {
  Answer& out = fresh();
  const std::string csv = csv_text(recording);
  const auto bytes = std::as_bytes(std::span(csv));
  out.bytes.assign(bytes.begin(), bytes.end());
  json series = json::array();
  for (const Channel& channel : recording.channels) {
    series.push_back({{"name", channel.name}, {"unit", channel.unit}, {"role", role_name(channel.role)}});
    out.numbers.insert(out.numbers.end(), channel.samples.begin(), channel.samples.end());
  }
  json text = report_json(report);
  text["rate"] = recording.rate_hz;
  text["rows"] = recording.rows();
  json begins = json::array();
  for (const Episode& episode : episodes(recording)) begins.push_back(episode.begin);
  text["episodes"] = std::move(begins);
  text["series"] = std::move(series);
  out.text = text.dump();
  return kDone;
}

}  // namespace wisp::studio
