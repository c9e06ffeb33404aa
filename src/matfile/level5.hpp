#pragma once
// MATLAB files of level 5 (`save` up to -v7), compressed or not.

#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace wisp::matfile {

/// Numbers of a matrix, column by column.
struct Table {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> numbers;
};

/// Reason why a variable yields no table.
enum class Miss {
  kNoVariable,
  kNoField,
  kNotNumbers,  ///< text, complex, sparse, three-dimensional, empty
  kTooLarge,    ///< more numbers than allowed
  kDamaged,
};

using Found = std::variant<Table, Miss>;

/// A numeric variable or field of a structure, as `data.u`.
struct Name {
  std::string name;
  std::size_t rows = 0;
  std::size_t columns = 0;
};

/// A variable, then fields.
using Path = std::vector<std::string>;

/// Returns whether bytes begin like a level 5 file.
bool is_level5(std::span<const std::byte> file);

/// Returns whether a level 5 file ends at the end of an element.
bool is_whole_level5(std::span<const std::byte> file);

/// Returns the numeric variables and fields, about ten thousand at most. Damaged ones are omitted.
std::vector<Name> names_in_level5(std::span<const std::byte> file);

/// Reads a table of at most `max_numbers`. Memory grows with the existing data, whatever sizes the file claims.
Found read_level5(std::span<const std::byte> file, const Path& path, std::size_t max_numbers);

}  // namespace wisp::matfile
