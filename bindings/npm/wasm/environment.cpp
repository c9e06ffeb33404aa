// Replaces the C library's read of environment variables at start: there are none, so that the host need not provide a
// function for it.

#include <cstddef>
#include <cstdint>

extern "C" std::uint16_t __wasi_environ_sizes_get(std::size_t* count, std::size_t* bytes) {
  *count = *bytes = 0;
  return 0;
}

extern "C" std::uint16_t __wasi_environ_get(std::uint8_t**, std::uint8_t*) { return 0; }
