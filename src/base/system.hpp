#pragma once
// What base asks the operating system about files beyond the C++ standard library: one set of functions, POSIX and
// Windows. Nothing above base sees it.

#include <cstdio>
#include <filesystem>

namespace wisp::system {

/// As std::fopen(), for names in any script. `mode` is "rb" or "wb".
std::FILE* open_file(const std::filesystem::path& path, const char* mode);

/// Number of this process.
long process_number();

/// Whether files can be made in a folder; errno says why not.
bool may_write_into(const std::filesystem::path& folder);

/// Waits until a file is on the disk. Returns false, and errno says why, where it can't be brought there.
bool bring_to_disk(const std::filesystem::path& path);

/// Removes a file by its native name; safe in a signal handler.
void remove_now(const std::filesystem::path::value_type* name);

}  // namespace wisp::system
