#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <limits>
#include <set>
#include <utility>

#include "base/path_text.hpp"
#include "record/csv_cells.hpp"
#include "record/csv_dialect.hpp"
#include "record/csv_time.hpp"
#include "record/number_text.hpp"
#include "wisp/record/csv.hpp"

namespace wisp {
namespace {

constexpr std::size_t kLongestLine = std::size_t{16} << 20;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLookedAt = 3;  // lines that show how a table is written: names, units, a row
constexpr std::size_t kTimed = 1000;  // rows that show how far apart all are

using csv::Cell;
using csv::trimmed;

// What was found, short enough for a message of one line.
std::string shown(std::string_view text) {
  constexpr std::size_t kMax = 40;
  std::string out;
  for (char c : text.substr(0, kMax)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return "\"" + out + (text.size() > kMax ? "…\"" : "\"");
}

bool is_text(std::string_view line) {
  return std::none_of(line.begin(), line.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t' && c != '\r') || byte == 0x7f;
  });
}

std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  csv::for_each_cell(line, separator, [&](const Cell& cell) { cells.push_back(cell); });
  return cells;
}

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
  out.name = trimmed(text);
  return out;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The role of a column, or nothing where it is not wanted.
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

// As --inputs takes it: a name that holds a comma stands in quotes, with its own doubled.
std::string as_named(const std::string& name) {
  if (name.find(',') == std::string::npos && name.front() != '"') return name;
  std::string text = "\"";
  for (char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

// Whole steps that loggers count in thousandths of a second, and seconds are not counted in.
bool counts_milliseconds(double step) {
  return step == std::round(step) && step >= 2 && step <= 1000 && std::fmod(step, 15) != 0;
}

// Enough of them to choose from.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 40;
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), kMax); ++k) text += (k == 0 ? "" : ", ") + as_named(names[k]);
  return names.size() > kMax ? text + " and " + std::to_string(names.size() - kMax) + " more" : text;
}

// A line between rows that is none.
bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text == "#" || text.substr(0, 2) == "# " || text.substr(0, 1) == "%";  // #N/A and #DIV/0! are cells
}

// One to three digits, a comma and three digits: a thousand, or little more than one.
bool may_be_thousands(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const std::size_t comma = text.find(',');
  return comma >= 1 && comma <= 3 && text.size() == comma + 4 && text.front() != '0';
}

bool is_utf16(std::string_view line) { return line.substr(0, 2) == "\xff\xfe" || line.substr(0, 2) == "\xfe\xff"; }

}  // namespace

Error CsvReader::at_row(const std::string& what) const {
  return {name_ + ", row " + std::to_string(row_) + ": " + what};
}

// Puts the next line of the stream that is not blank into `line`; false at the end.
Result<bool> CsvReader::read_line(Line& line) {
  do {
    line.text.clear();
    line.row = ++rows_read_;
    auto* buffer = stream_->rdbuf();
    int c = buffer->sbumpc();
    if (c == std::char_traits<char>::eof()) return false;
    for (; c != std::char_traits<char>::eof() && c != '\n'; c = buffer->sbumpc()) {
      if (c == '\r' && buffer->sgetc() != '\n') break;  // the end of a line by itself, as old programs write it
      if (line.text.size() == kLongestLine) {
        row_ = line.row;
        return at_row("the line is longer than 16 MiB, expected a row of numbers; is this a CSV file?");
      }
      line.text.push_back(static_cast<char>(c));
    }
    if (is_text(line.text)) {
      if (in_table_ && is_comment(line.text)) line.text.clear();
      continue;
    }
    row_ = line.row;
    if (line.row == 1 && is_utf16(line.text)) return at_row("is UTF-16; save it as UTF-8 (Excel: \"CSV UTF-8\")");
    return at_row("holds bytes that are not text; expected a CSV file");
  } while (trimmed(line.text).empty());
  return true;
}

