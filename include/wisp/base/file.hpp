#pragma once
// Whole files in and out: output appears whole or not at all.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Reads a whole file. Returns its bytes.
/// Errors: the file cannot be opened (missing, a folder, no permission), cannot be read to its end, or is larger than
/// `max_bytes`, or than memory can hold.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                         std::uint64_t max_bytes = std::uint64_t{1} << 32);

/// Writes a whole file: beside its place first (`.NAME.part-PID`), then renamed over it, so that a reader sees the old
/// file or the new one and never a half, after a power failure too. A file that is replaced keeps its permissions, and
/// what a symbolic link points to is replaced, not the link.
/// Errors: the folder is missing or not writable, the name is a device's or a pipe's, the disk is full; nothing is left
/// behind then.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

/// A file that something else writes (an encoder, a picture library) and that appears under its name only when
/// `commit()` is called. Destroyed without commit, nothing is left behind.
class PendingFile {
 public:
  /// `path` is the final name. Errors: the folder is missing, or `path` is a folder, a device or a pipe.
  static Result<PendingFile> create(const std::filesystem::path& path);

  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&& other) noexcept;
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();

  /// Where to write until then; beside the final name, with the same extension.
  const std::filesystem::path& path() const { return pending_; }

  /// Brings the pending file to the disk and renames it to its final name.
  /// Errors: nothing was written, the disk failed, or the rename failed.
  Result<void> commit();

 private:
  PendingFile(std::filesystem::path pending, std::filesystem::path final_path);
  void discard();

  std::filesystem::path pending_;
  std::filesystem::path final_;
  int listed_ = -1;  // place in the list of what is removed when the process is interrupted
};

/// From now on SIGINT, SIGTERM and SIGHUP remove all pending files and then end the process with the signal's own
/// status; what stood under the final names stays. For main() of a program; a handler that is set later wins.
void remove_pending_files_when_interrupted();

}  // namespace wisp
