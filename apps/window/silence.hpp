#pragma once
// Standard error, quiet for a while.

#include <fcntl.h>
#include <unistd.h>

namespace wisp::window {

/// Keeps standard error quiet while it lives: where there is no sound card or no screen, the system's libraries write a
/// dozen lines there beside the error that they return.
class Silence {
 public:
  Silence() : kept_(::dup(2)) {
    const int nowhere = ::open("/dev/null", O_WRONLY);
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
