#pragma once
// A 64-bit hash that detects damage: FNV-1a. It gives no protection against manipulation.

#include <cstddef>
#include <cstdint>
#include <span>

namespace wisp {

/// Returns the hash of `bytes`. If `before` is the hash of a preceding piece, returns the hash of both pieces together.
/// A change of any single byte changes the hash.
inline std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t before = 0xcbf29ce484222325U) {
  std::uint64_t hash = before;
  for (std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
  return hash;
}

}  // namespace wisp
