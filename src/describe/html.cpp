#include <string>

#include "describe/values.hpp"

namespace wisp {
namespace {

std::string element(const char* name, std::string_view text) {
  return "<" + std::string(name) + ">" + html_escaped(text) + "</" + name + ">";
}

std::string row_of(const ReportEntry& entry) {
  std::string value = shown_with_unit(entry.value, entry.unit);
  if (entry.interval) value += " (95 %: " + shown((*entry.interval)[0]) + " to " + shown((*entry.interval)[1]) + ")";
  return "<tr>" + element("th", entry.label) + element("td", value) + element("td", entry.meaning) + "</tr>\n";
}

std::string html_of(const ReportTable& table) {
  std::string head, body;
  for (const ReportColumn& column : table.columns) {
    if (!column.label.empty()) head += element("th", with_unit(column.label, column.unit));
  }
  for (const auto& row : table.rows) {
    body += "<tr>";
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const ReportColumn& column = table.columns[k];
      if (!column.label.empty()) body += element("td", shown_in_unit(row[k], column.unit));
    }
    body += "</tr>\n";
  }
  return "<table><caption>" + html_escaped(table.label) + "</caption>\n<tr>" + head + "</tr>\n" + body + "</table>\n";
}

std::string html_of(const ReportSection& section) {
  std::string rows, tables;
  for (const ReportEntry& entry : section.entries) {
    if (!entry.label.empty()) rows += row_of(entry);
  }
  for (const ReportTable& table : section.tables) {
    if (!table.label.empty()) tables += html_of(table);
  }
  if (rows.empty() && tables.empty()) return "";
  std::string out = section.title.empty() ? "" : element("h3", section.title) + "\n";
  if (!rows.empty()) out += "<table class=\"figures\">\n" + rows + "</table>\n";
  return out + tables;
}

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string out;
  for (char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string to_html(const Report& report) {
  std::string out;
  if (const auto& verdict = report.verdict) {
    out += std::string("<p class=\"verdict ") + (verdict->usable ? "usable" : "refused") + "\">" +
           (verdict->usable ? "usable: " : "not usable: ") + html_escaped(verdict->reason) + "</p>\n";
  }
  if (!report.warnings.empty()) {
    out += "<ul class=\"warnings\">\n";
    for (const std::string& warning : report.warnings) out += element("li", warning) + "\n";
    out += "</ul>\n";
  }
  for (const ReportSection& section : report.sections) out += html_of(section);
  return out;
}

}  // namespace wisp