// Puts the next line that is not blank into line_; false at the end.
Result<bool> CsvReader::next_line() {
  if (ahead_.empty()) {
    Line line{std::move(line_), 0};
    auto more = read_line(line);
    line_ = std::move(line.text);
    row_ = line.row;
    return more;
  }
  line_ = std::move(ahead_.front().text);
  row_ = ahead_.front().row;
  ahead_.pop_front();
  return true;
}

// The texts of line_ and of those after it, which stay to be read.
Result<std::vector<std::string>> CsvReader::look_ahead(std::size_t count) {
  while (ahead_.size() + 1 < count) {
    const std::size_t row = row_;
    Line line;
    const auto more = read_line(line);
    if (!more) return more.error();
    row_ = row;
    if (!*more) break;
    ahead_.push_back(std::move(line));
  }
  std::vector<std::string> lines = {line_};
  for (const Line& line : ahead_) lines.push_back(line.text);
  return lines;
}

Result<CsvReader> CsvReader::open(std::istream& stream, std::string_view name, const CsvOptions& options) {
  CsvReader reader;
  reader.stream_ = &stream;
  reader.name_ = name;
  reader.header_.source = name;
  if (auto ok = reader.read_attributes(); !ok) return ok.error();
  if (auto ok = reader.read_columns(options); !ok) return ok.error();
  if (auto ok = reader.read_rate(options); !ok) return ok.error();
  return reader;
}

// What the file says, what its reader says, what a column of time says, what is usual.
Result<void> CsvReader::read_rate(const CsvOptions& options) {
  if (header_.rate_hz == 0) header_.rate_hz = options.rate_hz;
  if (header_.rate_hz != 0) time_.reset();
  if (time_) {
    if (auto ok = learn_step(); !ok) return ok;
  }
  if (header_.rate_hz == 0 && options.usual_rate_hz > 0) {
    header_.rate_hz = options.usual_rate_hz;
    header_.rate_note = {"the table states no rate: taken as " + number_text(header_.rate_hz, 6) + " Hz", true};
  }
  if (header_.rate_hz == 0) {
    return Error{name_ +
                 ": states no rate; expected a line \"# rate_hz 30\" above the header, a column of time in seconds, or "
                 "--rate HZ or --dt S"};
  }
  if (std::isfinite(header_.rate_hz) && header_.rate_hz > 0) return {};
  return Error{name_ + ": the rate is " + std::to_string(header_.rate_hz) + " Hz, expected above 0"};
}

// One comment line.
Result<void> CsvReader::read_attribute() {
  const std::string_view line = trimmed(trimmed(line_).substr(1));
  const std::size_t space = line.find_first_of(" \t");
  const std::string key(line.substr(0, space));
  const std::string value(space == std::string_view::npos ? "" : trimmed(line.substr(space)));
  if (key == "wisp-recording") {
    if (value != "1")
      return at_row("is a Wisp recording of version " + shown(value) + ", this program reads version 1; update Wisp");
    own_form_ = true;
  } else if (key == "rate_hz") {
    const auto rate = csv::number_of({value, false}, ',');
    if (!rate || !(std::isfinite(*rate) && *rate > 0)) {
      return at_row("rate_hz is " + shown(value) + ", expected a number of samples a second above 0");
    }
    header_.rate_hz = *rate;
  } else if (own_form_ && !key.empty()) {
    header_.attributes.push_back({key, value});
  }
  return {};
}

// Comment lines and what Excel is told; leaves the first line of the table in line_.
Result<void> CsvReader::read_attributes() {
  for (bool first = true;; first = false) {
    const auto more = next_line();
    if (!more) return more.error();
    if (!*more) return Error{name_ + ": is empty, expected a header line with column names"};
    if (first && line_.substr(0, 3) == "\xef\xbb\xbf") line_.erase(0, 3);
    if (const char told = csv::told_separator(line_); first && told != '\0') {
      separator_ = told;
    } else if (trimmed(line_).front() == '#' || trimmed(line_).front() == '%') {
      if (auto ok = read_attribute(); !ok) return ok;
    } else {
      in_table_ = true;
      return {};
    }
  }
}

