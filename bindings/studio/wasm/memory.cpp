// Allocation. Without exceptions the C++ library would return null on failure, and address 0 is ordinary memory in
// WebAssembly: so failure is reported to the host, which ends the call. Blocks are aligned to whole vectors as in the
// program, so that vectorised sums are the same.

#include <cstdlib>
#include <new>

extern "C" __attribute__((import_module("env"), import_name("studio_out_of_memory"))) void studio_out_of_memory();

namespace {
// Allocates aligned memory; null if there is none.
void* whole_vectors(std::size_t size) {
  void* memory = nullptr;
  return posix_memalign(&memory, 16, size) == 0 ? memory : nullptr;
}
}  // namespace

void* operator new(std::size_t size) {
  void* memory = whole_vectors(size);
  if (!memory) {
    studio_out_of_memory();
    __builtin_trap();
  }
  return memory;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return whole_vectors(size); }

void operator delete(void* memory) noexcept { std::free(memory); }
