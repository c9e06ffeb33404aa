// Gives the C library an empty environment at start, so that the host need not provide functions for environment
// variables.

#include <cstddef>
#include <cstdint>

extern "C" std::uint16_t __wasi_environ_sizes_get(std::size_t* count, std::size_t* bytes) {
  *count = *bytes = 0;
  return 0;
}

extern "C" std::uint16_t __wasi_environ_get(std::uint8_t**, std::uint8_t*) { return 0; }