// Names of all columns, from the options or from line_, which is then used up.
Result<std::vector<std::string>> CsvReader::read_names(const CsvOptions& options) {
  const auto lines = look_ahead(kLookedAt);
  if (!lines) return lines.error();
  if (own_form_) separator_ = ',';
  if (separator_ == '\0') separator_ = csv::separator_of(*lines);
  const std::vector<Cell> cells = cells_of(line_, separator_);
  std::vector<std::string> names;
  names.reserve(cells.size());
  for (const Cell& cell : cells) names.push_back(csv::text_of(cell));
  while (names.size() > 1 && names.back().empty()) names.pop_back();
  const bool numbers = csv::is_row(line_, separator_);
  if (!options.columns.empty()) {
    if (options.columns.size() != names.size()) {
      return at_row("has " + std::to_string(names.size()) + " columns, --columns names " +
                    std::to_string(options.columns.size()) + "; name all of them, in their order");
    }
    if (numbers) ahead_.push_front({line_, row_});
    return options.columns;
  }
  if (!numbers) return names;
  std::string example;
  for (std::size_t k = 0; k < std::min<std::size_t>(names.size(), 6); ++k)
    example += (k == 0 ? "" : ",") + std::string(k + 1 < names.size() ? "u" + std::to_string(k + 1) : "y1");
  return at_row("starts with numbers, expected a header line with column names; give names to its " +
                std::to_string(names.size()) + " columns with --columns, such as --columns " + example);
}

// One more column, by its name.
Result<void> CsvReader::add_column(const std::string& text, const CsvOptions& options) {
  const ColumnName column = split_name(text);
  const bool episode = column.role.empty() && column.name == "episode";
  if (own_form_ && column.role.empty() && !episode) {
    return at_row("column " + shown(text) + " has no role; expected u:, y:, m: or flag: before its name");
  }
  if (column.name.empty() && (own_form_ || !column.role.empty())) {
    return at_row("column " + std::to_string(columns_.size() + 1) + " has no name");
  }
  if (episode) {
    columns_.push_back({Column::Kind::kEpisode, 0});
  } else if (column.role == "flag") {
    columns_.push_back({Column::Kind::kFlag, header_.flags.size()});
    header_.flags.push_back({column.name, {}});
  } else if (const auto role = role_of(column, options)) {
    columns_.push_back({Column::Kind::kChannel, header_.channels.size()});
    header_.channels.push_back({column.name, column.unit, *role, {}});
  } else {
    columns_.push_back({});
  }
  return {};
}

// Two columns of one name are an error where one of them is wanted.
Result<void> CsvReader::check_columns(const std::vector<std::string>& names, const CsvOptions& options) const {
  std::set<std::string> seen;
  std::vector<std::string> available;
  bool any_role = false;
  for (const std::string& name : names) {
    const ColumnName column = split_name(name);
    any_role |= !column.role.empty();
    if (column.name.empty() || (column.role.empty() && column.name == "episode")) continue;
    available.push_back(column.name);
    if (seen.insert(column.role == "flag" ? name : column.name).second) continue;
    if (own_form_ || role_of(column, options)) {
      return at_row("two columns are named " + shown(column.name) + "; rename one, or name all with --columns");
    }
  }
  for (const auto* wanted : {&options.inputs, &options.outputs}) {
    for (const std::string& name : *wanted) {
      if (!contains(available, name))
        return at_row("has no column " + shown(name) + "; its columns are " + listed(available));
    }
  }
  if (!header_.channels.empty()) return {};
  return at_row(any_role
                    ? "the header has no input, output or motion column"
                    : "the columns (" + listed(available) + ") state no roles; name them with --inputs and --outputs");
}

