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

/// The regressors' values for a block's raw inputs of one lane.
template <class Real>
inline Real regress(const RegressorChannel& channel, Real input) {
  const Real number = input == input ? input : Real(0);
  const Real held = hold(number, Real(channel.low), Real(channel.high));
  Real part = held;
  if (channel.part == Part::kPositive) part = held > Real(0) ? held : Real(0);
  if (channel.part == Part::kNegative) part = held < Real(0) ? -held : Real(0);
  return settle((part - Real(channel.mean)) * Real(channel.inverse_scale));
}

/// The output's value in its own unit.
template <class Real>
inline Real present(const OutputChannel& channel, Real z) {
  return Real(channel.mean) + Real(channel.scale) * z;
}

}  // namespace wisp
