#pragma once
// Where motion is cut: at critical events, zeros or extrema of a channel or of a signal derived from the motion.
//
// Source: section 4.1.1 of the paper (a leaf is cut where it stalls: its forward speed in its own plane is zero).

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/motion.hpp"

namespace wisp {

enum class EventKind { kZero, kMinimum, kMaximum };

/// What cuts: an event of a signal.
struct EventSpec {
  EventKind kind = EventKind::kZero;
  std::string signal = "forward_speed";
};

/// `zero:SIGNAL`, `min:SIGNAL` or `max:SIGNAL`. SIGNAL is a channel, or one of speed, horizontal_speed, and
/// forward_speed (along the body's second axis).
/// Errors: another form.
Result<EventSpec> parse_event(std::string_view text);

struct SegmentationOptions {
  EventSpec event{};
  double least_seconds = 0.04;  ///< ≥ 0: events nearer to the one before are left out; 0.04 is 2 frames of 60
  double debounce = 0.1;  ///< ≥ 0: how far, in standard deviations of the signal, it must go beyond a zero on both
                          ///< sides, or away from an extremum, before that counts
};

/// A piece of motion between two events: [begin, end] in rows of its piece, between samples.
struct Segment {
  std::size_t piece = 0;
  double begin = 0;
  double end = 0;
  int steps = 1;  ///< whole rows that it stands for; those of a piece's segments add up to the rows between its events
};

struct Segmentation {
  std::vector<Segment> segments;  ///< in order; one whose piece is that of the one before follows it
  std::vector<std::string> warnings;
  std::size_t pieces_without = 0;  ///< pieces with fewer than two events
};

/// The events of one signal, in rows, between samples. `deviation` is the signal's standard deviation.
std::vector<double> event_rows(std::span<const double> signal, double rate_hz, double deviation,
                               const SegmentationOptions& options);

/// Cuts motion into segments. Stretches before a piece's first event and after its last are left out.
/// Errors: a signal that is neither a channel nor derived, one that needs orientation where there is none, an option
/// out of range, no segment at all.
Result<Segmentation> segment(const Motion& motion, std::span<const Recording> recordings,
                             const SegmentationOptions& options);

}  // namespace wisp
