#include <algorithm>
#include <cmath>
#include <set>

#include "record/csv_cells.hpp"
#include "record/csv_state.hpp"
#include "record/number_text.hpp"

namespace wisp {

// Format of a table, detected from its first lines.
namespace csv {
namespace {

struct Shape {
  std::size_t cells = 0;
  std::size_t filled = 0;  // number of cells before the empty ones at the end
  bool numbers = true;     // all cells are numbers, dates, times of day or missing
  bool any_number = false;
  bool quoted = true;     // all cells are in quotes
  bool labelled = false;  // the first cell is
};

std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  for_each_cell(line, separator, [&](const Cell& cell) { cells.push_back(cell); });
  return cells;
}

Shape shape_of(std::string_view line, char separator) {
  Shape shape;
  for_each_cell(line, separator, [&](const Cell& cell) {
    if (shape.cells++ == 0) shape.labelled = cell.quoted;
    shape.quoted &= cell.quoted;
    if (!cell.text.empty()) shape.filled = shape.cells;
    const bool number = number_of(cell, separator).has_value();
    shape.any_number |= number;
    shape.numbers &= number || is_missing(cell) || seconds_of_date(cell.text).has_value();
  });
  return shape;
}

// Returns whether a row begins with its name, for which R's write.table() writes no name of a column.
bool is_named(const Shape& names, const Shape& row) {
  return names.quoted && row.labelled && !row.quoted && row.filled == names.filled + 1;
}

// Returns whether a row has as many cells as names; separators at its end do not count.
bool fits(const Shape& names, const Shape& row) {
  return is_named(names, row) || (names.filled >= 2 && row.cells >= names.filled && row.filled <= names.filled);
}

// Detects the cell separator: a tab, a semicolon, a comma or blanks. `lines`: the first lines, without comments.
char separator_of(const std::vector<std::string>& lines) {
  const std::string_view names = lines.front(), row = lines.back();
  for (char candidate : {'\t', ';', ',', kBlanks}) {
    const Shape shape = shape_of(row, candidate);
    if ((shape.numbers || shape.labelled) && shape.any_number && fits(shape_of(names, candidate), shape))
      return candidate;
  }
  for (char candidate : {'\t', ';', ','}) {
    if (fits(shape_of(names, candidate), shape_of(row, candidate))) return candidate;
  }
  for (char candidate : {'\t', ';', ','}) {
    if (shape_of(names, candidate).cells >= 2) return candidate;
  }
  // The table has one column: a comma in its numbers is a decimal mark, so the separator must be another character.
  return shape_of(row, ';').numbers && row.find(',') != row.npos ? ';' : ',';
}

// Returns whether a line with text is a row: its cells are numbers, dates and text where the next line's are, and one
// is a date, or text that comes again below it. Names are neither.
bool is_row_with_text(std::string_view line, const std::vector<Lines::Line>& below, char separator) {
  const auto kind = [&](const Cell& cell) {
    return number_of(cell, separator) ? 'n' : seconds_of_date(cell.text) ? 'd' : 't';
  };
  const std::vector<Cell> cells = cells_of(line, separator);
  bool row = false;
  for (std::size_t b = 0; b < below.size(); ++b) {
    const std::vector<Cell> others = cells_of(below[b].text, separator);
    for (std::size_t k = 0; k < std::min(cells.size(), others.size()); ++k) {
      if (is_missing(cells[k]) || is_missing(others[k])) continue;
      const char own = kind(cells[k]);
      if (b == 0 && own != kind(others[k])) return false;
      row |= own == 'd' || (own == 't' && cells[k].text == others[k].text);
    }
  }
  return row;
}

// Returns whether a line below the names states only units: no numbers, though the next row has some.
bool is_row_of_units(std::string_view line, std::string_view next, char separator) {
  bool text = false, number = false;
  for_each_cell(line, separator, [&](const Cell& cell) {
    const bool one = cell.text == "1" || cell.text == "-";  // these mean dimensionless
    number |= !one && number_of(cell, separator).has_value();
    text |= !one && !is_missing(cell) && !number_of(cell, separator) && !seconds_of_date(cell.text);
  });
  return text && !number && shape_of(next, separator).any_number;
}

// Returns the units in a line of units, without brackets; "-" becomes "1".
std::vector<std::string> units_in(std::string_view line, char separator) {
  std::vector<std::string> units;
  for_each_cell(line, separator, [&](const Cell& cell) {
    std::string_view unit = cell.text;
    const bool bracketed = unit.size() >= 2 &&
                           ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')'));
    if (bracketed) unit = unit.substr(1, unit.size() - 2);
    units.push_back(unit == "-" ? "1" : text_of({unit, cell.quoted}));
  });
  return units;
}

