#include "wisp/describe/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>

namespace wisp {
namespace {

// Returns the number of characters on a terminal: bytes that begin a UTF-8 sequence.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }));
}

std::string padded(std::string text, std::size_t to) {
  const std::size_t has = width(text);
  if (has < to) text.append(to - has, ' ');
  return text;
}

// Returns whether a value is a percentage so low that it comes from a diverging simulation.
bool diverges(const ReportValue& value, const std::string& unit) {
  constexpr double kRunsAway = -1000;
  const auto* number = std::get_if<double>(static_cast<const ReportValue::Base*>(&value));
  return unit == "%" && number && *number < kRunsAway;
}

// Returns the text followed by its unit, if any.
std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}

// Formats a value without its unit; percentages of a diverging simulation become "diverges".
std::string shown_in_unit(const ReportValue& value, const std::string& unit) {
  if (diverges(value, unit)) return "diverges";
  const auto* list = std::get_if<ReportList>(static_cast<const ReportValue::Base*>(&value));
  if (!list) return shown(value);
  std::string out;
  for (const ReportValue& each : *list) out += (out.empty() ? "" : ", ") + shown_in_unit(each, unit);
  return out;
}

// Formats an entry's value with its unit and interval.
std::string shown_whole(const ReportEntry& entry) {
  std::string text = shown_in_unit(entry.value, entry.unit);
  if (text != "diverges") text = with_unit(text, entry.unit);
  if (entry.interval) text += " (95 %: " + shown((*entry.interval)[0]) + " to " + shown((*entry.interval)[1]) + ")";
  return text;
}

std::string line_of(const ReportEntry& entry, std::size_t label_width) {
  std::string line = "  " + padded(entry.label, label_width) + "  " + shown_whole(entry);
  if (!entry.meaning.empty()) line += "   " + entry.meaning;
  return line + "\n";
}

std::string cell_of(const ReportTable& table, const std::vector<ReportValue>& row, std::size_t column) {
  return shown_in_unit(row[column], table.columns[column].unit);
}

std::string text_of(const ReportTable& table) {
  std::vector<std::size_t> kept, widths;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].label.empty()) continue;
    kept.push_back(k);
    widths.push_back(width(with_unit(table.columns[k].label, table.columns[k].unit)));
  }
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < kept.size(); ++c) widths[c] = std::max(widths[c], width(cell_of(table, row, kept[c])));
  }
  const auto line = [&](const auto& cell) {
    std::string text = " ";
    for (std::size_t c = 0; c < kept.size(); ++c) text += " " + padded(cell(kept[c]), widths[c] + 1);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string out = "  " + table.label + "\n";
  out += line([&](std::size_t k) { return with_unit(table.columns[k].label, table.columns[k].unit); });
  for (const auto& row : table.rows) out += line([&](std::size_t k) { return cell_of(table, row, k); });
  return out;
}

std::string text_of(const ReportSection& section) {
  std::size_t label_width = 0;
  for (const ReportEntry& entry : section.entries) label_width = std::max(label_width, width(entry.label));
  std::string body;
  for (const ReportEntry& entry : section.entries) {
    if (!entry.label.empty()) body += line_of(entry, label_width);
  }
  for (const ReportTable& table : section.tables) {
    if (!table.label.empty()) body += text_of(table);
  }
  return body.empty() || section.title.empty() ? body : section.title + "\n" + body;
}

std::string element(const char* name, std::string_view text) {
  return "<" + std::string(name) + ">" + html_escaped(text) + "</" + name + ">";
}

std::string row_of(const ReportEntry& entry) {
  return "<tr>" + element("th", entry.label) + element("td", shown_whole(entry)) + element("td", entry.meaning) +
         "</tr>\n";
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

std::string shown(const ReportValue& value, int digits) {
  struct Words {
    int digits;
    std::string operator()(std::monostate) const { return "none"; }
    std::string operator()(bool truth) const { return truth ? "yes" : "no"; }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(const std::string& text) const { return text; }
    std::string operator()(double number) const {
      if (!std::isfinite(number)) return "none";
      char out[64];
      return {out, std::to_chars(out, out + sizeof out, number, std::chars_format::general, digits).ptr};
    }
    std::string operator()(const ReportList& list) const {
      std::string out;
      for (const ReportValue& each : list) out += (out.empty() ? "" : ", ") + shown(each, digits);
      return out;
    }
  };
  return std::visit(Words{digits}, static_cast<const ReportValue::Base&>(value));
}

std::string to_text(const Report& report) {
  std::string out;
  if (report.verdict) out += (report.verdict->usable ? "usable: " : "not usable: ") + report.verdict->reason + "\n";
  for (const std::string& warning : report.warnings) out += "warning: " + warning + "\n";
  for (const ReportSection& section : report.sections) out += text_of(section);
  return out;
}

std::ostream& operator<<(std::ostream& out, const Report& report) { return out << to_text(report); }

std::string html_escaped(std::string_view text) {
  std::string out;
  for (char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
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
