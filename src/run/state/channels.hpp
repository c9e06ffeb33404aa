#pragma once
// A model's inputs and outputs in the kernels: deviations from the operating point, in units near the channel's range,
// so that "negligible" means the same for every model. The unit is the channel's own if its range is 1/128 to 128, else
// a power of two, so that scaling is exact.

#include <cstdint>
#include <span>
#include <vector>

#include "run/lanes/blocks.hpp"
#include "run/state/arena.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// An output: y = mean + scale · z, with z clamped to [low, high] and the rounded y to [lowest, highest].
struct OutputChannel {
  float mean;
  float scale;
  float low;
  float high;
  float lowest;
  float highest;
  float start;  ///< z of a new instance: the operating point
};

/// Part of an input from which a regressor is computed: the whole input (kWhole) or its magnitude (kSize); for a wind
/// vector its length, or the length times the x (kAlong) or the z (kAcross) of its direction.
enum class RegressorPart : std::uint8_t { kWhole, kSize, kLength, kAlong, kAcross };

/// Power of a part that a regressor takes; a power of a whole input has the input's sign.
enum class RegressorPower : std::uint8_t { kOne, kRoot, kSquare };

/// Part and power of an input's regressor.
struct RegressorForm {
  RegressorPart part;
  RegressorPower power = RegressorPower::kOne;
};

/// Returns the regressors of an input of that shape, in order.
std::span<const RegressorForm> regressor_forms(InputShape shape);

/// A regressor: z = (part(u) − mean) · inverse_scale, where u is first clamped to [low, high]. For a root or a square,
/// z = power(part(u) · inverse_scale) − mean, with the mean in the regressor's unit, so that a square can't overflow.
struct RegressorChannel {
  std::int32_t input;  ///< index of the input; of a vector its first component
  RegressorPart part;
  RegressorPower power;
  float low;
  float high;
  float mean;
  float inverse_scale;
  float least;  ///< lower bound of z
  float most;   ///< upper bound of z
};

struct Channels {
  std::span<OutputChannel> outputs;
  std::span<RegressorChannel> regressors;
};

/// Returns the power of two in which a channel's deviations are measured; 1 if its range is 0 or 1/128 to 128 wide.
double channel_scale(double lowest, double highest);

/// Returns the unit of a regressor, given its index among the regressors of all inputs.
double regressor_scale(const Model& model, int regressor);

/// Returns the ranges of the dynamics' variables: the components of an outline's shape, if any, else the outputs.
std::vector<ValueRange> moved_ranges(const Model& model);

/// The operating point of a model's dynamics, per channel.
struct OperatingPoint {
  std::span<const double> outputs;
  std::span<const double> regressors;
};

Channels make_channels(const Model& model, const OperatingPoint& point, Arena& arena);

/// Errors: a range or mean too large or small for single precision, a reversed range, a nonzero mean of a wind vector.
Result<void> check_channels(const Model& model, const OperatingPoint& point);

std::uint64_t hash_of(const Channels& channels, std::uint64_t before);

/// Returns the root or square, as the channel demands, of magnitudes of its input, in the regressor's unit.
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
  return part;
}

/// Returns the values of a regressor (not of a vector) from its inputs; NaN counts as 0.
template <class N>
inline Reals<N> regress(const RegressorChannel& channel, const Reals<N>& inputs) {
  const auto zero = all<Reals<N>>(0.0f);
  const auto clamped = hold(number_or(inputs, zero), all<Reals<N>>(channel.low), all<Reals<N>>(channel.high));
  auto part = clamped;
  if (channel.part == RegressorPart::kSize) part = magnitude(clamped);
  if (channel.power != RegressorPower::kOne) {
    const auto size = power_of<N>(channel, magnitude(part));
    const auto signed_size = [](const auto& a, const auto& none, const auto& b) { return a < none ? none - b : b; };
    part = channel.part == RegressorPart::kWhole ? each(signed_size, part, zero, size) : size;
    return settle(channel.mean != 0 ? part - all<Reals<N>>(channel.mean) : part);
  }
  if (channel.mean != 0) part = part - all<Reals<N>>(channel.mean);
  if (channel.inverse_scale != 1) part = part * all<Reals<N>>(channel.inverse_scale);
  return settle(part);
}