// Returns the separator that a line such as `sep=;` states for Excel; NUL for any other line.
char told_separator(std::string_view line) {
  const std::string_view said = cell_of(line).text;
  const bool told = said.size() <= 5 && (said.substr(0, 4) == "sep=" || said.substr(0, 4) == "SEP=");
  return !told ? '\0' : said.size() == 5 ? said[4] : '\t';  // cell_of() removes a tab
}

}  // namespace
}  // namespace csv

namespace {

constexpr std::size_t kLookedAt = 3;  // lines from which the format is detected: names, units, a row
constexpr std::size_t kTimed = 1000;  // rows from which the time step is detected

struct ColumnName {
  std::string role;
  std::string name;
  std::string unit;
};

ColumnName split_name(std::string_view text) {
  ColumnName out;
  for (std::string_view role : {"u", "y", "m", "flag"}) {
    if (text.size() > role.size() && text.substr(0, role.size()) == role && text[role.size()] == ':') {
      out.role = role;
      text.remove_prefix(role.size() + 1);
      break;
    }
  }
  const std::size_t bracket = text.find('[');
  if (bracket != std::string_view::npos && text.back() == ']') {
    out.unit = text.substr(bracket + 1, text.size() - bracket - 2);
    text = text.substr(0, bracket);
  }
  out.name = csv::trimmed(text);
  return out;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the role of a column, or nothing if the column is not to be read.
std::optional<Role> role_of(const ColumnName& column, const CsvOptions& options) {
  if (contains(options.inputs, column.name)) return Role::kInput;
  if (contains(options.outputs, column.name)) return Role::kOutput;
  if (column.role == "m") return Role::kMotion;
  if (column.role.empty() && contains(options.usual_inputs, column.name)) return Role::kInput;
  if (column.role.empty() && contains(options.usual_outputs, column.name)) return Role::kOutput;
  const bool chosen = !options.inputs.empty() || !options.outputs.empty();
  if (chosen && !options.every_column) return std::nullopt;
  if (column.role == "u") return Role::kInput;
  if (column.role == "y") return Role::kOutput;
  if (options.every_column && column.role.empty() && !column.name.empty() && !csv::names_time(column.name)) {
    return Role::kOutput;
  }
  return std::nullopt;
}

// Returns whether a step between whole numbers is typical of milliseconds. Multiples of 15 are typical of seconds.
bool counts_milliseconds(double step) { return step >= 2 && step <= 1000 && std::fmod(step, 15) != 0; }

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 40;
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), kMax); ++k) text += (k == 0 ? "" : ", ") + csv::as_named(names[k]);
  return names.size() > kMax ? text + " and " + std::to_string(names.size() - kMax) + " more" : text;
}

}  // namespace

// Determines the rate, from the file's statement, the caller's, the time column, or the default, in this order.
Result<void> CsvReader::State::read_rate(const CsvOptions& options) {
  if (header.rate_hz == 0) header.rate_hz = options.rate_hz;
  if (header.rate_hz != 0) time.reset();
  if (time) {
    if (auto ok = learn_step(); !ok) return ok;
  }
  if (header.rate_hz == 0 && options.usual_rate_hz > 0) {
    header.rate_hz = options.usual_rate_hz;
    header.rate_note = {"the table states no rate: taken as " + number_text(header.rate_hz, 6) + " Hz", true};
  }
  if (header.rate_hz == 0) {
    return Error{lines.name() +
                 ": states no rate; expected a line \"# rate_hz 30\" above the header, a column of time in seconds, or "
                 "--rate HZ or --dt S"};
  }
  if (std::isfinite(header.rate_hz) && header.rate_hz > 0) return {};
  return Error{lines.name() + ": the rate is " + std::to_string(header.rate_hz) + " Hz, expected above 0"};
}

