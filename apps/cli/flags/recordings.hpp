#pragma once
// Reads the recordings named on the command line, each by its kind of file.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/prepare.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Returns the flags --columns, --rate and --dt of every command that reads a table.
std::vector<Flag> table_flags();

/// Returns table_flags(), and --skip-bad of commands that read several recordings.
std::vector<Flag> recording_flags();

/// Return the flag --prepare, and its value. Errors: as parse_preparation().
Flag prepare_flag();
Result<Preparation> preparation_of(const Arguments& arguments);

/// Returns whether a file is a table (`.csv`, `.tsv`, `.txt`, `.dat`, `.asc`, `.mat`) rather than a clip.
bool is_table(const std::filesystem::path& path);

/// Returns whether a file is a MATLAB file.
bool is_matlab(const std::filesystem::path& path);

/// Returns options for reading a table from --inputs, --outputs, --columns, --rate and --dt, with `otherwise` for flags
/// not given. Errors: --dt not above 0; --rate and --dt together; a rate not 1e-6 to 1e7 Hz; those of motion_columns().
Result<CsvOptions> csv_options(const Arguments& arguments, CsvOptions otherwise = {});

/// Reads one table with the options of csv_options(), and renames its columns by as_motion().
Result<Recording> read_table(const std::filesystem::path& path, const Arguments& arguments,
                             const CsvOptions& otherwise = {});

/// Returns whether a bad recording is skipped: --skip-bad warns of it and lists it in the result as `skipped`.
bool leave_out(const std::string& path, const Error& error, const Arguments& arguments, Terminal& terminal);

/// Reads every path by `read`; bad ones go to leave_out(). Errors: those of `read`; no recording remains.
Result<std::vector<Recording>> read_all(const std::vector<std::string>& paths, const Arguments& arguments,
                                        Terminal& terminal,
                                        const std::function<Result<Recording>(const std::string&)>& read);

/// Reads every path by read_table(); bad recordings and errors as in read_all().
Result<std::vector<Recording>> read_tables(const std::vector<std::string>& paths, const Arguments& arguments,
                                           Terminal& terminal, const CsvOptions& otherwise = {});

/// Returns the rows that `flag` (for several recordings: --range) selects, 1-based, inclusive; all if it is not given.
/// Errors: the range reaches beyond the recording, which of several goes to leave_out(); none of several remains.
Result<Recording> in_range(Recording recording, const Arguments& arguments, std::string_view flag);
Result<std::vector<Recording>> in_range(std::vector<Recording> recordings, const Arguments& arguments,
                                        Terminal& terminal);

}  // namespace wisp::cli