// The first column that says when rows were.
void CsvReader::find_time(const std::vector<std::string>& names) {
  for (std::size_t k = 0; !own_form_ && k < names.size(); ++k) {
    const ColumnName column = split_name(names[k]);
    if (time_ || !column.role.empty() || !csv::names_time(column.name)) continue;
    time_ = Time{k, column.name, column.unit.empty() ? csv::unit_in_time_name(column.name) : column.unit};
  }
}

// A line below the names that says in what they are measured.
Result<void> CsvReader::read_units() {
  if (own_form_ || ahead_.size() < 2) return {};
  if (!csv::is_row_of_units(ahead_[0].text, ahead_[1].text, separator_)) return {};
  const std::vector<std::string> units = csv::units_in(ahead_[0].text, separator_);
  if (time_ && time_->place < units.size() && csv::seconds_of_date(units[time_->place])) return {};
  if (time_ && time_->unit.empty() && time_->place < units.size()) time_->unit = units[time_->place];
  for (std::size_t k = 0; k < std::min(units.size(), columns_.size()); ++k) {
    if (columns_[k].kind != Column::Kind::kChannel) continue;
    std::string& unit = header_.channels[columns_[k].index].unit;
    if (unit.empty()) unit = units[k];
  }
  ahead_.pop_front();
  return {};
}

Result<void> CsvReader::read_columns(const CsvOptions& options) {
  const auto names = read_names(options);
  if (!names) return names.error();
  const std::vector<Cell> last = ahead_.empty() ? std::vector<Cell>{} : cells_of(ahead_.back().text, separator_);
  for (std::size_t k = 0; k < names->size(); ++k) {
    const bool text = k < last.size() && !csv::is_missing(last[k]) && !csv::number_of(last[k], separator_) &&
                      !csv::names_time((*names)[k]);
    if (options.every_column && text && !own_form_) {
      columns_.push_back({});
      header_.attributes.push_back({std::string(kNotNumbers), (*names)[k]});
    } else if (auto ok = add_column((*names)[k], options); !ok) {
      return ok;
    }
  }
  if (auto ok = check_columns(*names, options); !ok) return ok;
  find_time(*names);
  return read_units();
}

// The rate, from the first rows' time.
Result<void> CsvReader::learn_step() {
  const auto lines = look_ahead(kTimed);
  if (!lines) return lines.error();
  std::vector<double> times;
  double resolution = 1;
  for (const Line& line : ahead_) {
    const std::vector<Cell> cells = cells_of(line.text, separator_);
    const auto time = time_->place < cells.size() ? time_in(cells[time_->place]) : std::nullopt;
    if (!time || !std::isfinite(*time)) break;
    times.push_back(*time);
    resolution = std::min(resolution, csv::resolution_of(cells[time_->place].text));
  }
  const std::string column = "column " + shown(time_->name);
  const auto seconds = time_->unit.empty() ? 1 : csv::seconds_of(time_->unit);
  const std::string instead = "; say --rate HZ or --dt S instead";
  if (!seconds) return Error{name_ + ": " + column + " is in " + shown(time_->unit) + ", expected s or ms" + instead};
  if (times.empty() && !ahead_.empty()) {
    row_ = ahead_.front().row;
    return at_row(column + " is no number of seconds" + instead);
  }
  if (times.size() < 2) return {};
  time_->seconds = *seconds;
  const auto step = csv::step_of(times, resolution, *seconds);
  if (!step) {
    row_ = ahead_[1].row;
    return at_row(column + " does not go on: " + number_text(times[1], 12) + " after " + number_text(times[0], 12) +
                  "; sort the rows by time, or say --rate HZ or --dt S");
  }
  if (time_->unit.empty() && step->step == 1 && !time_->dated) return {};  // counts rows
  if (time_->unit.empty() && !time_->dated && counts_milliseconds(step->step)) {
    time_->seconds = 1e-3;
    header_.rate_note = {
        column + " has no unit and goes on by whole steps of " + number_text(step->step) + ": taken as milliseconds",
        true};
  }
  time_->step = step->step;
  time_->tolerance = step->tolerance;
  header_.rate_hz = 1 / (step->step * time_->seconds);
  if (header_.rate_note.text.empty()) {
    header_.rate_note.text = "from " + column + ", in steps of " + number_text(step->step, 6) + " " +
                             (time_->unit.empty() ? "s" : time_->unit);
  }
  return {};
}

