#pragma once
// Settings for learning a segment chain. Source: L.-M. Reissell and D. K. Pai (2001), sections 2.2 and 4.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

#include "wisp/base/result.hpp"
#include "wisp/learn/recipe_fields.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

enum class EventKind { kZero, kMinimum, kMaximum };

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<EventKind>{"zero", "min", "max"};

/// The event at which motion is cut: a zero or an extremum of a signal.
struct EventSpec {
  EventKind kind = EventKind::kZero;
  std::string signal = "forward_speed";  ///< a channel, or speed, horizontal_speed, or forward_speed (along the body's
                                         ///< second axis)
};

/// Parses `zero:SIGNAL`, `min:SIGNAL` or `max:SIGNAL`. Errors: another form.
Result<EventSpec> parse_event(std::string_view text);

/// Realisation of a mode: the source of its segments.
enum class Realisation {
  kSegments,  ///< recorded segments
  kLinear,    ///< simulated by a linear system with noise, from recorded initial states
  kOde,       ///< simulated by a differential equation with products of velocities, from recorded initial states
  kChain,     ///< halves of recorded segments; each mode becomes a chain of four smaller modes
  kSpline,    ///< recorded segments as B-splines, reduced to their mode's 12 largest principal components
};

template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<Realisation>{"segments", "linear", "ode", "chain", "spline"};

/// Returns the text that parse_event() accepts.
std::string word_of(const EventSpec& event);

/// Settings for learning a chain from recordings of a moving body: outputs pos.x, pos.y, pos.z in metres, z up, and, if
/// known, q.w, q.x, q.y, q.z. Two recordings that share the attribute `pair`, one of them calm, provide the body's
/// response to gusts. fields_of() below documents each field.
struct ChainRecipe {
  std::string name = "chain";
  EventSpec event{EventKind::kMinimum, "horizontal_speed"};
  bool heading_free = true;
  int modes = 0;
  int history = 1;
  Realisation realisation = Realisation::kSegments;
  int best_of = 4;
  double blend = 0.15;
  double min_seconds = 0.04;
  double debounce = 0.1;
  int smooth_rows = 0;
  std::size_t max_bytes = 4'000'000;  ///< the leaves of the web page are learned with 900'000
  double holdout = 0.2;
  double half_width = 0;
  double half_length = 0;
  std::uint64_t seed = 1;
};

/// A leaf: a chain cut where the leaf stalls, that is, has no forward speed in its own plane (paper, section 4.1.1).
struct LeafRecipe : ChainRecipe {
  LeafRecipe() {
    name = "leaf";
    event = {EventKind::kZero, "forward_speed"};
  }
};

constexpr auto fields_of(const ChainRecipe&) {
  using R = ChainRecipe;
  return std::tuple(
      field("name", &R::name, "of the model"),
      field("event", &R::event,
            "where motion is cut: zero:, min: or max: of a channel, or of speed, horizontal_speed, forward_speed",
            {"event", "SPEC"}),
      field("heading_free", &R::heading_free,
            "whether directions are the world's, or a segment's own, so that the chain does not learn which way was "
            "north",
            {.flag = "frame", .sign = "world|heading", .words = {"world", "heading"}}),
      field("modes", &R::modes,
            "kinds of segment, one of the next of which follows; auto: none, or 6 where there is no orientation",
            {"modes", "K|auto", 1, 64, "auto"}),
      field("history", &R::history, "how many kinds back the next one depends on", {"history", "H", 1, 2}),
      field(
          "realisation", &R::realisation,
          "what segments are: recorded ones; recorded ones smoothed by the largest components of their kind; made by a "
          "linear system with noise, or by a differential equation (ode), of each kind; or halves, each kind a chain "
          "of its own",
          {"realisation", "HOW"}),
      field("best_of", &R::best_of,
            "where orientation is known a segment is followed by one of its N best-joining ones; 0: by any, of the "
            "next kind",
            {"best-of", "N", 0, 256}),
      field("blend", &R::blend, "most seconds on either side that a join is spread over; 0: joins stay as they are",
            {"blend", "S", 0, 0.5}),
      field("min_seconds", &R::min_seconds, "seconds; events nearer to the one before do not count",
            {"shortest", "S", 0, 60}),
      field("debounce", &R::debounce, "standard deviations that the signal must move beyond an event on both sides",
            {"debounce", "D", 0, 100}),
      field("smooth_rows", &R::smooth_rows, "rows that velocities are taken over, where positions are noisy",
            {"smooth", "ROWS", 0, 10001}),
      field("max_bytes", &R::max_bytes,
            "of stored segments; of what is more, evenly by dive, speed and turn, some are left out",
            {"max-bytes", "N", 1, 1e9}),
      field("holdout", &R::holdout, "share of the stretches, the last ones, kept for judging",
            {"holdout", "SHARE", 0, 0.9}),
      field("half_width", &R::half_width,
            "metres of the body along its first axis, for who draws it; 0: as the first recording's attribute "
            "leaf_length_width_density says",
            {nullptr, "", 0}),
      field("half_length", &R::half_length, "and along its second axis", {nullptr, "", 0}),
      field("seed", &R::seed, "of all chance", {"seed", "N"}));
}

/// Names of an optional time column in seconds, which must increase in equal steps.
inline constexpr std::array<const char*, 3> kTimeColumns = {"t", "t_s", "time"};

/// Checks that a recording describes motion. Errors: no position; an incomplete or not normalised quaternion; no 8
/// complete rows in succession; a jump; unequal time steps; positions not in metres or beyond 1000 km; with the
/// attribute `pair`, a missing wind sample or an attribute `clones` that is not a whole number from 1 to 10000.
Result<void> check_motion(const Recording& recording);

}  // namespace wisp
