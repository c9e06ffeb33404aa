#pragma once
// A 64-bit hash that finds damage: FNV-1a. It promises nothing against malice.

#include <cstddef>
#include <cstdint>
#include <span>

namespace wisp {

/// The hash of `bytes`; with `before`, the hash of a previous piece, that of the two joined. A change of any single
/// byte changes it.
std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t before = 0xcbf29ce484222325U);

}  // namespace wisp
