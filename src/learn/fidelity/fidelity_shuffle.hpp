#pragma once
// Random order that is the same on every machine: std::shuffle leaves its method to the library.

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>

namespace wisp {

/// A number below `bound`. The modulo's bias is below bound / 2^64.
inline std::size_t below(std::mt19937_64& random, std::size_t bound) { return random() % bound; }

/// Fisher–Yates.
template <class T>
void shuffle(std::span<T> items, std::mt19937_64& random) {
  for (std::size_t left = items.size(); left > 1; --left) std::swap(items[left - 1], items[below(random, left)]);
}

}  // namespace wisp