/// Length, clamped, and direction of a horizontal vector. If z is 0, they equal |x| and the sign of x to the bit.
template <class N>
struct LevelVector {
  LevelVector(const Reals<N>& along, const Reals<N>& across, float most) {
    const auto zero = all<Reals<N>>(0.0f), one = all<Reals<N>>(1.0f), high = all<Reals<N>>(most);
    const auto clamped = [&](const Reals<N>& part) { return settle(hold(number_or(part, zero), zero - high, high)); };
    x = clamped(along), z = clamped(across);
    // Scaled by the larger component, so that no square overflows or underflows.
    const auto least_one = [](const auto& a, const auto& none, const auto& b) { return a > none ? a : b; };
    const auto scale = larger(magnitude(x), magnitude(z)), divisor = each(least_one, scale, zero, one);
    x = x / divisor, z = z / divisor;
    const auto length_of = square_root(x * x + z * z), unit = each(least_one, length_of, zero, one);
    length = smaller(scale * length_of, high);
    x = settle(hold(x / unit, zero - one, one)), z = settle(hold(z / unit, zero - one, one));
  }

  Reals<N> length, x, z;
};

/// Computes a block's regressors from lanes_of(input), to be called in order: a vector is decomposed at its first one.
template <class N, class LanesOf>
class Regressing {
 public:
  explicit Regressing(const LanesOf& lanes_of) : lanes_of_(lanes_of) {}

  Reals<N> operator()(const RegressorChannel& channel) {
    if (channel.part < RegressorPart::kLength) return regress<N>(channel, lanes_of_(channel.input));
    if (channel.part == RegressorPart::kLength && channel.power == RegressorPower::kOne) take(channel);
    const auto power = power_[static_cast<int>(channel.power)];
    if (channel.part == RegressorPart::kLength) return settle(power);
    return settle(power * (channel.part == RegressorPart::kAlong ? x_ : z_));
  }

 private:
  void take(const RegressorChannel& channel) {
    const LevelVector<N> vector(lanes_of_(channel.input), lanes_of_(channel.input + 1), channel.high);
    power_[0] = vector.length * all<Reals<N>>(channel.inverse_scale);
    power_[1] = square_root(power_[0]);
    power_[2] = power_[0] * power_[0];
    x_ = vector.x, z_ = vector.z;
  }

  const LanesOf& lanes_of_;
  Reals<N> power_[3], x_, z_;
};

/// Converts an output's deviations to the output's own unit. Keeps the constants loaded for many values.
template <class Values>
class Presentation {
 public:
  explicit Presentation(const OutputChannel& channel)
      : mean_(all<Values>(channel.mean)),
        scale_(all<Values>(channel.scale)),
        lowest_(all<Values>(channel.lowest)),
        highest_(all<Values>(channel.highest)),
        scales_(channel.scale != 1),
        own_(channel.scale == 1 && channel.mean == 0 && channel.low >= channel.lowest &&
             channel.high <= channel.highest) {}

  Values of(const Values& z) const { return own_ ? z : hold(mean_ + (scales_ ? scale_ * z : z), lowest_, highest_); }

 private:
  Values mean_, scale_, lowest_, highest_;
  bool scales_;
  bool own_;  // z is already in the output's unit and range
};

/// Loads part i of the values of consecutive blocks, from `after` numbers behind their addresses.
template <class N, class Value, int kBlocks>
inline auto load_part(const BlockPlaces<Value, kBlocks>& places, std::size_t after, int i) {
  Pack<typename PartsOfBlocks<N, kBlocks>::RealPart, 1> one;
  load_block_part<N>(places, after, i, one.part[0]);
  return one;
}

/// Computes the readable outputs of consecutive blocks, [output][lane] each. z(after, i) returns part i of an output's
/// deviations. Parts are computed one by one, since narrow machines have few registers.
template <class N, int kBlocks, class Deviation>
inline void show_blocks(std::span<const OutputChannel> outputs, typename N::Real* out, Deviation z) {
  const BlockPlaces<typename N::Real, kBlocks> shown(out, outputs.size() * N::kLanes);
  std::size_t after = 0;
  for (const OutputChannel& channel : outputs) {
    const Presentation<Pack<typename PartsOfBlocks<N, kBlocks>::RealPart, 1>> presentation(channel);
    unrolled<PartsOfBlocks<N, kBlocks>::kParts>([&](auto i) {
      const auto y = presentation.of(z(after, i));
      store_block_part<N>(y.part[0], shown, after, i);
    });
    after += N::kLanes;
  }
}

}  // namespace wisp
