#pragma once
// Which rows of which recordings are in a part of a fit, so that none is taken in twice and none is forgotten.

#include <cstdint>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Rows [begin, end) of a recording whose rows [first, last) are to be taken in, by this part and its siblings;
/// 0-based.
struct SeenRows {
  std::string source;
  std::uint64_t hash = 0;  ///< of the recording's contents, whatever it is called
  std::uint64_t first = 0;
  std::uint64_t last = 0;  ///< kToTheEnd: as many as there are
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  std::uint64_t copy = 0;  ///< of a recording that one job was given several times: which of them
};

inline constexpr std::uint64_t kToTheEnd = UINT64_MAX;

/// Joins two lists, rows that touch as one. Errors: rows that are in both.
Result<std::vector<SeenRows>> joined(std::vector<SeenRows> seen, const std::vector<SeenRows>& more);

/// What a job takes in besides what it has: a recording that it was given before, is another copy.
SeenRows copy_of(SeenRows rows, const std::vector<SeenRows>& seen);

/// Whether nothing is missing between the first and the last row of any recording. Errors: what is.
Result<void> check_complete(const std::vector<SeenRows>& seen);

/// "1:500", counted from 1.
std::string rows_text(std::uint64_t begin, std::uint64_t end);

}  // namespace wisp
