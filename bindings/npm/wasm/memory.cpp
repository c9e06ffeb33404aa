// Allocation in WebAssembly. Without exceptions the C++ library would return null on failure, and address 0 is ordinary
// memory here, so failure must stop the module. Code that can report a failure uses nothrow.

#include <cstdlib>
#include <new>

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (!memory) __builtin_trap();
  return memory;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }

void operator delete(void* memory) noexcept { std::free(memory); }
