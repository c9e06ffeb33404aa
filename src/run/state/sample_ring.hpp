#pragma once
// The last samples of every instance, in rings with one common position.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "run/state/arena.hpp"

namespace wisp {

template <class N>
class SampleRing {
 public:
  using Real = typename N::Real;

  SampleRing() = default;

  /// Allocates `depth` samples of `channels` numbers for each lane of each block. Precondition: depth > 0.
  SampleRing(int blocks, int depth, int channels, Arena& arena)
      : depth_(depth), row_(static_cast<std::size_t>(channels) * N::kLanes) {
    const auto samples = static_cast<std::size_t>(depth);
    values_ = arena.take<Real>(static_cast<std::size_t>(blocks) * samples * row_);
    lag_row_ = arena.take<std::uint32_t>(2 * samples);
    if (arena.measures()) return;
    for (std::size_t k = 0; k < 2 * samples; ++k) {
      lag_row_[k] = static_cast<std::uint32_t>((2 * samples - k) % samples * row_);
    }
  }

  int depth() const { return depth_; }

  /// Prefetches all samples of a block, which are contiguous, but not read in order.
  void fetch(int block) const {
#ifdef __GNUC__
    const auto* line = reinterpret_cast<const char*>(begin(block));
    for (const char* end = line + stride() * sizeof(Real); line < end; line += kArenaAlignment)
      __builtin_prefetch(line);
#endif
  }

  std::size_t bytes() const { return values_.size_bytes(); }

  /// Returns the distance, in numbers, from a sample of one block to the same sample of the next block.
  std::size_t stride() const { return static_cast<std::size_t>(depth_) * row_; }

  /// Return the address of a block's numbers, and a table of offsets: the sample of `lag` steps ago is at back()[lag].
  const Real* begin(int block) const { return values_.data() + static_cast<std::size_t>(block) * stride(); }
  const std::uint32_t* back() const { return lag_row_.data() + (depth_ - place_); }

  /// Advances the ring by `samples`; the newest sample is then still to be computed.
  void turn(int samples = 1) {
    place_ += samples < depth_ ? samples : samples % depth_;
    if (place_ >= depth_) place_ -= depth_;
  }

  /// Returns the sample of `lag` steps ago, [channel][lane]. The table of offsets is stored twice in succession, so
  /// that position plus lag needs no modulo. Precondition: lag < depth().
  const Real* sample(int block, std::uint32_t lag) const { return begin(block) + back()[lag]; }
  Real* sample(int block, std::uint32_t lag) { return const_cast<Real*>(std::as_const(*this).sample(block, lag)); }

 private:
  std::span<Real> values_;
  std::span<std::uint32_t> lag_row_;
  int depth_ = 1;
  std::size_t row_ = 0;
  int place_ = 0;
};

}  // namespace wisp
