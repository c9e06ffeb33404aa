#pragma once
// Recordings as commands take them: files by name, read by what they are.

#include <filesystem>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/prepare.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Flags of every command that reads a table: --columns, --rate, --dt.
std::vector<Flag> table_flags();

/// Those, and --skip-bad of commands that read many.
std::vector<Flag> recording_flags();

/// --prepare, and what it says. Errors: as parse_preparation().
Flag prepare_flag();
Result<Preparation> preparation_of(const Arguments& arguments);

/// Whether a name is that of a table (`.csv`, `.tsv`, `.txt`, `.dat`, `.asc`, `.mat`) rather than of a clip.
bool is_table(const std::filesystem::path& path);

/// Whether it is that of a MATLAB file.
bool is_matlab(const std::filesystem::path& path);

/// How --inputs, --outputs, --columns, --rate and --dt say a table is to be understood, and `otherwise` where they do
/// not. Errors: --dt that is not above 0.
Result<CsvOptions> csv_options(const Arguments& arguments, CsvOptions otherwise = {});

/// Reads one table, understood as csv_options() says.
Result<Recording> read_table(const std::filesystem::path& path, const Arguments& arguments,
                             const CsvOptions& otherwise = {});

/// What becomes of a bad recording: with --skip-bad it is left out, with a warning and an entry of `skipped` in the
/// result. Returns whether it is left out.
bool leave_out(const std::string& path, const Error& error, const Arguments& arguments, Terminal& terminal);

/// Reads all of them. A bad one is the error, or, with --skip-bad, a warning and an entry of `skipped` in the result.
/// Errors: also where none is left.
Result<std::vector<Recording>> read_tables(const std::vector<std::string>& paths, const Arguments& arguments,
                                           Terminal& terminal, const CsvOptions& otherwise = {});

/// Rows of --range (1-based, inclusive), or all of them where the flag is not given.
/// Errors: the range reaches beyond the recording.
Result<Recording> in_range(Recording recording, const Arguments& arguments, std::string_view flag);
Result<std::vector<Recording>> in_range(std::vector<Recording> recordings, const Arguments& arguments);

}  // namespace wisp::cli
