#pragma once
// Standard error, quiet for a while.

#include <fcntl.h>
#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace wisp::window {

/// Keeps standard error quiet while it lives: where there is no sound card or no screen, the system's libraries write a
/// dozen lines there beside the error that they return.
class Silence {
 public:
  Silence() : kept_(::dup(2)) {
#ifdef _WIN32
    const int nowhere = ::open("NUL", O_WRONLY);
#else
    const int nowhere = ::open("/dev/null", O_WRONLY);
#endif
    if (nowhere < 0) return;
    ::dup2(nowhere, 2);
    ::close(nowhere);
  }
  ~Silence() {
    if (kept_ < 0) return;
    ::dup2(kept_, 2);
    ::close(kept_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_;
};

}  // namespace wisp::window
