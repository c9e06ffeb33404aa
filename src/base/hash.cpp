#include "base/hash.hpp"

namespace wisp {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t before) {
  std::uint64_t hash = before;
  for (std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
  return hash;
}

}  // namespace wisp
