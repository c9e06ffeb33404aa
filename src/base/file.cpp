#include "wisp/base/file.hpp"

#include <fcntl.h>
#ifdef _WIN32
#include <io.h>
#include <process.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/path_text.hpp"

namespace wisp {
namespace {

namespace fs = std::filesystem;

// File functions of the operating system beyond the C++ standard library: one interface, for POSIX and Windows.
namespace system {

#ifdef _WIN32

// Like std::fopen(), for names in any script. `mode` is "rb" or "wb".
std::FILE* open_file(const std::filesystem::path& path, const char* mode) {
  return ::_wfopen(path.c_str(), *mode == 'r' ? L"rb" : L"wb");
}

long process_number() { return ::_getpid(); }

// Returns whether files can be created in a folder; errno has the reason if not.
bool may_write_into(const std::filesystem::path& folder) {
  constexpr int kWrite = 2;
  return ::_waccess(folder.c_str(), kWrite) == 0;
}

// Waits until a file is on the disk. Returns false, with the reason in errno, if that fails.
bool bring_to_disk(const std::filesystem::path& path) {
  const int file = ::_wopen(path.c_str(), _O_RDWR | _O_BINARY | _O_NOINHERIT);
  if (file < 0) return false;
  const bool done = ::_commit(file) == 0;
  ::_close(file);
  return done;
}

// Removes a file by its native name; safe in a signal handler.
void remove_now(const std::filesystem::path::value_type* name) { ::_wunlink(name); }

#else

std::FILE* open_file(const std::filesystem::path& path, const char* mode) { return std::fopen(path.c_str(), mode); }

long process_number() { return ::getpid(); }

bool may_write_into(const std::filesystem::path& folder) { return ::access(folder.c_str(), W_OK) == 0; }

bool bring_to_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool done = ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;  // EINVAL, EROFS: unsupported here
  ::close(file);
  return done;
}

void remove_now(const std::filesystem::path::value_type* name) { ::unlink(name); }

#endif

}  // namespace system

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Error file_error(const fs::path& path, const std::string& what) { return {path_text(path) + ": " + what}; }

std::string reason() { return std::strerror(errno); }

fs::path pending_name(const fs::path& path) {
  // Two threads may write the same name at once; with the process number alone they would share a pending file.
  static std::atomic<unsigned> counter{0};
  fs::path name = fs::path(".");
  name += path.stem();
  name += ".part-" + std::to_string(system::process_number()) + "-" + std::to_string(counter.fetch_add(1));
  name += path.extension();
  return path.parent_path() / name;
}

// Returns the final target of a link, which need not exist.
Result<fs::path> follow_links(fs::path path) {
  constexpr int kMaxLinks = 40;  // Linux's limit
  std::error_code code;
  for (int k = 0; k < kMaxLinks; ++k) {
    if (!fs::is_symlink(path, code)) return path;
    path = path.parent_path() / fs::read_symlink(path, code);
    if (code) break;
  }
  return file_error(path, "cannot be written: it is a link that leads nowhere; remove it");
}

// Creates the pending file with the old file's permissions, if there is an old file: others must not read a private
// file's new contents while they are written.
void make_alike(const fs::path& pending, const fs::path& old) {
  std::error_code code;
  const fs::file_status status = fs::status(old, code);
  if (!fs::is_regular_file(status)) return;
  if (File made(system::open_file(pending, "wb")); made) {
    fs::permissions(pending, status.permissions() | fs::perms::owner_write, code);
  }
}

// Names of pending files for the signal handler, which can neither lock nor allocate. An interruption leaves a file
// behind if no entry was free for it or its name has kMaxName characters or more.
constexpr std::size_t kMaxListed = 32, kMaxName = 4096;
struct Listed {
  std::atomic<int> state{0};  // 0 free, 1 being written, 2 holds a name
  std::array<fs::path::value_type, kMaxName> name{};
};
std::array<Listed, kMaxListed> listed_files;

int list(const fs::path& path) {
  const fs::path::string_type& name = path.native();
  if (name.size() >= kMaxName) return -1;
  for (std::size_t k = 0; k < kMaxListed; ++k) {
    int free = 0;
    if (!listed_files[k].state.compare_exchange_strong(free, 1)) continue;
    std::memcpy(listed_files[k].name.data(), name.c_str(), (name.size() + 1) * sizeof(fs::path::value_type));
    listed_files[k].state = 2;
    return static_cast<int>(k);
  }
  return -1;
}

void unlist(int place) {
  if (place >= 0) listed_files[static_cast<std::size_t>(place)].state = 0;
}

extern "C" void wisp_remove_pending_files(int signal) {
  for (Listed& file : listed_files) {
    if (file.state == 2) system::remove_now(file.name.data());
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

Result<std::vector<std::byte>> read_file(const fs::path& path, std::uint64_t max_bytes) {
  std::error_code code;
  if (fs::is_directory(path, code)) return file_error(path, "is a folder, expected a file");
  File file(system::open_file(path, "rb"));
  if (!file) return file_error(path, "cannot be opened: " + reason());

  std::vector<std::byte> bytes;
  // With 32-bit addresses, memory is smaller than the largest file.
  max_bytes = std::min<std::uint64_t>(max_bytes, bytes.max_size() / 2);
  const std::uintmax_t size = fs::file_size(path, code);
  if (!code) {
    if (size > max_bytes) return file_error(path, "is too large: " + std::to_string(size) + " bytes");
    bytes.reserve(static_cast<std::size_t>(size) + 1);
  }
  // Pipes and /proc files report no size, so the end is found by reading.
  for (;;) {
    const std::size_t before = bytes.size();
    const std::size_t chunk = std::max<std::size_t>(bytes.capacity() - before, std::size_t{1} << 16);
    bytes.resize(before + chunk);
    const std::size_t got = std::fread(bytes.data() + before, 1, chunk, file.get());
    bytes.resize(before + got);
    if (bytes.size() > max_bytes) return file_error(path, "is too large");
    if (got < chunk) break;
  }
  if (std::ferror(file.get())) return file_error(path, "cannot be read to its end: " + reason());
  return bytes;
}

Result<void> write_file(const fs::path& path, std::span<const std::byte> bytes) {
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  File file(system::open_file(pending->path(), "wb"));
  if (!file) return file_error(path, "cannot be written: " + reason());
  // fwrite must not be given the null pointer of an empty span.
  const bool written = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  const bool flushed = std::fflush(file.get()) == 0;
  const std::string why = reason();
  const bool closed = std::fclose(file.release()) == 0;
  if (!written || !flushed || !closed) return file_error(path, "cannot be written whole: " + why);
  return pending->commit(bytes.empty());
}

Result<void> write_file(const fs::path& path, std::string_view text) {
  return write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

PendingFile::PendingFile(fs::path pending, fs::path final_path)
    : pending_(std::move(pending)), final_(std::move(final_path)), listed_(list(pending_)) {}

PendingFile::PendingFile(PendingFile&& other) noexcept { *this = std::move(other); }

PendingFile& PendingFile::operator=(PendingFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  pending_ = std::exchange(other.pending_, {});
  final_ = std::exchange(other.final_, {});
  listed_ = std::exchange(other.listed_, -1);
  return *this;
}

PendingFile::~PendingFile() { discard(); }

void PendingFile::discard() {
  if (pending_.empty()) return;
  std::error_code ignored;
  fs::remove(pending_, ignored);
  unlist(std::exchange(listed_, -1));
}

Result<PendingFile> PendingFile::create(const fs::path& given) {
  std::error_code code;
  // A link stays a link: its target is written.
  const auto target = follow_links(given);
  if (!target) return target.error();
  const fs::path& path = *target;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (path.filename().empty()) return file_error(path, "names no file to write");
  if (fs::is_directory(path, code)) return file_error(path, "is a folder, expected a file name to write to");
  // A rename would replace a device or a pipe by a plain file.
  if (fs::exists(path, code) && !fs::is_regular_file(path, code)) {
    return file_error(path, "is no plain file but a device or a pipe, expected the name of a file");
  }
  if (constexpr auto kAnyWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
      fs::exists(path, code) && (fs::status(path, code).permissions() & kAnyWrite) == fs::perms::none) {
    return file_error(path, "is read-only; give another name, or allow writing it");
  }
  if (!fs::is_directory(folder, code)) {
    return file_error(path, "cannot be written: the folder " + path_text(folder) + " does not exist; make it first");
  }
  if (!system::may_write_into(folder)) return file_error(path, "cannot be written: " + reason());
  PendingFile pending(pending_name(path), path);
  make_alike(pending.path(), path);
  return pending;
}

Result<void> PendingFile::commit(bool may_be_empty) {
  std::error_code code;
  if (!may_be_empty && fs::is_empty(pending_, code))
    return file_error(final_, "cannot be put in place: the new file is empty");
  const fs::file_status old = fs::status(final_, code);
  if (fs::is_regular_file(old)) fs::permissions(pending_, old.permissions(), code);
  // If the rename reached the disk before the data, a power failure could leave an empty file under the final name.
  if (!system::bring_to_disk(pending_)) return file_error(final_, "cannot be written whole: " + reason());
  fs::rename(pending_, final_, code);
  if (code) return file_error(final_, "cannot be put in place: " + code.message());
  pending_.clear();
  unlist(std::exchange(listed_, -1));
  return {};
}

void remove_pending_files_when_interrupted() {
#ifdef SIGHUP
  constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ};
#else
  constexpr std::array kSignals{SIGINT, SIGTERM};
#endif
  for (const int signal : kSignals) {  // an ignored signal stays ignored, as under nohup
    if (std::signal(signal, wisp_remove_pending_files) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace wisp
