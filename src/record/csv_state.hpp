#pragma once
// State of reading a table: its lines, in blocks of bytes; its format from the first lines, and the current row.

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/csv_cells.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::csv {

/// Returns text in quotes for a message, shortened to 40 bytes at most, with control characters as question marks.
std::string shown(std::string_view text);

class Lines {
 public:
  struct Line {
    std::string text;
    std::size_t row = 0;  ///< 1-based, as an editor counts
  };

  /// Precondition: `stream` outlives this object. `name` stands for the stream in messages.
  Lines(std::istream& stream, std::string_view name) : stream_(&stream), name_(name) {}

  /// Advances to the next line that is not blank or is a row; false at the end. Lines end in LF, CR LF or CR. Errors:
  /// bytes that are not text, a line longer than 16 MiB.
  Result<bool> next();

  /// Returns the line, without its end; a view that is valid until the next call.
  std::string_view text() const { return {buffer_.data() + begin_, length_}; }
  std::size_t row() const { return row_; }

  /// Returns the lines that next() will give, up to `count` of them. Errors: those of next().
  Result<std::vector<Line>> look_ahead(std::size_t count);

  /// Makes next() return the current line again.
  void back() { at_ = begin_, --row_; }

  /// Makes next() skip comment lines (#, "# …" or %…) from here on.
  void pass_comments() { pass_comments_ = true; }

  /// Makes next() skip lines without anything but separators from here on: spreadsheets write them below a table.
  void pass_empty_rows() { pass_empty_rows_ = true; }

  /// Makes blank lines with at least `tabs` tabs rows of missing samples from here on.
  void take_blank_rows(std::size_t tabs) { blank_row_ = tabs; }

  Error at_row(const std::string& what, std::size_t row = 0) const {
    return {name_ + ", row " + std::to_string(row > 0 ? row : row_) + ": " + what};
  }
  const std::string& name() const { return name_; }

 private:
  bool fill();
  std::size_t line_end();

  std::istream* stream_;
  std::string name_;
  std::string buffer_;
  std::size_t begin_ = 0, length_ = 0;    // beginning and length of the current line
  std::size_t at_ = 0;                    // beginning of the next line
  std::size_t keep_ = std::string::npos;  // beginning of the text that fill() must keep; npos: none
  std::size_t row_ = 0;
  bool over_ = false;  // the stream has ended
  bool plain_ = true;  // so far only text bytes, and no CR without LF
  bool pass_comments_ = false, pass_empty_rows_ = false;
  std::size_t blank_row_ = std::string::npos;  // minimum number of tabs in a blank line that is a row
};

}  // namespace wisp::csv

namespace wisp {

struct CsvReader::State {
  struct Column {
    enum class Kind { kSkip, kChannel, kFlag, kEpisode } kind = Kind::kSkip;
    std::size_t index = 0;  // index of the channel or flag
  };

  struct Time {
    std::size_t place = 0;  // index among all columns
    std::string name;
    std::string unit;
    double seconds = 1;  // seconds per unit
    double step = 0;     // between rows, in units; 0: not determined
    double tolerance = 0;
    std::optional<double> before{};         // value in the previous row
    bool dated = false;                     // the column holds dates or times of day
    bool dotted = true;                     // 13.05.59 is a time of day
    double of_day = 0, midnight = 0;        // time of day in the previous row, -1 for a date; seconds to add to it
    std::optional<std::int64_t> episode{};  // id in the previous row
  };

  // Evidence on the meaning of a column's commas and points.
  struct Marks {
    std::size_t thousand = 0;  // row of the first number such as 1,012 (or 1.012); 0: none
    std::size_t hundred = 0;   // row of the first number such as 987; 0: none
  };

  csv::Lines lines;
  Recording header{};  // recording without its rows
  std::vector<Column> columns{};
  std::optional<Time> time{};
  char separator = '\0';
  bool own_form = false;
  bool uneven_time = false,
       time_was_uneven = false;         // accept uneven steps; one was refused, in a table without episodes
  std::vector<double> times{};          // time of every row in seconds, stored if uneven_time
  bool plain_columns = false;           // all columns are channels or skipped, and blanks are no separator
  bool commas = false, points = false;  // a number so far had a comma, a point
  bool decimals = false;                // a mark so far can only be a decimal one
  std::vector<Marks> marks{};           // one per column
  std::vector<double> row{};

  // Up to the first row: csv_head.cpp.
  Result<void> read_attribute();
  Result<void> read_attributes();
  Result<std::vector<std::string>> read_names(const CsvOptions& options);
  Result<void> add_column(const std::string& text, const CsvOptions& options);
  Result<void> check_columns(const std::vector<std::string>& names, const CsvOptions& options) const;
  void find_time(const std::vector<std::string>& names, const std::vector<bool>& still);
  Result<void> read_units();
  Result<void> read_columns(const CsvOptions& options);
  Result<void> learn_step();
  Result<void> read_rate(const CsvOptions& options);
  std::optional<double> time_in(const csv::Cell& cell);

  // Rows: csv_reader.cpp.
  Result<void> check_time(std::optional<double> now, std::string_view text);
  bool take_plain_row(Recording& recording, double& seconds);
  Result<void> add_row(Recording& recording);
  Result<void> add_cell(Recording& recording, const Column& column, const csv::Cell& cell, std::size_t place);
  Result<void> check_mark(const csv::Cell& cell, std::size_t place);
  Result<void> check_thousands() const;
};

}  // namespace wisp
