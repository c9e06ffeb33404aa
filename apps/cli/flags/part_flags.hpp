#pragma once
// Parts of a fit as files, with which any job engine spreads the work: the flags of every command that knows them.

#include <cstddef>
#include <string>
#include <vector>

#include "command.hpp"

namespace wisp::cli {

/// --partial, --part, --merge, --expect, with what the first three say of the command.
std::vector<Flag> part_flags(std::string partial, std::string part, std::string merge);

/// --part "2/8", the second of eight.
struct PartShare {
  std::size_t index = 0;  ///< 0-based
  std::size_t count = 1;
};

/// Errors: not so written.
Result<PartShare> share_of(const Arguments& arguments);

/// Errors: --expect is another number than the parts that were found.
Result<void> check_expected(std::size_t jobs, const Arguments& arguments);

}  // namespace wisp::cli
