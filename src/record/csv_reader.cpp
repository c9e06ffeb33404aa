#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <limits>
#include <utility>

#include "base/path_text.hpp"
#include "record/csv_cells.hpp"
#include "record/csv_state.hpp"
#include "record/number_text.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::csv {
namespace {

constexpr std::size_t kLongestLine = std::size_t{16} << 20, kBlock = std::size_t{1} << 18;

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\r' && c != '\n') || byte == 0x7f;
}

// Returns whether all bytes are text, and every CR precedes an LF; reads one byte beyond. Branchless, to be vectorised.
bool is_plain(const char* first, std::size_t size) {
  unsigned char odd = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const auto byte = static_cast<unsigned char>(first[k]);
    const bool kept = (byte == '\t') | (byte == '\n') | (byte == '\r');
    const bool alone = (byte == '\r') & (first[k + 1] != '\n');
    odd |= static_cast<unsigned char>(((byte < 0x20) & !kept) | (byte == 0x7f) | alone);
  }
  return odd == 0;
}

// Returns whether a line between rows is a comment.
bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text == "#" || text.substr(0, 2) == "# " || text.substr(0, 1) == "%";  // #N/A and #DIV/0! are cells
}

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t kMax = 40;
  std::size_t end = std::min(text.size(), kMax);
  while (end > 0 && end < text.size() && (text[end] & 0xC0) == 0x80) --end;  // cuts no UTF-8 character
  std::string out;
  for (char c : text.substr(0, end)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return "\"" + out + (text.size() > kMax ? "…\"" : "\"");
}

// Reads another block behind the unconsumed text. Returns false at the end of the stream.
bool Lines::fill() {
  if (over_) return false;
  const std::size_t needed = std::min(keep_, std::min(begin_, at_));
  buffer_.erase(0, needed);
  begin_ -= needed, at_ -= needed;
  if (keep_ != std::string::npos) keep_ -= needed;
  const std::size_t before = buffer_.size();
  buffer_.resize(before + kBlock);
  const auto read = stream_->rdbuf()->sgetn(buffer_.data() + before, static_cast<std::streamsize>(kBlock));
  buffer_.resize(before + static_cast<std::size_t>(std::max<std::streamsize>(read, 0)));
  over_ = read < static_cast<std::streamsize>(kBlock);
  // The previous block may have ended in a CR; this block's last byte is checked with the next.
  const std::size_t from = before == 0 ? 0 : before - 1, to = over_ ? buffer_.size() : buffer_.size() - 1;
  plain_ = plain_ && is_plain(buffer_.data() + from, to - from);
  return buffer_.size() > before;
}

// Returns the end of the line that begins at at_, or the size of the buffer for the last one.
std::size_t Lines::line_end() {
  for (std::size_t from = at_;;) {
    const std::string_view all(buffer_);
    const std::size_t end = plain_ ? all.find('\n', from) : all.find_first_of("\r\n", from);
    if (end != std::string_view::npos && (all[end] == '\n' || end + 1 < all.size() || over_)) return end;
    if (buffer_.size() - at_ > kLongestLine) return buffer_.size();
    // Resumes at the last byte, which may be a CR.
    const std::size_t seen = std::max(buffer_.size(), at_ + 1) - at_ - 1;
    if (!fill()) return buffer_.size();
    from = at_ + seen;
  }
}

Result<bool> Lines::next() {
  for (;;) {
    begin_ = at_;
    const std::size_t end = line_end();
    begin_ = at_, length_ = end - begin_;
    ++row_;
    if (length_ > kLongestLine) {
      return at_row("the line is longer than 16 MiB, expected a row of numbers; is this a CSV file?");
    }
    if (begin_ == buffer_.size()) return false;
    at_ = std::min(end + 1, buffer_.size());
    if (end < buffer_.size() && buffer_[end] == '\r' && at_ < buffer_.size() && buffer_[at_] == '\n') ++at_;
    if (row_ == 1 && text().starts_with("\xef\xbb\xbf")) begin_ += 3, length_ -= 3;
    const std::string_view line = text();
    if (!plain_ && std::any_of(line.begin(), line.end(), is_control)) {
      if (row_ == 1 && (line.starts_with("\xff\xfe") || line.starts_with("\xfe\xff")))
        return at_row("is UTF-16; save it as UTF-8 (Excel: \"CSV UTF-8\")");
      return at_row("holds bytes that are not text; expected a CSV file");
    }
    if (pass_empty_rows_ && line.find_first_not_of(" \t\r\",;") == std::string_view::npos) continue;
    const bool row =
        !trimmed(line).empty() || std::cmp_greater_equal(std::count(line.begin(), line.end(), '\t'), blank_row_);
    if (row && !(pass_comments_ && is_comment(line))) return true;
  }
}