Result<void> CsvReader::State::read_attribute() {
  std::string_view line = csv::trimmed(csv::trimmed(lines.text()).substr(1));
  line = line.substr(0, line.find_last_not_of(",;\t ") + 1);  // a spreadsheet gives all lines as many cells
  const std::size_t space = line.find_first_of(" \t");
  const std::string key(line.substr(0, space));
  const std::string value(space == std::string_view::npos ? "" : csv::trimmed(line.substr(space)));
  if (key == "wisp-recording") {
    if (value != "1")
      return lines.at_row("is a Wisp recording of version " + csv::shown(value) +
                          ", this program reads version 1; update Wisp");
    own_form = true;
  } else if (key == "rate_hz") {
    const auto rate = csv::number_of({value, false}, ',');
    if (!rate || !(std::isfinite(*rate) && *rate > 0)) {
      return lines.at_row("rate_hz is " + csv::shown(value) + ", expected a number of samples a second above 0");
    }
    header.rate_hz = *rate;
  } else if (own_form && !key.empty()) {
    header.attributes.push_back({key, value});
  }
  return {};
}

// Reads comment lines and the separator for Excel; leaves the first line of the table in lines.text().
Result<void> CsvReader::State::read_attributes() {
  for (bool first = true;; first = false) {
    const auto more = lines.next();
    if (!more) return more.error();
    if (!*more) return Error{lines.name() + ": is empty, expected a header line with column names"};
    if (const char told = csv::told_separator(lines.text()); first && told != '\0') {
      separator = told;
    } else if (csv::trimmed(lines.text()).front() == '#' || csv::trimmed(lines.text()).front() == '%') {
      if (auto ok = read_attribute(); !ok) return ok;
    } else {
      lines.pass_comments();
      return {};
    }
  }
}

// Returns the names of all columns, from the options or from lines.text(). That line is consumed unless it has numbers.
Result<std::vector<std::string>> CsvReader::State::read_names(const CsvOptions& options) {
  auto ahead = lines.look_ahead(kLookedAt - 1);
  if (!ahead) return ahead.error();
  std::vector<std::string> first{std::string(lines.text())};
  for (const auto& line : *ahead) first.push_back(line.text);
  if (separator == '\0' || own_form) separator = csv::separator_of(first);
  if (own_form && lines.text().find(separator) == std::string_view::npos) separator = ',';
  const std::vector<csv::Cell> cells = csv::cells_of(lines.text(), separator);
  std::vector<std::string> names;
  for (const csv::Cell& cell : cells) names.push_back(csv::text_of(cell));
  while (names.size() > 1 && names.back().empty()) names.pop_back();
  const csv::Shape shape = csv::shape_of(lines.text(), separator);
  bool numbers = shape.numbers && shape.any_number;
  if (!numbers && shape.any_number && !own_form) {
    if (ahead = lines.look_ahead(kTimed); !ahead) return ahead.error();
    numbers = csv::is_row_with_text(lines.text(), *ahead, separator);
  }
  if (!own_form && csv::is_named(shape, csv::shape_of(first.back(), separator))) names.insert(names.begin(), "");
  if (!options.columns.empty()) {
    if (options.columns.size() < names.size() || options.columns.size() > std::max(cells.size(), names.size())) {
      return lines.at_row("has " + std::to_string(names.size()) + " columns, --columns names " +
                          std::to_string(options.columns.size()) + "; name all of them, in their order");
    }
    if (numbers) lines.back();
    return options.columns;
  }
  if (!numbers) return names;
  std::string example;
  for (std::size_t k = 0; k < std::min<std::size_t>(names.size(), 6); ++k)
    example += (k == 0 ? "" : ",") + std::string(k + 1 < names.size() ? "u" + std::to_string(k + 1) : "y1");
  return lines.at_row("starts with numbers, expected a header line with column names; give names to its " +
                      std::to_string(names.size()) + " columns with --columns, such as --columns " + example);
}

