#pragma once
// A model's inputs and outputs as the kernels see them: deviations from the operating point in units near the channel's
// range, so that "too small to matter" means the same for every model: in the channel's own unit where its range is no
// smaller or larger than some hundred, else in a power of two, so that scaling is exact.

#include <cstdint>
#include <span>

#include "run/bank/arena.hpp"
#include "run/lanes/lanes.hpp"
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

/// An output's values in its own unit.
template <class N>
inline Reals<N> present(const OutputChannel& channel, const Reals<N>& z) {
  const auto deviation = channel.scale == 1 ? z : all<Reals<N>>(channel.scale) * z;
  const auto y = all<Reals<N>>(channel.mean) + deviation;
  return hold(y, all<Reals<N>>(channel.lowest), all<Reals<N>>(channel.highest));
}

/// Numbers with their sign turned; 0 stays +0.
template <class Part, int kParts>
inline auto negative(const Pack<Part, kParts>& values) {
  return all<Pack<Part, kParts>>(0.0f) - values;
}

/// What is read of a block, [output][lane], when the newest sample is shown.
template <class N>
inline void show_newest(const Channels& channels, const typename N::Real* newest, typename N::Real* out) {
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const OutputChannel& channel = channels.outputs[i];
    const std::size_t at = i * N::kLanes;
    const auto shown = channel.mirrors < 0 ? present<N>(channel, load<Reals<N>>(newest + at))
                                           : negative(load<Reals<N>>(out + channel.mirrors * N::kLanes));
    store(shown, out + at);
  }
}

/// The same when a `share` of the way from the sample before to the newest is shown.
template <class N>
inline void show_between(const Channels& channels, const typename N::Real* previous, const typename N::Real* newest,
                         float share, typename N::Real* out) {
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const OutputChannel& channel = channels.outputs[i];
    const std::size_t at = i * N::kLanes;
    if (channel.mirrors >= 0) {
      store(negative(load<Reals<N>>(out + channel.mirrors * N::kLanes)), out + at);
      continue;
    }
    const auto from = load<Reals<N>>(previous + at), to = load<Reals<N>>(newest + at);
    store(present<N>(channel, from + all<Reals<N>>(share) * (to - from)), out + at);
  }
}

}  // namespace wisp
