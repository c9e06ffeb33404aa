#include "wisp/describe/json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace wisp {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ReportValue& value);

Json json_of(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of(const ReportList& list) {
  Json out = Json::array();
  for (const ReportValue& each : list) out.push_back(json_of(each));
  return out;
}

Json json_of(const ReportValue& value) {
  return std::visit(
      [](const auto& held) {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::monostate>)
          return Json(nullptr);
        else if constexpr (std::is_same_v<Held, double> || std::is_same_v<Held, ReportList>)
          return json_of(held);
        else
          return Json(held);
      },
      static_cast<const ReportValue::Base&>(value));
}

// The field that a dotted id names, made on the way.
Json& field(Json& object, std::string_view id) {
  Json* at = &object;
  for (;;) {
    const auto dot = id.find('.');
    at = &(*at)[std::string(id.substr(0, dot))];
    if (dot == std::string_view::npos) return *at;
    id.remove_prefix(dot + 1);
  }
}

Json json_of(const ReportTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t k = 0; k < row.size(); ++k) field(object, table.columns[k].id) = json_of(row[k]);
    rows.push_back(std::move(object));
  }
  return rows;
}

}  // namespace

std::string to_json(const Report& report, int indent) {
  Json out = Json::object();
  for (const ReportSection& section : report.sections) {
    for (const ReportEntry& entry : section.entries) {
      if (entry.id.empty()) continue;  // a sentence for people
      field(out, entry.id) = json_of(entry.value);
      if (entry.interval)
        field(out, entry.id + "_ci95") = {json_of((*entry.interval)[0]), json_of((*entry.interval)[1])};
    }
    for (const ReportTable& table : section.tables) field(out, table.id) = json_of(table);
  }
  if (!report.warnings.empty()) out["warnings"] = report.warnings;
  if (report.verdict) out["usable"] = {{"verdict", report.verdict->usable}, {"reason", report.verdict->reason}};
  return out.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace wisp