Result<void> CsvReader::State::add_column(const std::string& text, const CsvOptions& options) {
  const ColumnName column = split_name(text);
  const bool episode = column.role.empty() && column.name == "episode";
  if (own_form && column.role.empty() && !episode) {
    return lines.at_row("column " + csv::shown(text) + " has no role; expected u:, y:, m: or flag: before its name");
  }
  if (column.name.empty() && (own_form || !column.role.empty())) {
    return lines.at_row("column " + std::to_string(columns.size() + 1) + " has no name");
  }
  if (episode) {
    columns.push_back({Column::Kind::kEpisode, 0});
  } else if (column.role == "flag") {
    columns.push_back({Column::Kind::kFlag, header.flags.size()});
    header.flags.push_back({column.name, {}});
  } else if (const auto role = role_of(column, options)) {
    columns.push_back({Column::Kind::kChannel, header.channels.size()});
    header.channels.push_back({column.name, column.unit, *role, {}});
  } else {
    columns.push_back({});
  }
  return {};
}

// Errors: two columns of one name, of which the second is to be read; a requested column is missing; no channel.
Result<void> CsvReader::State::check_columns(const std::vector<std::string>& names, const CsvOptions& options) const {
  std::set<std::string> seen;
  std::vector<std::string> available;
  bool any_role = false;
  for (const std::string& name : names) {
    const ColumnName column = split_name(name);
    any_role |= !column.role.empty();
    const bool episode = column.role.empty() && column.name == "episode";
    if (column.name.empty()) continue;
    if (!episode) available.push_back(column.name);
    if (seen.insert(episode ? ":episode" : column.role == "flag" ? name : column.name).second) continue;
    if (own_form || episode || role_of(column, options)) {
      return lines.at_row("two columns are named " + csv::shown(column.name) +
                          "; rename one, or name all with --columns");
    }
  }
  for (const auto* wanted : {&options.inputs, &options.outputs}) {
    for (const std::string& name : *wanted) {
      if (!contains(available, name))
        return lines.at_row("has no column " + csv::shown(name) + "; its columns are " + listed(available));
    }
  }
  if (!header.channels.empty()) return {};
  return lines.at_row(any_role ? "the header has no input, output or motion column"
                               : "the columns (" + listed(available) +
                                     ") state no roles; name them with --inputs and --outputs");
}

// Selects the first time column that is not `still`, as a date is beside a time of day; otherwise the last one.
void CsvReader::State::find_time(const std::vector<std::string>& names, const std::vector<bool>& still) {
  for (std::size_t k = 0; !own_form && k < names.size(); ++k) {
    const ColumnName column = split_name(names[k]);
    if ((time && !still[time->place]) || !column.role.empty() || !csv::names_time(column.name)) continue;
    time = Time{k, column.name, column.unit.empty() ? csv::unit_in_time_name(column.name) : column.unit};
    time->dotted = column.name.find_first_of("dD") != 0;  // under "date", 13.05.59 is one
  }
}

// Reads the line of units below the names, if there is one.
Result<void> CsvReader::State::read_units() {
  const auto ahead = lines.look_ahead(2);
  if (!ahead) return ahead.error();
  if (own_form || ahead->size() < 2) return {};
  if (!csv::is_row_of_units((*ahead)[0].text, (*ahead)[1].text, separator)) return {};
  const std::vector<std::string> units = csv::units_in((*ahead)[0].text, separator);
  if (time && time->place < units.size() && csv::seconds_of_date(units[time->place])) return {};
  if (time && time->unit.empty() && time->place < units.size()) time->unit = units[time->place];
  for (std::size_t k = 0; k < std::min(units.size(), columns.size()); ++k) {
    if (columns[k].kind != Column::Kind::kChannel) continue;
    std::string& unit = header.channels[columns[k].index].unit;
    if (unit.empty()) unit = units[k];
  }
  if (const auto passed = lines.next(); !passed) return passed.error();
  return {};
}

Result<void> CsvReader::State::read_columns(const CsvOptions& options) {
  const auto names = read_names(options);
  if (!names) return names.error();
  const auto ahead = lines.look_ahead(kLookedAt);  // units and two rows, or rows
  if (!ahead) return ahead.error();
  const auto first =
      csv::cells_of(ahead->size() < 2 ? std::string_view() : (*ahead)[ahead->size() - 2].text, separator);
  const auto last = csv::cells_of(ahead->empty() ? std::string_view() : ahead->back().text, separator);
  std::vector<bool> still(names->size());  // columns with equal cells in both lines
  for (std::size_t k = 0; k < names->size(); ++k) {
    still[k] = k < std::min(first.size(), last.size()) && first[k].text == last[k].text;
    const bool text = !(*names)[k].empty() && k < last.size() && !csv::is_missing(last[k]) &&
                      !csv::number_of(last[k], separator) && !csv::names_time((*names)[k]);
    if (options.every_column && text && !own_form) {
      columns.push_back({});
      header.attributes.push_back({std::string(kNotNumbers), (*names)[k]});
    } else if (auto ok = add_column((*names)[k], options); !ok) {
      return ok;
    }
  }
  if (auto ok = check_columns(*names, options); !ok) return ok;
  find_time(*names, still);
  return read_units();
}