Result<std::vector<Lines::Line>> Lines::look_ahead(std::size_t count) {
  std::vector<Line> lines;
  const std::size_t row = row_, length = length_;
  const std::size_t ahead = at_ - begin_;
  keep_ = begin_;
  Result<bool> more = true;
  while (lines.size() < count && (more = next()) && *more) lines.push_back({std::string(text()), row_});
  begin_ = keep_, at_ = begin_ + ahead, row_ = row, length_ = length;
  keep_ = std::string::npos;
  if (!more) return more.error();
  return lines;
}

}  // namespace wisp::csv

namespace wisp {

using csv::Cell;
using csv::shown;

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Returns whether text has one to three digits, a mark and three digits: thousands, or a number with three decimals.
bool may_be_thousands(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const std::size_t mark = text.find_first_of(".,");
  return mark >= 1 && mark <= 3 && text.size() == mark + 4 && text.front() != '0';
}

}  // namespace

CsvReader::CsvReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
CsvReader::CsvReader(CsvReader&&) noexcept = default;
CsvReader& CsvReader::operator=(CsvReader&&) noexcept = default;
CsvReader::~CsvReader() = default;

Result<CsvReader> CsvReader::open(std::istream& stream, std::string_view name, const CsvOptions& options) {
  auto state = std::make_unique<State>(State{csv::Lines(stream, name)});
  state->header.source = name;
  if (auto ok = state->read_attributes(); !ok) return ok.error();
  if (auto ok = state->read_columns(options); !ok) return ok.error();
  if (auto ok = state->read_rate(options); !ok) return ok.error();
  const std::size_t count = state->columns.size();
  if (state->time && state->time->step > 0) state->lines.pass_empty_rows();
  if (state->separator == '\t' && !state->time && count > 1) state->lines.take_blank_rows(count - 1);
  state->marks.resize(count);
  using Kind = State::Column::Kind;
  state->plain_columns = state->separator != csv::kBlanks;
  for (const auto& column : state->columns) {
    state->plain_columns &= column.kind == Kind::kChannel || column.kind == Kind::kSkip;
  }
  return CsvReader(std::move(state));
}

const Recording& CsvReader::header() const { return state_->header; }

// Checks the current row's time step; if uneven_time, stores the time instead.
Result<void> CsvReader::State::check_time(std::optional<double> now, std::string_view text) {
  const auto before = std::exchange(time->before, now);
  if (uneven_time && now) {
    times.push_back(*now * time->seconds);
    return {};
  }
  if (now && (!before || std::abs(*now - *before - time->step) <= time->tolerance)) return {};
  time_was_uneven = now.has_value() && !time->episode;
  const std::string found = now ? "goes on by " + number_text(*now - *before, 6) : "is " + shown(text);
  std::string message =
      "column " + shown(time->name) + " " + found + ", expected steps of " + number_text(time->step, 6) + " as above; ";
  const double missing = now ? std::round((*now - *before) / time->step) - 1 : 0;
  if (missing > 0 && std::abs(*now - *before - (missing + 1) * time->step) <= time->tolerance) {
    message += number_text(missing) + (missing > 1 ? " rows are" : " row is") +
               " missing: put rows with nothing but the time there, ";
  }
  return lines.at_row(message + "resample the table to one rate, or say --rate HZ or --dt S");
}

Result<std::size_t> CsvReader::read(Recording& recording, std::size_t max_rows) {
  std::size_t count = 0;
  for (; count < max_rows; ++count) {
    const auto more = state_->lines.next();
    if (!more) return more.error();
    if (!*more) {
      if (auto ok = state_->check_thousands(); !ok) return ok.error();
      break;
    }
    if (auto ok = state_->add_row(recording); !ok) return ok.error();
  }
  return count;
}

Result<std::size_t> CsvReader::skip(std::size_t max_rows) {
  std::size_t count = 0;
  for (; count < max_rows; ++count) {
    const auto more = state_->lines.next();
    if (!more) return more.error();
    if (!*more) break;
  }
  if (auto& time = state_->time) time->before.reset();
  return count;
}

// Fast path, taken by nearly all rows: appends a row that contains only plain numbers. For any other row, appends
// nothing and returns false.
bool CsvReader::State::take_plain_row(Recording& recording, double& seconds) {
  const std::string_view line = csv::trimmed(lines.text());
  const std::size_t count = columns.size();
  row.resize(count);
  const char *at = line.data(), *const end = at + line.size();
  for (std::size_t k = 0; k < count; ++k) {
    const csv::PlainNumber number = csv::plain_number({at, static_cast<std::size_t>(end - at)});
    at += number.length;
    const bool last = k + 1 == count;
    const bool over = last ? at == end : at != end && *at == separator;
    const bool marked = columns[k].kind == Column::Kind::kSkip || number.point || number.length < 3;
    if (number.length == 0 || !over || !(marked || marks[k].hundred > 0)) return false;
    if (number.point && separator == ';' && !decimals) return false;
    points |= number.point;
    row[k] = number.value;
    at += last ? 0 : 1;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Column& column = columns[k];
    if (column.kind == Column::Kind::kChannel) recording.channels[column.index].samples.push_back(row[k]);
  }
  if (time) seconds = row[time->place];
  return true;
}

