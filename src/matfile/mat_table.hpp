#pragma once
// What both readers of MATLAB files, of level 5 and of level 7.3, give.

#include <cstddef>
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
  kTooLarge,    ///< more than kMaxNumbers
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

/// A gigabyte of doubles: more wants another form than one table in memory.
inline constexpr std::size_t kMaxNumbers = std::size_t{1} << 27;

/// Structures within structures; deeper ones are not looked into.
inline constexpr int kDeepest = 16;

/// zlib makes at most so many bytes of one: a file cannot hold more than that times its length.
inline constexpr std::size_t kMaxExpansion = 1032;

}  // namespace wisp::matfile
