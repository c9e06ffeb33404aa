#pragma once
// Recordings as CSV: Wisp's own form (docs/reference/recordings.md) and plain tables from elsewhere.

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Interpretation of a table that does not describe itself. The file's own statements take precedence, except over
/// `columns`, `inputs` and `outputs`. If `inputs` or `outputs` is set, other u: and y: columns need `every_column`.
struct CsvOptions {
  double rate_hz = 0;                        ///< samples per second; 0: from a time column, or usual_rate_hz
  double usual_rate_hz = 0;                  ///< rate assumed if nothing else states one; 0: an error then
  std::vector<std::string> inputs{};         ///< columns that are inputs
  std::vector<std::string> outputs{};        ///< columns that are outputs
  std::vector<std::string> usual_inputs{};   ///< inputs among columns without a stated role; may be absent
  std::vector<std::string> usual_outputs{};  ///< outputs among columns without a stated role; may be absent
  bool every_column = false;                 ///< read all numeric columns, as outputs unless their role is stated
  std::vector<std::string> columns{};        ///< names of all columns in order, in place of a header or without one
};

/// Reads a table in blocks, for recordings larger than memory.
class CsvReader {
 public:
  CsvReader(CsvReader&&) noexcept;
  CsvReader& operator=(CsvReader&&) noexcept;
  ~CsvReader();

  /// Reads the comment lines and the header. `name` stands for the file in messages. Tables from elsewhere may be
  /// separated by commas, semicolons, tabs or blanks, have decimal commas, a line that states the separator for Excel,
  /// a line of units, and comment lines that begin with # or %, also between rows. If nothing else states the rate, a
  /// time column does (t, time, date and the like; in s unless its name or the line of units says ms, us, min or h, or
  /// its whole steps suggest ms), if its steps are equal; a count of rows is no time column. Errors, each with file and
  /// row (1-based, as an editor counts lines): not text, neither a header nor `columns`, no rate, an unknown version,
  /// an unknown or repeated column, time that does not increase. Precondition: `stream` outlives the reader.
  static Result<CsvReader> open(std::istream& stream, std::string_view name, const CsvOptions& options = {});

  /// Returns the recording without its rows: rate, channels, flags and attributes.
  const Recording& header() const;

  /// Appends up to `max_rows` further rows to `recording`: a copy of header(), with the rows of earlier calls or none.
  /// Returns their number; 0 at the end. An empty cell, NaN or NA is a missing sample. Errors: uneven time steps, a
  /// wrong number of columns, text or infinity in place of a number, decimal points and commas in one table, marks
  /// that may separate thousands, a line longer than 16 MiB. Part of a row may then remain.
  Result<std::size_t> read(Recording& recording, std::size_t max_rows);

  /// Skips up to `max_rows` rows without parsing their numbers. Returns their number; fewer than requested at the end
  /// only. Errors: bytes that are not text, a line longer than 16 MiB.
  Result<std::size_t> skip(std::size_t max_rows);

 private:
  friend Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options);
  struct State;
  explicit CsvReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads a recording from a CSV file.
/// Returns it with missing samples as NaN; numbers are the nearest doubles to the text. A time column with uneven
/// steps, as written by a PC's logger, is resampled to its typical step by linear interpolation; `rate_note` reports
/// this and its error. Gaps above 1.5 steps are missing samples. Errors: those of CsvReader, except for uneven time in
/// a table without episodes; no rows, time that does not increase or has no typical step, a file that cannot be opened.
Result<Recording> read_csv(const std::filesystem::path& path, const CsvOptions& options = {});

/// Reads a recording from a stream; `name` stands for the file in messages. Uneven time needs a seekable stream.
Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options = {});

/// Writes a recording as CSV, completely or not at all. Reading it restores every number bit for bit.
/// Errors: those of check(), text with characters that CSV cannot hold, and a file that cannot be written.
Result<void> write_csv(const std::filesystem::path& path, const Recording& recording);

/// Returns the text that write_csv() writes, without its checks.
std::string csv_text(const Recording& recording);

}  // namespace wisp
