// Where memory comes from. Without exceptions the C++ library would hand out null and go on, and address 0 is memory
// like any other in WebAssembly: the host is told, which ends the call.

#include <cstdlib>
#include <new>

extern "C" __attribute__((import_module("env"), import_name("studio_out_of_memory"))) void studio_out_of_memory();

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (!memory) {
    studio_out_of_memory();
    __builtin_trap();
  }
  return memory;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }

void operator delete(void* memory) noexcept { std::free(memory); }