Result<void> CsvReader::State::add_row(Recording& recording) {
  std::size_t place = 0, filled = 0;
  Result<void> outcome;
  const bool timed = time && time->step > 0;
  double seconds = 0;
  if (plain_columns && !commas && take_plain_row(recording, seconds)) {
    return timed ? check_time(seconds, "") : Result<void>();
  }
  Cell its_time;
  csv::for_each_cell(lines.text(), separator, [&](const Cell& cell) {
    if (timed && place == time->place) its_time = cell;
    if (outcome && place < columns.size()) outcome = add_cell(recording, columns[place], cell, place);
    ++place;
    if (!cell.text.empty()) filled = place;
  });
  // Separators at the end of a row add no cells.
  if (place < columns.size() || filled > columns.size()) {
    return lines.at_row("has " + std::to_string(place) + " columns, the header has " + std::to_string(columns.size()) +
                        "; a cell that holds a separator stands in quotes");
  }
  if (timed && outcome) return check_time(time_in(its_time), its_time.text);
  return outcome;
}

Result<void> CsvReader::State::add_cell(Recording& recording, const Column& column, const Cell& cell,
                                        std::size_t place) {
  const auto found = [&](const std::string& expected) {
    return lines.at_row("found " + shown(cell.text) + ", column " + std::to_string(place + 1) + ", expected " +
                        expected);
  };
  switch (column.kind) {
    case Column::Kind::kSkip:
      if (cell.text.find_first_of(".,") == cell.text.npos || !csv::number_of(cell, separator)) return {};
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
      if (time && std::exchange(time->episode, id) != id) time->before.reset();
      recording.episode_ids.push_back(id);
      return {};
    }
    case Column::Kind::kChannel:
      break;
  }
  auto& samples = recording.channels[column.index].samples;
  const auto value = csv::number_of(cell, separator);
  if (value ? std::isnan(*value) : csv::is_missing(cell)) {
    samples.push_back(kMissing);
    return {};
  }
  if (!value) return found("a number without separators of thousands, or nothing for a missing sample");
  if (!std::isfinite(*value)) return found("a finite number; leave the cell empty where a sample is missing");
  if (auto ok = check_mark(cell, place); !ok) return ok;
  samples.push_back(*value);
  return {};
}

// Notes which decimal marks a number has, for check_thousands(); between semicolons points too may separate thousands.
// Error: the table has both decimal commas and points.
Result<void> CsvReader::State::check_mark(const Cell& cell, std::size_t place) {
  const bool comma = cell.text.find(',') != std::string_view::npos,
             point = cell.text.find('.') != std::string_view::npos;
  commas |= comma;
  points |= point;
  Marks& mark = marks[place];
  const bool either = comma || (point && separator == ';');
  if (either && !may_be_thousands(cell.text)) decimals = true;
  if (either && mark.thousand == 0) mark.thousand = lines.row();
  if (!comma && !point && mark.hundred == 0 && cell.text.size() >= 3 &&
      std::isdigit(static_cast<unsigned char>(cell.text.back())) != 0) {
    mark.hundred = lines.row();
  }
  if (!commas || !points) return {};
  return lines.at_row("found " + shown(cell.text) + " though numbers above have a decimal " +
                      (comma ? "point" : "comma") + "; write all numbers in one way, without separators of thousands");
}

// Error: a column has both 987 and 1,012, and no mark in the table is certainly a decimal one: 1,012 is ambiguous.
Result<void> CsvReader::State::check_thousands() const {
  for (std::size_t k = 0; k < marks.size() && !decimals; ++k) {
    if (marks[k].thousand == 0 || marks[k].hundred == 0) continue;
    return lines.at_row("column " + std::to_string(k + 1) + " has numbers such as " + (commas ? "1,012" : "1.012") +
                            " and, in row " + std::to_string(marks[k].hundred) +
                            ", whole ones of three digits and more: are they thousands or decimals? Write all numbers "
                            "without separators of thousands",
                        marks[k].thousand);
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
  const bool uneven = !rows && reader->state_->time_was_uneven && begin != std::istream::pos_type(-1);
  if (uneven) {
    stream.clear();
    stream.seekg(begin);
    reader = CsvReader::open(stream, name, options);
    if (!reader) return reader.error();
    reader->state_->uneven_time = true;
    recording = reader->header();
    rows = reader->read(recording, all);
  }
  if (!rows) return rows.error();
  if (*rows == 0) return Error{std::string(name) + ": has a header but no rows"};
  return uneven ? csv::resampled(recording, reader->state_->times) : std::move(recording);
}

Result<Recording> read_csv(const std::filesystem::path& path, const CsvOptions& options) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return Error{path_text(path) + ": is a folder, expected a CSV file"};
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{path_text(path) + ": cannot be opened; is the name right?"};
  return read_csv(stream, path_text(path), options);
}

}  // namespace wisp
