#pragma once
// When a flame goes out, as a plain value: learned, stored, played.
//
// Wind harms a flame while it is at least `level`, and a flame that is left alone recovers. Harm h goes from 0,
// unharmed, to 1, where the flame goes out and stays out until it is lit again:
//
//   dh/dt =  (1 + haste · (w / level − 1)) / seconds   while w ≥ level, w = |wind|, counted up to kMaxWind · level
//   dh/dt =  −1 / recovery                             below it; h is never less than 0
//
// So a wind of exactly `level` blows the flame out in `seconds`, a stronger one sooner, a gust that is shorter leaves
// it alight, and gusts that follow each other closely add up.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// The sizes of what is seen through recorded events, step after step: a stored 255 is the full size.
struct SizeEvents {
  static constexpr std::size_t kMaxEvents = 64;    ///< events
  static constexpr std::size_t kMaxSizes = 65536;  ///< of all events

  std::vector<std::uint8_t> sizes;
  std::vector<std::uint32_t> ends;  ///< one past the last size of each event, ascending

  bool empty() const { return ends.empty(); }

  friend bool operator==(const SizeEvents&, const SizeEvents&) = default;
};

/// A rule of extinction.
struct Extinction {
  /// Wind counts up to this many levels: a single absurd sample does not blow a flame out.
  static constexpr double kMaxWind = 3;

  std::size_t input = 0;  ///< index of the model's input that blows; its strength counts, not its sign
  double level = 2;       ///< least wind that kills, in the input's unit of 1, 1e-6 … 1e6. 2: twice the strong wind
                          ///< of training, which the flame lived through
  double seconds = 0.2;  ///< for which that wind must last, 1e-3 … 3600; a candle of about 30 mm is gone in that time
  double haste = 2;  ///< how much sooner stronger wind kills, 0 … 100; 0: any wind above the level takes `seconds`.
                     ///< 2 at twice the level: a third of the time
  double recovery = 0.3;  ///< seconds below the level in which a flame on the verge of death recovers, 1e-3 … 3600: the
                          ///< wick stays hot that long
  SizeEvents dying{};     ///< from going out on, of what was seen then; empty: those of a simulated candle
  SizeEvents catching{};  ///< from being lit on; empty: those of a simulated candle

  friend bool operator==(const Extinction&, const Extinction&) = default;
};

/// The events that are played at a rate: the rule's own, or where it has none those of a simulated candle.
SizeEvents dying_of(const Extinction& rule, double rate_hz);
SizeEvents catching_of(const Extinction& rule, double rate_hz);

/// Checks that every number is finite and in its range, and that there is an input of that index among `inputs` of
/// them. Errors say which, what was found and what was expected.
Result<void> check(const Extinction& rule, std::size_t inputs);

}  // namespace wisp
