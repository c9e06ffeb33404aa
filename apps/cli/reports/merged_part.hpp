#pragma once
// Parts of a fit, read from the named files and merged: the same for every kind of part.

#include <cstddef>
#include <string>

#include "command.hpp"
#include "flags/part_flags.hpp"
#include "wisp/base/file.hpp"

namespace wisp::cli {

/// Reads and merges the named part files. Errors: a file that cannot be read, is not a part, was damaged, or cannot
/// be merged with the first, each named; another number of parts than --expect.
template <class Part>
Result<Part> merged_part(const Arguments& arguments) {
  const auto read = [](const std::string& path) -> Result<Part> {
    const auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    auto part = Part::from_bytes(*bytes);
    if (!part) return Error{path + ": " + part.error().message};
    return part;
  };
  const auto& paths = arguments.positionals();
  auto whole = read(paths.front());
  if (!whole) return whole.error();
  for (std::size_t k = 1; k < paths.size(); ++k) {
    const auto part = read(paths[k]);
    if (!part) return part.error();
    if (auto ok = whole->merge(*part); !ok) {
      return Error{paths[k] + ": cannot be merged with " + paths.front() + ": " + ok.error().message};
    }
  }
  if (auto ok = check_expected(whole->jobs(), arguments); !ok) return ok.error();
  return whole;
}

}  // namespace wisp::cli