// Determines the rate from the first rows' time.
Result<void> CsvReader::State::learn_step() {
  const auto ahead = lines.look_ahead(kTimed);
  if (!ahead) return ahead.error();
  std::vector<double> found;
  double resolution = 1;
  for (const auto& line : *ahead) {
    const std::vector<csv::Cell> cells = csv::cells_of(line.text, separator);
    const auto now = time->place < cells.size() ? time_in(cells[time->place]) : std::nullopt;
    if (!now) break;
    found.push_back(*now);
    resolution = std::min(resolution, csv::resolution_of(cells[time->place].text));
    if (time->dotted && time->of_day < 0) {  // one of the cells is a date, so all are
      time->dotted = false, time->midnight = 0;
      return learn_step();
    }
  }
  time->of_day = time->midnight = 0;
  const std::string column = "column " + csv::shown(time->name);
  const auto seconds = time->unit.empty() ? 1 : csv::seconds_of(time->unit);
  const std::string instead = "; say --rate HZ or --dt S instead";
  if (!seconds)
    return Error{lines.name() + ": " + column + " is in " + csv::shown(time->unit) + ", expected s or ms" + instead};
  if (found.empty() && !ahead->empty()) {
    return lines.at_row(column + " is no number of seconds" + instead, ahead->front().row);
  }
  if (found.size() < 2) return {};
  const double epoch = time->unit.empty() && !time->dated ? csv::unit_since_1970(found.front()) : 0;
  time->seconds = epoch > 0 ? epoch : *seconds;
  const auto step = csv::step_of(found, resolution, time->seconds);
  if (!step) {
    return lines.at_row(column + " does not go on: " + number_text(found[1], 12) + " after " +
                            number_text(found[0], 12) + "; sort the rows by time, or say --rate HZ or --dt S",
                        (*ahead)[1].row);
  }
  const bool bare = time->unit.empty() && !time->dated && epoch == 0;
  if (bare && step->step == 1) return {};  // the column counts rows
  header.rate_note.text =
      "from " + column + ", in steps of " + number_text(step->step, 6) + " " + (time->unit.empty() ? "s" : time->unit);
  if (epoch > 0) {
    header.rate_note = {column + " has no unit: taken as steps of " + number_text(epoch) + " s since 1970", true};
  } else if (bare && !(resolution < 1) && counts_milliseconds(step->step)) {
    time->seconds = 1e-3;
    header.rate_note = {
        column + " has no unit and goes on by whole steps of " + number_text(step->step) + ": taken as milliseconds",
        true};
  }
  time->step = step->step;
  time->tolerance = step->tolerance;
  header.rate_hz = 1 / (step->step * time->seconds);
  return {};
}

// Parses a finite number, or the seconds of a date or time of day, which have no other unit. A time of day that falls
// back by more than half a day, or half an hour if it has no hours, is past midnight, or the next hour.
std::optional<double> CsvReader::State::time_in(const csv::Cell& cell) {
  const auto number = csv::number_of(cell, separator);
  if (number) return std::isfinite(*number) ? number : std::nullopt;
  const auto seconds = csv::seconds_of_date(csv::trimmed(cell.text), time->dotted);
  if (!seconds) return std::nullopt;
  time->dated = true, time->unit.clear();
  const bool date = *seconds < 0 || *seconds >= 86400;
  const bool hours = std::count(cell.text.begin(), cell.text.end(), ':') != 1;
  const double round = hours || cell.text.find_first_of(".,") == cell.text.npos ? 86400 : 3600;
  if (!date && *seconds < time->of_day - round / 2) time->midnight += round;
  time->of_day = date ? -1 : *seconds;
  return *seconds + time->midnight;
}

}  // namespace wisp
