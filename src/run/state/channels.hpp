#pragma once
// A model's inputs and outputs as the kernels see them: deviations from the operating point in units near the channel's
// range, so that "too small to matter" means the same for every model: in the channel's own unit where its range is no
// smaller or larger than some hundred, else in a power of two, so that scaling is exact.

#include <cstdint>
#include <span>
#include <vector>

#include "run/lanes/blocks.hpp"
#include "run/state/arena.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// An output: y = mean + scale · z, z clamped to [low, high]; y, once rounded, to [lowest, highest].
struct OutputChannel {
  float mean;
  float scale;
  float low;
  float high;
  float lowest;
  float highest;
  float start;                ///< z of a newborn instance: the operating point
  std::int32_t mirrors = -1;  ///< an earlier output that this is always the negative of, or −1
};

/// How a regressor is made from its input.
enum class RegressorPart : std::uint8_t { kWhole, kPositive, kNegative };

/// What of a part a regressor is.
enum class RegressorPower : std::uint8_t { kOne, kRoot, kSquare };

/// A regressor of an input.
struct RegressorForm {
  RegressorPart part;
  RegressorPower power = RegressorPower::kOne;
};

/// The regressors that an input of that shape makes, in their order.
std::span<const RegressorForm> regressor_forms(InputShape shape);

/// A piece of an input's curve: what it is at a knot, and what it climbs from there to the next.
struct CurvePiece {
  float from;
  float width;
  float slope;
  float value;
};

/// A regressor: z = (part(u) − mean) · inverse_scale, u clamped to [low, high] first. Where there is a curve it bends
/// the part. Of a power it is power(part(u) · inverse_scale) − mean · inverse_scale, so that a square overflows
/// nothing.
struct RegressorChannel {
  std::int32_t input;
  RegressorPart part;
  RegressorPower power;
  float low;
  float high;
  float mean;
  float inverse_scale;
  float least;                        ///< z is never below this,
  float most;                         ///< nor above that
  std::span<const CurvePiece> curve;  ///< the last goes on without end; empty: none
};

struct Channels {
  std::span<OutputChannel> outputs;
  std::span<RegressorChannel> regressors;
};

/// The power of two that a channel's deviations are measured in; 1 where its range is 1/128 to 128, or nothing.
double channel_scale(double lowest, double highest);

/// What the deviations of a power of an input are measured in.
double regressor_unit(const Input& input, RegressorPower power);

/// The same of a regressor by its place among all of a model's.
double regressor_scale(const Model& model, int regressor);

/// Ranges of what the dynamics move: of the components of an outline's shape where there are some, else of the outputs.
std::vector<ValueRange> moved_ranges(const Model& model);

/// The operating point of each channel, as the dynamics know it.
struct OperatingPoint {
  std::span<const double> outputs;
  std::span<const double> regressors;
};

/// Lays the channels out and, unless the arena measures, fills them.
Channels make_channels(const Model& model, const OperatingPoint& point, Arena& arena);

/// Errors: a range or a mean that single precision can't hold with room to compute.
Result<void> check_channels(const Model& model, const OperatingPoint& point);

/// A hash of the channels, over a hash of what came before.
std::uint64_t hash_of(const Channels& channels, std::uint64_t before);

/// A curve at an input: up to the first knot the input itself, then what it is at the knot before and what it climbs
/// from there. Which knot that is takes comparisons alone, so that more knots take no more arithmetic.
template <class Real>
inline Real bend(std::span<const CurvePiece> curve, Real input) {
  if (!(input > Real(curve.front().from))) return input;
  const CurvePiece* piece = curve.data();
  for (const CurvePiece& next : curve) {
    if (!(input < Real(next.from))) piece = &next;
  }
  Real climbed = input - Real(piece->from);
  if (climbed > Real(piece->width)) climbed = Real(piece->width);  // by rounding: it is short of the next knot
  return Real(piece->value) + Real(piece->slope) * climbed;
}

