#include "base/system.hpp"

#include <fcntl.h>

#include <cerrno>
#ifdef _WIN32
#include <io.h>
#include <process.h>
#else
#include <unistd.h>
#endif

namespace wisp::system {

#ifdef _WIN32

std::FILE* open_file(const std::filesystem::path& path, const char* mode) {
  return ::_wfopen(path.c_str(), *mode == 'r' ? L"rb" : L"wb");
}

long process_number() { return ::_getpid(); }

bool may_write_into(const std::filesystem::path& folder) {
  constexpr int kWrite = 2;
  return ::_waccess(folder.c_str(), kWrite) == 0;
}

bool bring_to_disk(const std::filesystem::path& path) {
  const int file = ::_wopen(path.c_str(), _O_RDWR | _O_BINARY | _O_NOINHERIT);
  if (file < 0) return false;
  const bool done = ::_commit(file) == 0;
  ::_close(file);
  return done;
}

void remove_now(const std::filesystem::path::value_type* name) { ::_wunlink(name); }

#else

std::FILE* open_file(const std::filesystem::path& path, const char* mode) { return std::fopen(path.c_str(), mode); }

long process_number() { return ::getpid(); }

bool may_write_into(const std::filesystem::path& folder) { return ::access(folder.c_str(), W_OK) == 0; }

bool bring_to_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool done = ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;  // not supported by every file system
  ::close(file);
  return done;
}

void remove_now(const std::filesystem::path::value_type* name) { ::unlink(name); }

#endif

}  // namespace wisp::system
