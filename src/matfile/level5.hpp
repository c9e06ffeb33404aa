#pragma once
// MATLAB files of level 5 (`save` up to -v7), compressed or not.

#include <cstddef>
#include <optional>
#include <span>

#include "matfile/mat_table.hpp"

namespace wisp::matfile {

/// Whether bytes begin as a file of level 5 does.
bool is_level5(std::span<const std::byte> file);

/// Whether a file's parts end where it ends.
bool is_whole_level5(std::span<const std::byte> file);

/// All numeric variables and fields. What is damaged is left out.
std::vector<Name> names_in_level5(std::span<const std::byte> file);

/// Memory grows with what is there, whatever sizes the file claims.
Found read_level5(std::span<const std::byte> file, const Path& path);

}  // namespace wisp::matfile