/// A power of the parts of inputs, none of them below 0.
template <class N>
inline Reals<N> power_of(const RegressorChannel& channel, Reals<N> part) {
  if (channel.inverse_scale != 1) part = part * all<Reals<N>>(channel.inverse_scale);
  if (channel.power == RegressorPower::kSquare) {
    part = part * part;
  } else {
    typename N::Real root[N::kLanes];
    store(part, root);
    for (auto& lane : root) lane = square_root(lane);
    part = load<Reals<N>>(root);
  }
  return channel.mean != 0 ? part - all<Reals<N>>(channel.mean) : part;
}

/// The values of a regressor for its inputs; what is not a number counts as 0.
template <class N>
inline Reals<N> regress(const RegressorChannel& channel, const Reals<N>& inputs) {
  const auto zero = all<Reals<N>>(0.0f);
  const auto clamped = hold(number_or(inputs, zero), all<Reals<N>>(channel.low), all<Reals<N>>(channel.high));
  auto part = clamped;
  if (channel.part == RegressorPart::kPositive) part = larger(clamped, zero);
  if (channel.part == RegressorPart::kNegative) part = zero - smaller(clamped, zero);
  if (!channel.curve.empty()) {
    typename N::Real bent[N::kLanes];
    store(part, bent);
    for (auto& lane : bent) lane = bend(channel.curve, lane);
    part = load<Reals<N>>(bent);
  }
  if (channel.power != RegressorPower::kOne) return settle(power_of<N>(channel, part));
  if (channel.mean != 0) part = part - all<Reals<N>>(channel.mean);
  if (channel.inverse_scale != 1) part = part * all<Reals<N>>(channel.inverse_scale);
  return settle(part);
}

/// Turns an output's deviations to values in its own unit. Holds what it takes, so that it is read once for many.
template <class Values>
class Presentation {
 public:
  explicit Presentation(const OutputChannel& channel)
      : mean_(all<Values>(channel.mean)),
        scale_(all<Values>(channel.scale)),
        lowest_(all<Values>(channel.lowest)),
        highest_(all<Values>(channel.highest)),
        scales_(channel.scale != 1) {}

  Values of(const Values& z) const { return hold(mean_ + (scales_ ? scale_ * z : z), lowest_, highest_); }

 private:
  Values mean_, scale_, lowest_, highest_;
  bool scales_;
};

/// Numbers with their sign turned; 0 stays +0.
template <class Part, int kParts>
inline auto negative(const Pack<Part, kParts>& values) {
  return all<Pack<Part, kParts>>(0.0f) - values;
}

/// A part of the values of blocks in a row, `after` numbers from the beginning of each.
template <class N, class Value, int kBlocks>
inline auto load_part(const BlockPlaces<Value, kBlocks>& places, std::size_t after, int i) {
  Pack<typename PartsOfBlocks<N, kBlocks>::RealPart, 1> one;
  load_block_part<N>(places, after, i, one.part[0]);
  return one;
}

/// What is read of blocks in a row, [output][lane] each: of every output z(after, i), a part of its values. One part
/// after the other, since narrow machines have registers for a few.
template <class N, int kBlocks, class Deviation>
inline void show_blocks(std::span<const OutputChannel> outputs, typename N::Real* out, Deviation z) {
  const BlockPlaces<typename N::Real, kBlocks> shown(out, outputs.size() * N::kLanes);
  std::size_t after = 0;
  for (const OutputChannel& channel : outputs) {
    const Presentation<Pack<typename PartsOfBlocks<N, kBlocks>::RealPart, 1>> presentation(channel);
    unrolled<PartsOfBlocks<N, kBlocks>::kParts>([&](auto i) {
      const auto y = channel.mirrors < 0 ? presentation.of(z(after, i))
                                         : negative(load_part<N>(shown, channel.mirrors * N::kLanes, i));
      store_block_part<N>(y.part[0], shown, after, i);
    });
    after += N::kLanes;
  }
}

}  // namespace wisp
