#pragma once
// MATLAB files of level 5 (`save` up to -v7), compressed or not.

#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace wisp::matfile {

/// Numbers of a matrix, column after column.
struct Table {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> numbers;
};

/// Why a variable gives no table.
enum class Miss {
  kNoVariable,
  kNoField,
  kNotNumbers,  ///< text, complex, sparse, of three dimensions, empty
  kTooLarge,    ///< more numbers than may be read
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

/// Whether bytes begin as a file of level 5 does.
bool is_level5(std::span<const std::byte> file);

/// Whether a file's parts end where it ends.
bool is_whole_level5(std::span<const std::byte> file);

/// The first ten thousand numeric variables and fields. What is damaged is left out.
std::vector<Name> names_in_level5(std::span<const std::byte> file);

/// Reads a table of at most `max_numbers`. Memory grows with what is there, whatever sizes the file claims.
Found read_level5(std::span<const std::byte> file, const Path& path, std::size_t max_numbers);

}  // namespace wisp::matfile
