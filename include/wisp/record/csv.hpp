#pragma once
// Recordings as CSV: Wisp's own form (docs/recordings.md) and plain tables from elsewhere.

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to understand a table that does not say so itself. A file's own words win where both speak, except
/// `inputs` and `outputs`, which, when given, choose the channels to keep and their roles.
struct CsvOptions {
  double rate_hz = 0;                ///< samples a second; 0: the file must state it
  std::vector<std::string> inputs;   ///< columns that are inputs
  std::vector<std::string> outputs;  ///< columns that are outputs
};

/// Reads a recording from a CSV file, in bounded memory beside the recording itself.
/// Returns it with missing samples as NaN; numbers are the nearest doubles to what is written.
/// Errors, each with file and row (1-based, as an editor counts lines): not text, no header, a wrong number of columns,
/// text, NaN or infinity where a number belongs, no rate, no rows, a line longer than 16 MiB, an unknown version,
/// an unknown or repeated column.
Result<Recording> read_csv(const std::filesystem::path& path, const CsvOptions& options = {});

/// The same from a stream; `name` stands for the file in messages.
Result<Recording> read_csv(std::istream& stream, std::string_view name, const CsvOptions& options = {});

/// Writes a recording as CSV, whole or not at all. Reading it gives back every number bit for bit.
/// Errors: as check(), and where the file cannot be written.
Result<void> write_csv(const std::filesystem::path& path, const Recording& recording);

/// The text that write_csv writes.
std::string csv_text(const Recording& recording);

}  // namespace wisp
