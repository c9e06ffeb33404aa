#pragma once
// Allocates arrays in one piece of memory. An arena without memory only adds up the sizes of the arrays, so that the
// same code measures and allocates. Functions make_… fill their arrays only if there is memory.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace wisp {

/// Alignment of every array: a cache line, and so a multiple of the widest vector.
inline constexpr std::size_t kArenaAlignment = 64;

class Arena {
 public:
  /// Creates an arena that only measures.
  Arena() = default;

  explicit Arena(std::span<std::byte> memory)
      : start_(memory.data()), used_(padding(memory.data())), size_(memory.size()) {}

  bool measures() const { return start_ == nullptr; }

  /// Returns an array of `count` zeros, empty while measuring. Precondition: the memory left is large enough.
  template <class T>
  std::span<T> take(std::size_t count) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kArenaAlignment);
    const std::size_t begin = used_;
    used_ += (count * sizeof(T) + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
    if (measures()) return {};
    assert(used_ <= size_);
    T* first = reinterpret_cast<T*>(start_ + begin);
    std::uninitialized_value_construct_n(first, count);
    return {first, count};
  }

  /// Returns the number of bytes taken, including the possible cost of aligning the start.
  std::size_t bytes() const { return measures() ? used_ + kArenaAlignment : used_; }

 private:
  static std::size_t padding(const std::byte* start) {
    return (kArenaAlignment - reinterpret_cast<std::uintptr_t>(start) % kArenaAlignment) % kArenaAlignment;
  }

  std::byte* start_ = nullptr;
  std::size_t used_ = 0;
  std::size_t size_ = 0;
};

}  // namespace wisp
