#pragma once
// Rule by which wind extinguishes a flame, as a plain value.
//
// Wind of at least `level` accumulates damage, and a flame in weaker wind recovers. Damage h grows from 0 to 1, at
// which the flame is extinguished and stays so until it is relit:
//
//   dh/dt =  (1 + haste · (w / level − 1)) / seconds   while w ≥ level, w = |wind|, limited to kMaxWind · level
//   dh/dt =  −1 / recovery                             below it; h is never less than 0
//
// So a wind of exactly `level` blows the flame out in `seconds`, a stronger wind sooner; a shorter gust leaves the
// flame alight, and gusts in close succession add up. Banks limit the growth of h to 1/2 per step.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Recorded events, step by step: the apparent size of the flame and, for re-ignition, its shape. The recorded outline
/// is the shape's outline times the size.
struct FlameEvents {
  static constexpr std::size_t kMaxEvents = 64;    ///< largest number of events
  static constexpr std::size_t kMaxSizes = 65536;  ///< largest number of sizes in all events

  std::vector<std::uint8_t> sizes;    ///< a stored 255 is the full size
  std::vector<std::uint32_t> ends{};  ///< one past the last size of each event, ascending
  std::vector<double> scale{};        ///< value of a stored 1 per component of the view's shape, >= 0; empty: no shapes
  std::vector<std::int8_t> shapes{};  ///< sizes × components

  bool empty() const { return ends.empty(); }

  friend bool operator==(const FlameEvents&, const FlameEvents&) = default;
};

/// A rule of extinction.
struct Extinction {
  /// Wind is limited to this many levels: a single outlier does not blow a flame out.
  static constexpr double kMaxWind = 3;

  std::size_t input = 0;  ///< index of the model's wind input; its magnitude is used, not its sign
  double level = 2;  ///< least extinguishing wind, in the input's unit, 1e-6 … 1e6. Default: twice the strong wind
                     ///< of training, which the flame survived
  double seconds = 0.2;  ///< time to extinction in a wind of `level`, 1e-3 … 3600. Default: for a candle of about 30 mm
  double haste = 2;  ///< acceleration by stronger wind, 0 … 100; 0: any wind above the level takes `seconds`. 2: wind
                     ///< of twice the level takes a third of `seconds`
  double recovery = 0.3;  ///< time in weaker wind in which damage falls from 1 to 0, 1e-3 … 3600 s: the wick stays hot
                          ///< that long
  FlameEvents dying{};     ///< recorded sizes from extinction on; empty: sizes of a simulated candle
  FlameEvents catching{};  ///< recorded sizes and shapes from lighting on; empty: sizes of a simulated candle

  friend bool operator==(const Extinction&, const Extinction&) = default;
};

/// Return the rule's recorded extinctions and re-ignitions or, if it has none, a simulated candle's, at `rate_hz`.
FlameEvents dying_of(const Extinction& rule, double rate_hz);
FlameEvents catching_of(const Extinction& rule, double rate_hz);

/// Checks that every number is finite and in its range, that the rule's input is below `inputs`, that recorded shapes
/// have one number for each of the `components` of the outline's shape in the plane, and that `dying` has no shapes.
/// Errors name the number, what was found and what was expected.
Result<void> check(const Extinction& rule, std::size_t inputs, std::size_t components);

}  // namespace wisp
