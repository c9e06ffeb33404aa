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

// Returns the field that an id names, creating it if needed: a.b is a field of a field, a[2] an element, and a
// backslash escapes the next character.
Json& field(Json& object, std::string_view id) {
  Json* at = &object;
  std::string name;
  bool element = false;  // the id so far ends in a list index; `at` is this element
  const auto step = [&] {
    if (!element) at = &(*at)[name];
    name.clear();
    element = false;
  };
  for (std::size_t k = 0; k < id.size(); ++k) {
    if (id[k] == '.') {
      step();
    } else if (id[k] == '[') {
      step();
      std::size_t index = 0;
      for (++k; k < id.size() && id[k] != ']'; ++k) index = 10 * index + static_cast<std::size_t>(id[k] - '0');
      at = &(*at)[index];
      element = true;
    } else {
      if (id[k] == '\\' && k + 1 < id.size()) ++k;
      name += id[k];
    }
  }
  step();
  return *at;
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
      if (entry.id.empty()) continue;  // for text and HTML only
      field(out, entry.id) = json_of(entry.value);
      if (entry.interval)
        field(out, entry.id + "_ci95") = {json_of((*entry.interval)[0]), json_of((*entry.interval)[1])};
    }
    for (const ReportTable& table : section.tables) {
      if (!table.id.empty()) field(out, table.id) = json_of(table);
    }
  }
  if (!report.warnings.empty()) out["warnings"] = report.warnings;
  if (report.verdict) out["usable"] = {{"verdict", report.verdict->usable}, {"reason", report.verdict->reason}};
  if (report.verdict && !report.verdict->code.empty()) out["usable"]["code"] = report.verdict->code;
  return out.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace wisp
