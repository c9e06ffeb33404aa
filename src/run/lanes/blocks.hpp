#pragma once
// Values of consecutive blocks, computed together, each lane by the same operations as when its block is alone.

#include <cstddef>

#include "run/lanes/lanes.hpp"

// Builds for size step one block at a time, with the same bits, so that each kernel is compiled only once.
#ifndef WISP_BLOCKS_AT_ONCE
#define WISP_BLOCKS_AT_ONCE 4
#endif

namespace wisp {

/// Types in which `kBlocks` consecutive blocks are computed.
template <class N, int kBlocks>
struct PartsOfBlocks {
  using RealPart = typename N::RealPart;
  using WordPart = typename N::WordPart;
  static constexpr int kParts = kBlocks * N::kParts;
};

template <class N, int kBlocks>
using BlockReals = Pack<typename PartsOfBlocks<N, kBlocks>::RealPart, PartsOfBlocks<N, kBlocks>::kParts>;
template <class N, int kBlocks>
using BlockWords = Pack<typename PartsOfBlocks<N, kBlocks>::WordPart, PartsOfBlocks<N, kBlocks>::kParts>;

/// Addresses of one value in each of kBlocks blocks, which are `stride` values apart.
template <class Value, int kBlocks>
struct BlockPlaces {
  Value* of[kBlocks];

  BlockPlaces(Value* first, std::size_t stride) {
    unrolled<kBlocks>([&](auto b) { of[b] = first + b * stride; });
  }
};

/// Loads part i of the blocks, one value per lane, from `after` values behind their addresses.
template <class N, class Part, class Value, int kBlocks>
inline void load_block_part(const BlockPlaces<Value, kBlocks>& places, std::size_t after, int i, Part& out) {
  const Value* first = places.of[i / N::kParts] + after + i % N::kParts * N::kPartLanes;
  std::memcpy(static_cast<void*>(&out), static_cast<const void*>(first), sizeof out);
}

/// Stores part i of the blocks, one value per lane, to `after` values behind their addresses.
template <class N, class Part, class Value, int kBlocks>
inline void store_block_part(const Part& part, const BlockPlaces<Value, kBlocks>& places, std::size_t after, int i) {
  Value* first = places.of[i / N::kParts] + after + i % N::kParts * N::kPartLanes;
  std::memcpy(static_cast<void*>(first), static_cast<const void*>(&part), sizeof part);
}

template <class N, class Packed, class Value, int kBlocks>
inline Packed load_blocks(const BlockPlaces<Value, kBlocks>& places) {
  Packed out;
  unrolled<PartsOfBlocks<N, kBlocks>::kParts>([&](auto i) { load_block_part<N>(places, 0, i, out.part[i]); });
  return out;
}
template <class N, class Part, int kParts, class Value, int kBlocks>
inline void store_blocks(const Pack<Part, kParts>& packed, const BlockPlaces<Value, kBlocks>& places) {
  unrolled<kParts>([&](auto i) { store_block_part<N>(packed.part[i], places, 0, i); });
}

}  // namespace wisp
