// Where memory comes from in WebAssembly. Without exceptions the C++ library would hand out null and go on, and address
// 0 is memory like any other there: want of memory must stop the module. Where it can be said instead, nothrow is
// asked.

#include <cstdlib>
#include <new>

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (!memory) __builtin_trap();
  return memory;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }

void operator delete(void* memory) noexcept { std::free(memory); }
