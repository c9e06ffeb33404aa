#pragma once
// How a table is written, found by looking at its first lines.

#include <string>
#include <string_view>
#include <vector>

namespace wisp::csv {

/// What separates cells: a tab, a semicolon, a comma or blanks. `lines`: the first that are no comments.
///
/// Precondition: at least one line.
char separator_of(const std::vector<std::string>& lines);

/// Whether a line has a cell that is a number, and whether all its cells are numbers or missing.
bool has_number(std::string_view line, char separator);
bool is_row(std::string_view line, char separator);

/// Whether a line below the names only says in what they are measured: no numbers, though the row that follows it has
/// some.
bool is_row_of_units(std::string_view line, std::string_view next, char separator);

/// Its units, without brackets.
std::vector<std::string> units_in(std::string_view line, char separator);

/// A separator that Excel was told, as `sep=;`; 0 where the line is none.
char told_separator(std::string_view line);

}  // namespace wisp::csv
