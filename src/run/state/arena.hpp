#pragma once
// Lays arrays out in one piece of memory. An arena without memory only adds up their sizes, so that measuring and
// allocating share one code.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace wisp {

/// Every array starts on a cache line, and so at a multiple of the widest vector.
inline constexpr std::size_t kArenaAlignment = 64;

class Arena {
 public:
  /// An arena that only measures.
  Arena() = default;

  /// An arena that lays out in `memory`.
  explicit Arena(std::span<std::byte> memory)
      : start_(memory.data()), used_(padding(memory.data())), size_(memory.size()) {}

  bool measures() const { return start_ == nullptr; }

  /// An array of `count` zeros. Empty while measuring.
  ///
  /// Precondition: there is memory for it.
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

  /// Bytes taken, with what alignment of the start may cost.
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
