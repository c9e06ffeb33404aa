#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <limits>
#include <set>

#include "base/path_text.hpp"
#include "wisp/record/csv.hpp"

namespace wisp {
namespace {

constexpr std::size_t kLongestLine = std::size_t{16} << 20;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// Some programs quote the names in a header, and some even numbers.
std::string_view unquoted(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  return cell;
}

// What was found, short enough for a message of one line.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out;
  for (char c : text.substr(0, kMost)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return "\"" + out + (text.size() > kMost ? "…\"" : "\"");
}

bool is_text(std::string_view line) {
  return std::none_of(line.begin(), line.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t' && c != '\r') || byte == 0x7f;
  });
}

template <class Visit>
void for_each_cell(std::string_view line, char separator, Visit visit) {
  for (;;) {
    const std::size_t end = line.find(separator);
    visit(line.substr(0, end));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells;
  for_each_cell(line, separator, [&](std::string_view cell) { cells.emplace_back(unquoted(cell)); });
  return cells;
}

// The whole of `text` as a double, hexadecimal excluded; nothing where it is not one.
std::optional<double> parsed_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  // Too small for a double is a true zero; too large is caught as not finite.
  if (code == std::errc::result_out_of_range)
    return text.find("e-") != text.npos || text.find("E-") != text.npos ? 0.0 : HUGE_VAL;
  return code == std::errc() ? std::optional(value) : std::nullopt;
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
  const bool chosen = !options.inputs.empty() || !options.outputs.empty();
  if (chosen) return std::nullopt;
  if (column.role == "u") return Role::kInput;
  if (column.role == "y") return Role::kOutput;
  return std::nullopt;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

Error CsvReader::at_row(const std::string& what) const {
  return {name_ + ", row " + std::to_string(row_) + ": " + what};
}

// Puts the next line that is not blank into line_; false at the end.
Result<bool> CsvReader::next_line() {
  do {
    line_.clear();
    ++row_;
    auto* buffer = stream_->rdbuf();
    int c = buffer->sbumpc();
    if (c == std::char_traits<char>::eof()) return false;
    for (; c != std::char_traits<char>::eof() && c != '\n'; c = buffer->sbumpc()) {
      if (line_.size() == kLongestLine)
        return at_row("the line is longer than 16 MiB, expected a row of numbers; is this a CSV file?");
      line_.push_back(static_cast<char>(c));
    }
    if (!is_text(line_)) return at_row("holds bytes that are not text; expected a CSV file");
  } while (trimmed(line_).empty());
  return true;
}

Result<CsvReader> CsvReader::open(std::istream& stream, std::string_view name, const CsvOptions& options) {
  CsvReader reader;
  reader.stream_ = &stream;
  reader.name_ = name;
  reader.header_.source = name;
  if (auto ok = reader.read_attributes(); !ok) return ok.error();
  if (auto ok = reader.read_columns(options); !ok) return ok.error();
  if (reader.header_.rate_hz == 0) reader.header_.rate_hz = options.rate_hz;
  if (reader.header_.rate_hz == 0) {
    return Error{reader.name_ +
                 ": states no rate; expected a line \"# rate_hz 30\" above the header, or --rate HZ or --dt S"};
  }
  if (!(std::isfinite(reader.header_.rate_hz) && reader.header_.rate_hz > 0)) {
    return Error{reader.name_ + ": the rate is " + std::to_string(reader.header_.rate_hz) + " Hz, expected above 0"};
  }
  return reader;
}

// Comment lines; leaves the header in line_.
Result<void> CsvReader::read_attributes() {
  for (bool first = true;; first = false) {
    const auto more = next_line();
    if (!more) return more.error();
    if (!*more) return Error{name_ + ": is empty, expected a header line with column names"};
    std::string_view line = line_;
    if (first && line.substr(0, 3) == "\xef\xbb\xbf") line_.erase(0, 3), line = line_;
    if (line.front() != '#') return {};
    line = trimmed(line.substr(1));
    const std::size_t space = line.find_first_of(" \t");
    const std::string key(line.substr(0, space));
    const std::string value(space == std::string_view::npos ? "" : trimmed(line.substr(space)));
    if (key == "wisp-recording") {
      if (value != "1")
        return at_row("is a Wisp recording of version " + shown(value) + ", this program reads version 1; update Wisp");
      own_form_ = true;
    } else if (key == "rate_hz") {
      const auto rate = parsed_number(value);
      if (!rate || !(std::isfinite(*rate) && *rate > 0)) {
        return at_row("rate_hz is " + shown(value) + ", expected a number of samples a second above 0");
      }
      header_.rate_hz = *rate;
    } else if (own_form_ && !key.empty()) {
      header_.attributes.push_back({key, value});
    }
  }
}

Result<void> CsvReader::read_columns(const CsvOptions& options) {
  for (char candidate : {',', ';', '\t'}) {
    separator_ = candidate;
    if (line_.find(candidate) != std::string::npos) break;
    separator_ = ',';
  }
  const std::vector<std::string> cells = cells_of(line_, separator_);
  if (std::all_of(cells.begin(), cells.end(),
                  [](const std::string& cell) { return parsed_number(cell).has_value(); })) {
    return at_row("starts with numbers, expected a header line with column names such as u1,y1");
  }
  std::set<std::string> seen;
  std::vector<std::string> available;
  bool any_role = false;
  for (const std::string& cell : cells) {
    const ColumnName column = split_name(cell);
    if (!seen.insert(column.role == "flag" ? cell : column.name).second)
      return at_row("two columns are named " + shown(column.name));
    const bool episode = column.role.empty() && column.name == "episode";
    if (!episode) available.push_back(column.name);
    any_role |= !column.role.empty();
    if (own_form_ && column.role.empty() && !episode) {
      return at_row("column " + shown(cell) + " has no role; expected u:, y:, m: or flag: before its name");
    }
    if (column.name.empty()) return at_row("column " + std::to_string(columns_.size() + 1) + " has no name");
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
  }
  for (const auto* wanted : {&options.inputs, &options.outputs}) {
    for (const std::string& name : *wanted) {
      if (!contains(available, name))
        return at_row("has no column " + shown(name) + "; its columns are " + listed(available));
    }
  }
  if (header_.channels.empty()) {
    return at_row(any_role ? "the header has no input, output or motion column"
                           : "the columns (" + listed(available) +
                                 ") state no roles; name them with --inputs and --outputs");
  }
  return {};
}

Result<std::size_t> CsvReader::read(Recording& recording, std::size_t most_rows) {
  std::size_t count = 0;
  while (count < most_rows) {
    const auto more = next_line();
    if (!more) return more.error();
    if (!*more) break;
    if (auto ok = add_row(recording); !ok) return ok.error();
    ++count;
  }
  return count;
}

Result<std::size_t> CsvReader::skip(std::size_t most_rows) {
  std::size_t count = 0;
  while (count < most_rows) {
    const auto more = next_line();
    if (!more) return more.error();
    if (!*more) break;
    ++count;
  }
  return count;
}

Result<void> CsvReader::add_row(Recording& recording) {
  std::size_t place = 0;
  Result<void> outcome;
  for_each_cell(line_, separator_, [&](std::string_view cell) {
    if (outcome && place < columns_.size()) outcome = add_cell(recording, columns_[place], unquoted(cell), place);
    ++place;
  });
  if (place != columns_.size()) {
    return at_row("has " + std::to_string(place) + " columns, the header has " + std::to_string(columns_.size()));
  }
  return outcome;
}

Result<void> CsvReader::add_cell(Recording& recording, const Column& column, std::string_view cell, std::size_t place) {
  const auto in_column = [&] { return ", column " + std::to_string(place + 1); };
  switch (column.kind) {
    case Column::Kind::kSkip:
      return {};
    case Column::Kind::kFlag:
      if (cell != "0" && cell != "1") return at_row("found " + shown(cell) + in_column() + ", expected a flag, 0 or 1");
      recording.flags[column.index].rows.push_back(cell == "1");
      return {};
    case Column::Kind::kEpisode: {
      std::int64_t id = 0;
      const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), id);
      if (code != std::errc() || end != cell.data() + cell.size()) {
        return at_row("found " + shown(cell) + in_column() + ", expected an episode's whole number");
      }
      recording.episode_ids.push_back(id);
      return {};
    }
    case Column::Kind::kChannel:
      break;
  }
  auto& samples = recording.channels[column.index].samples;
  if (cell.empty()) {
    samples.push_back(kMissing);
    return {};
  }
  const auto value = parsed_number(cell);
  if (!value)
    return at_row("found " + shown(cell) + in_column() + ", expected a number, or nothing for a missing sample");
  if (!std::isfinite(*value)) {
    return at_row("found " + shown(cell) + in_column() +
                  ", expected a finite number; leave the cell empty where a sample is missing");
  }
  samples.push_back(*value);
  return {};
}

Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options) {
  auto reader = CsvReader::open(stream, name, options);
  if (!reader) return reader.error();
  Recording recording = reader->header();
  const auto rows = reader->read(recording, std::numeric_limits<std::size_t>::max());
  if (!rows) return rows.error();
  if (*rows == 0) return Error{std::string(name) + ": has a header but no rows"};
  return recording;
}

Result<Recording> read_csv(const std::filesystem::path& path, const CsvOptions& options) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return Error{path_text(path) + ": is a folder, expected a CSV file"};
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{path_text(path) + ": cannot be opened; is the name right?"};
  return read_csv(stream, path_text(path), options);
}

}  // namespace wisp
