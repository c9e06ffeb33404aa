#pragma once
// What a segment chain is learned by. Sources: sections 2.2 and 4 of the paper.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

enum class EventKind { kZero, kMinimum, kMaximum };

/// The event at which motion is cut: a zero or an extremum of a signal.
struct EventSpec {
  EventKind kind = EventKind::kZero;
  std::string signal = "forward_speed";  ///< a channel, or speed, horizontal_speed, or forward_speed (along the body's
                                         ///< second axis)
};

/// `zero:SIGNAL`, `min:SIGNAL` or `max:SIGNAL`.
/// Errors: another form.
Result<EventSpec> parse_event(std::string_view text);

/// The realisation of a mode: what its segments are.
enum class Realisation {
  kSegments,  ///< recorded ones
  kLinear,    ///< made by a linear system with noise, from where recorded ones begin
  kOde,       ///< made by a differential equation with products of velocities, likewise
  kChain,     ///< halves of recorded ones, a mode being a chain of its own
  kSpline,    ///< splines that vary as the recorded ones do
};

/// `segments`, `linear`, `ode`, `chain` or `spline`.
/// Errors: another word.
Result<Realisation> parse_realisation(std::string_view text);

/// The words that the parsers read.
std::string word_of(const EventSpec& event);
std::string_view word_of(Realisation realisation);

/// How a chain is learned from recordings of something that moves: outputs pos.x, pos.y, pos.z in metres, z up, and,
/// where known, q.w, q.x, q.y, q.z. Two recordings that share the attribute `pair`, one of them calm, teach its
/// response to gusts.
struct ChainRecipe {
  std::string name = "chain";  ///< of the model
  EventSpec event{EventKind::kMinimum, "horizontal_speed"};
  bool heading_free = true;  ///< vectors are seen along a segment's own direction over ground; otherwise the world's
  int modes = 0;    ///< 1 … 64: kinds of segment, one of the next kind follows, as in the paper. 0: none where
                    ///< orientation is known, else 6
  int history = 1;  ///< modes that the next one depends on, 1 or 2
  Realisation realisation = Realisation::kSegments;
  int best_of = 4;  ///< 0 … 256, where orientation is known: best-joining successors kept for each segment and mode; 0:
                    ///< any segment of the mode follows (the paper's), as without orientation
  double blend = 0.15;  ///< seconds on either side that a join may be spread over, 0 … 0.5; 0: joins stay as they are
  double min_seconds = 0.04;  ///< ≥ 0, shortest segment: events nearer to the one before are left out
  double debounce = 0.1;  ///< ≥ 0: how far, in standard deviations of the signal, it must go beyond a zero on both
                          ///< sides, or away from an extremum, before that counts
  int smooth_rows = 0;    ///< odd: rows that velocities are taken over, where positions are noisy; 0: none
  std::size_t max_bytes = 4'000'000;  ///< > 0, of stored segments; what is over it is left out, in strata by dive,
                                      ///< speed and turn. A leaf for the web has 900'000
  double holdout = 0.2;    ///< 0 … 0.9: share of the stretches, the last ones, kept from learning and judged on
  double half_width = 0;   ///< metres of the body along its first axis, for who draws it; 0: as the first recording's
  double half_length = 0;  ///< attribute leaf_length_width_density says. And along its second
  std::uint64_t seed = 1;
};

/// A leaf: a chain that is cut where the leaf stalls, where its forward speed in its own plane is zero (section 4.1.1
/// of the paper).
struct LeafRecipe : ChainRecipe {
  LeafRecipe() {
    name = "leaf";
    event = {EventKind::kZero, "forward_speed"};
  }
};

/// Names of a column of seconds, where a recording has one: it must go on evenly.
inline constexpr std::array<const char*, 3> kTimeColumns = {"t", "t_s", "time"};

/// Whether a recording tells motion. Errors: no position, no stretch that is long enough, no orientation where it
/// should have one, a position that is not in metres or further than 1000 km away; of one with the attribute `pair`, a
/// wind that is missing somewhere or an attribute `clones` that is no whole number.
Result<void> check_motion(const Recording& recording);

}  // namespace wisp
