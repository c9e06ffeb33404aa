#pragma once
// File functions of the operating system beyond the C++ standard library: one interface, for POSIX and Windows. Used by
// base alone.

#include <cstdio>
#include <filesystem>

namespace wisp::system {

/// Like std::fopen(), for names in any script. `mode` is "rb" or "wb".
std::FILE* open_file(const std::filesystem::path& path, const char* mode);

/// Returns the number of this process.
long process_number();

/// Returns whether files can be created in a folder; errno has the reason if not.
bool may_write_into(const std::filesystem::path& folder);

/// Waits until a file is on the disk. Returns false, with the reason in errno, if that fails.
bool bring_to_disk(const std::filesystem::path& path);

/// Removes a file by its native name; safe in a signal handler.
void remove_now(const std::filesystem::path::value_type* name);

}  // namespace wisp::system
