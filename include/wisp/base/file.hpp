#pragma once
// Reading and writing of whole files: output appears completely or not at all.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Reads a whole file. Returns its bytes. Errors: the file cannot be opened (missing, a folder, no permission), cannot
/// be read to its end, or is larger than `max_bytes` or half the address space.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                         std::uint64_t max_bytes = std::uint64_t{1} << 32);

/// Writes a whole file: first to a temporary file beside it (`.STEM.part-PID-N.EXT`), then renamed over it, so that a
/// reader sees the old file or the new one and never a part of it, even after a power failure. A replaced file keeps
/// its permissions; of a symbolic link, the target is replaced, not the link.
/// Errors: the folder is missing or not writable; the name is that of a folder, a device or a pipe; the file is
/// read-only; the disk is full. In each case no temporary file remains.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

/// A file that an encoder or picture library writes and that appears under its name only on `commit()`. Destroyed
/// without commit(), it leaves no file behind.
class PendingFile {
 public:
  /// `path` is the final name. Errors: those of write_file() except for a full disk.
  static Result<PendingFile> create(const std::filesystem::path& path);

  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&& other) noexcept;
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();

  /// Returns the path of the temporary file, to be written before commit(): beside the final name, same extension.
  const std::filesystem::path& path() const { return pending_; }

  /// Flushes the pending file to the disk and renames it to its final name.
  /// Errors: the pending file does not exist or, unless `may_be_empty`, has no bytes; the disk or the rename failed.
  Result<void> commit(bool may_be_empty = false);

 private:
  PendingFile(std::filesystem::path pending, std::filesystem::path final_path);
  void discard();

  std::filesystem::path pending_;
  std::filesystem::path final_;
  int listed_ = -1;  // index in the list of files to remove on interruption; −1: not listed
};

/// Makes SIGINT, SIGTERM and, on POSIX, SIGHUP, SIGQUIT, SIGPIPE and the like remove all pending files (32 at most)
/// before they end the process. Ignored signals stay ignored. For main() of a program; a handler installed later wins.
void remove_pending_files_when_interrupted();

}  // namespace wisp
