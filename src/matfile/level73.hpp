#pragma once
// MATLAB files of level 7.3 (`save -v7.3`): HDF5 with MATLAB's names.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "matfile/mat_table.hpp"

namespace wisp::matfile {

/// Whether bytes begin as a file of level 7.3 does.
bool is_level73(std::span<const std::byte> file);

class Level73 {
 public:
  /// Nothing where HDF5 cannot open it.
  static std::unique_ptr<Level73> open(const std::filesystem::path& path);
  ~Level73();
  Level73(const Level73&) = delete;
  Level73& operator=(const Level73&) = delete;

  std::vector<Name> names() const;

  /// Of numbers that lie in the file itself: links to other files are not followed.
  Found read(const Path& path) const;

 private:
  Level73(long file, std::size_t bytes) : file_(file), bytes_(bytes) {}

  long file_;
  std::size_t bytes_;
};

}  // namespace wisp::matfile
