#pragma once
// A model's inputs and outputs as the kernels see them: deviations from the operating point in units of a power of two
// near the channel's range, so that scaling is exact and "too small to matter" means the same for every model.

#include <cstdint>
#include <span>

#include "run/arena.hpp"
#include "run/lanes.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// An output: y = mean + scale · z, z held to [low, high].
struct OutputChannel {
  float mean;
  float scale;
  float low;
  float high;
  float start;  ///< z of a newborn instance: the operating point
};

/// How a regressor is made from its input.
enum class Part : std::uint8_t { kWhole, kPositive, kNegative };

/// A regressor: z = (part(u) − mean) · inverse_scale, u held to [low, high].
struct RegressorChannel {
  std::int32_t input;
  Part part;
  float low;
  float high;
  float mean;
  float inverse_scale;
  float least;  ///< z is never below this,
  float most;   ///< nor above that
};

struct Channels {
  std::span<OutputChannel> outputs;
  std::span<RegressorChannel> regressors;
};

/// The power of two that a channel's deviations are measured in; 1 for a channel that does not move.
double channel_scale(double lowest, double highest);

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

/// The value of a regressor for its input; what is not a number counts as 0.
template <class Real>
inline Real regress(const RegressorChannel& channel, Real input) {
  const Real zero(0.0f);
  const Real held = hold(input == input ? input : zero, Real(channel.low), Real(channel.high));
  Real part = held;
  if (channel.part == Part::kPositive) part = held > zero ? held : zero;
  if (channel.part == Part::kNegative) part = held < zero ? -held : zero;
  return settle((part - Real(channel.mean)) * Real(channel.inverse_scale));
}

/// The outputs' values in their own units: [output][lane] from the state of the newest sample.
template <class N>
inline void show_newest(const Channels& channels, const typename N::Real* newest, typename N::Real* out) {
  for (const OutputChannel& channel : channels.outputs) {
    const auto z = load<Reals<N>>(newest);
    store(all<Reals<N>>(channel.mean) + all<Reals<N>>(channel.scale) * z, out);
    newest += N::kLanes;
    out += N::kLanes;
  }
}

/// The same `share` of the way from the sample before to the newest; between its own limits even when rounded.
template <class N>
inline void show_between(const Channels& channels, const typename N::Real* previous, const typename N::Real* newest,
                         float share, typename N::Real* out) {
  for (const OutputChannel& channel : channels.outputs) {
    const auto from = load<Reals<N>>(previous), to = load<Reals<N>>(newest);
    const auto between = from + all<Reals<N>>(share) * (to - from);
    const auto z = hold(between, all<Reals<N>>(channel.low), all<Reals<N>>(channel.high));
    store(all<Reals<N>>(channel.mean) + all<Reals<N>>(channel.scale) * z, out);
    previous += N::kLanes;
    newest += N::kLanes;
    out += N::kLanes;
  }
}

}  // namespace wisp