// A number, or the seconds of a date.
std::optional<double> CsvReader::time_in(const Cell& cell) {
  const auto number = csv::number_of(cell, separator_);
  if (number) return number;
  const auto seconds = csv::seconds_of_date(trimmed(cell.text));
  time_->dated |= seconds.has_value();
  return seconds;
}

// A cell of the column that the rate is from.
Result<void> CsvReader::check_time(const Cell& cell) {
  const auto now = time_in(cell);
  const auto before = std::exchange(time_->before, now);
  if (uneven_time_ && now) {
    times_.push_back(*now * time_->seconds);
    return {};
  }
  if (now && (!before || std::abs(*now - *before - time_->step) <= time_->tolerance)) return {};
  time_was_uneven_ = now.has_value();
  const std::string found = now ? "goes on by " + number_text(*now - *before, 6) : "is " + shown(cell.text);
  std::string message = "column " + shown(time_->name) + " " + found + ", expected steps of " +
                        number_text(time_->step, 6) + " as above; ";
  const double missing = now ? std::round((*now - *before) / time_->step) - 1 : 0;
  if (missing > 0 && std::abs(*now - *before - (missing + 1) * time_->step) <= time_->tolerance) {
    message += number_text(missing) + (missing > 1 ? " rows are" : " row is") +
               " missing: put rows with nothing but the time there, ";
  }
  return at_row(message + "resample the table to one rate, or say --rate HZ or --dt S");
}

Result<std::size_t> CsvReader::read(Recording& recording, std::size_t max_rows) {
  std::size_t count = 0;
  while (count < max_rows) {
    const auto more = next_line();
    if (!more) return more.error();
    if (!*more) {
      if (auto ok = check_thousands(); !ok) return ok.error();
      break;
    }
    if (auto ok = add_row(recording); !ok) return ok.error();
    ++count;
  }
  return count;
}

Result<std::size_t> CsvReader::skip(std::size_t max_rows) {
  std::size_t count = 0;
  while (count < max_rows) {
    const auto more = next_line();
    if (!more) return more.error();
    if (!*more) break;
    ++count;
  }
  if (time_) time_->before.reset();
  return count;
}

Result<void> CsvReader::add_row(Recording& recording) {
  std::size_t place = 0, filled = 0;
  Result<void> outcome;
  const bool timed = time_ && time_->step > 0;
  Cell time;
  csv::for_each_cell(line_, separator_, [&](const Cell& cell) {
    if (timed && place == time_->place) time = cell;
    if (outcome && place < columns_.size()) outcome = add_cell(recording, columns_[place], cell, place);
    ++place;
    if (!cell.text.empty()) filled = place;
  });
  // Separators at the end of a row are nobody's cells.
  if (place < columns_.size() || filled > columns_.size()) {
    return at_row("has " + std::to_string(place) + " columns, the header has " + std::to_string(columns_.size()) +
                  "; a cell that holds a separator stands in quotes");
  }
  if (timed && outcome) return check_time(time);
  return outcome;
}

