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

/// How to understand a table that does not say so itself. A file's own words win where both speak, except
/// `inputs` and `outputs`, which, when given, choose the channels to keep and their roles.
struct CsvOptions {
  double rate_hz = 0;                        ///< samples a second; 0: the file must state it, or have a column of time
  double usual_rate_hz = 0;                  ///< where it does neither; 0: an error then
  std::vector<std::string> inputs{};         ///< columns that are inputs
  std::vector<std::string> outputs{};        ///< columns that are outputs
  std::vector<std::string> usual_inputs{};   ///< columns that are inputs where a plain table has them
  std::vector<std::string> usual_outputs{};  ///< and outputs
  bool every_column = false;           ///< take all columns of numbers, as outputs where nothing else is said of them
  std::vector<std::string> columns{};  ///< names of all columns in their order, in place of a header or without one
};

/// A table read a stretch at a time, for recordings larger than memory.
class CsvReader {
 public:
  CsvReader(CsvReader&&) noexcept;
  CsvReader& operator=(CsvReader&&) noexcept;
  ~CsvReader();

  /// Reads the comment lines and the header. `name` stands for the file in messages.
  /// Tables from elsewhere may be separated by commas, semicolons, tabs or blanks, have decimal commas, a line that
  /// tells Excel the separator, a line of units, and comment lines that begin with # or %, also between rows. Where
  /// nothing else says the rate, a column of time does (t, time, seconds, timestamp, in s unless its name or the line
  /// of units says ms, us, min or h), and every row must go on evenly then; one that counts rows, without a unit, is
  /// none. Errors, each with file and row (1-based, as an editor counts lines): not text, no header and no names, no
  /// rate, an unknown version, an unknown or repeated column.
  ///
  /// Precondition: `stream` outlives the reader.
  static Result<CsvReader> open(std::istream& stream, std::string_view name, const CsvOptions& options = {});

  /// The recording without its rows: rate, channels, flags and attributes.
  const Recording& header() const;

  /// Appends up to `max_rows` further rows to `recording`, which is the header or what was read before.
  /// Returns how many; 0 at the end.
  /// An empty cell, NaN or NA is a missing sample.
  /// Errors: time that does not go on evenly, a wrong number of columns, text or infinity where a number belongs,
  /// decimal points and commas in one table, commas that may separate thousands, a line longer than 16 MiB.
  Result<std::size_t> read(Recording& recording, std::size_t max_rows);

  /// Passes over up to `max_rows` rows without looking at their numbers.
  /// Returns how many; fewer than requested at the end only.
  /// Errors: bytes that are not text, a line longer than 16 MiB.
  Result<std::size_t> skip(std::size_t max_rows);

 private:
  friend Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options);
  struct State;
  explicit CsvReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads a recording from a CSV file.
/// Returns it with missing samples as NaN; numbers are the nearest doubles to what is written. A column of time that
/// does not go on evenly, as a logger on a PC writes it, is resampled to its median step by straight lines between
/// samples; `rate_note` says so, with the error. Longer gaps are missing samples. Errors: as CsvReader, but for uneven
/// time; no rows, time that goes back or has no usual step, and where the file cannot be opened.
Result<Recording> read_csv(const std::filesystem::path& path, const CsvOptions& options = {});

/// The same from a stream; `name` stands for the file in messages. Uneven time needs a stream that can seek.
Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options = {});

/// Writes a recording as CSV, whole or not at all. Reading it gives back every number bit for bit.
/// Errors: as check(), and where the file cannot be written.
Result<void> write_csv(const std::filesystem::path& path, const Recording& recording);

/// The text that write_csv writes.
std::string csv_text(const Recording& recording);

}  // namespace wisp
