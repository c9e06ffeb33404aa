#include "reported.hpp"

#include <span>
#include <sstream>

#include "settings.hpp"
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

Result<Recording> read_recording(const char* bytes, std::size_t size, const json& settings) {
  std::istringstream stream(std::string(bytes, size));
  CsvOptions options{.inputs = names(settings, "inputs"), .outputs = names(settings, "outputs")};
  options.rate_hz = settings.value("rate", 0.0);
  options.usual_rate_hz = 1;
  return read_csv(stream, settings.value("name", "recording.csv"), options);
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
  text["why"] = recording.rate_note.text;
  text["rows"] = recording.rows();
  json begins = json::array();
  for (const Episode& episode : episodes(recording)) begins.push_back(episode.begin);
  text["episodes"] = std::move(begins);
  text["series"] = std::move(series);
  out.text = text.dump(-1, ' ', false, json::error_handler_t::replace);
  return kDone;
}

}  // namespace wisp::studio