Result<void> CsvReader::add_cell(Recording& recording, const Column& column, const Cell& cell, std::size_t place) {
  const auto found = [&](const std::string& expected) {
    return at_row("found " + shown(cell.text) + ", column " + std::to_string(place + 1) + ", expected " + expected);
  };
  switch (column.kind) {
    case Column::Kind::kSkip:
      if (cell.text.find_first_of(".,") == cell.text.npos || !csv::number_of(cell, separator_)) return {};
      return check_mark(cell, place);
    case Column::Kind::kFlag:
      if (cell.text != "0" && cell.text != "1") return found("a flag, 0 or 1");
      recording.flags[column.index].rows.push_back(cell.text == "1");
      return {};
    case Column::Kind::kEpisode: {
      std::int64_t id = 0;
      const auto [end, code] = std::from_chars(cell.text.data(), cell.text.data() + cell.text.size(), id);
      if (code != std::errc() || end != cell.text.data() + cell.text.size()) {
        return found("an episode's whole number");
      }
      if (time_ && !recording.episode_ids.empty() && recording.episode_ids.back() != id) time_->before.reset();
      recording.episode_ids.push_back(id);
      return {};
    }
    case Column::Kind::kChannel:
      break;
  }
  auto& samples = recording.channels[column.index].samples;
  const auto value = csv::number_of(cell, separator_);
  if (!value && csv::is_missing(cell)) {
    samples.push_back(kMissing);
    return {};
  }
  if (!value) return found("a number without separators of thousands, or nothing for a missing sample");
  if (std::isnan(*value)) {
    samples.push_back(kMissing);
    return {};
  }
  if (!std::isfinite(*value)) return found("a finite number; leave the cell empty where a sample is missing");
  if (auto ok = check_mark(cell, place); !ok) return ok;
  samples.push_back(*value);
  return {};
}

// 1,234 is a thousand to some and little more than one to others: a table writes it in one way.
Result<void> CsvReader::check_mark(const Cell& cell, std::size_t place) {
  const bool comma = csv::has_comma(cell), point = cell.text.find('.') != std::string_view::npos;
  commas_ |= comma;
  points_ |= point;
  if (marks_.size() <= place) marks_.resize(columns_.size());
  Marks& marks = marks_[place];
  if (comma && !may_be_thousands(cell.text)) decimals_ = true;
  if (comma && marks.thousand == 0) marks.thousand = row_;
  if (!comma && !point && marks.hundred == 0 && cell.text.size() >= 3 &&
      std::isdigit(static_cast<unsigned char>(cell.text.back())) != 0) {
    marks.hundred = row_;
  }
  if (!commas_ || !points_) return {};
  return at_row("found " + shown(cell.text) + " though numbers above have a decimal " + (comma ? "point" : "comma") +
                "; write all numbers in one way, without separators of thousands");
}

// A column of 987 and 1,012 has separators of thousands, unless a comma elsewhere can only be a decimal one.
Result<void> CsvReader::check_thousands() {
  for (std::size_t k = 0; k < marks_.size() && !decimals_; ++k) {
    if (marks_[k].thousand == 0 || marks_[k].hundred == 0) continue;
    row_ = marks_[k].thousand;
    return at_row("column " + std::to_string(k + 1) + " has numbers such as 1,012 and, in row " +
                  std::to_string(marks_[k].hundred) +
                  ", whole ones of three digits and more: are they thousands or decimals? Write all numbers without "
                  "separators of thousands");
  }
  return {};
}

Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options) {
  const auto begin = stream.tellg();
  const std::size_t all = std::numeric_limits<std::size_t>::max();
  auto reader = CsvReader::open(stream, name, options);
  if (!reader) return reader.error();
  Recording recording = reader->header();
  auto rows = reader->read(recording, all);
  const bool uneven = !rows && reader->time_is_uneven() && begin != std::istream::pos_type(-1);
  if (uneven) {
    stream.clear();
    stream.seekg(begin);
    reader = CsvReader::open(stream, name, options);
    if (!reader) return reader.error();
    reader->take_uneven_time();
    recording = reader->header();
    rows = reader->read(recording, all);
  }
  if (!rows) return rows.error();
  if (*rows == 0) return Error{std::string(name) + ": has a header but no rows"};
  return uneven ? csv::resampled(recording, reader->times()) : std::move(recording);
}

Result<Recording> read_csv(const std::filesystem::path& path, const CsvOptions& options) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return Error{path_text(path) + ": is a folder, expected a CSV file"};
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{path_text(path) + ": cannot be opened; is the name right?"};
  return read_csv(stream, path_text(path), options);
}

}  // namespace wisp
