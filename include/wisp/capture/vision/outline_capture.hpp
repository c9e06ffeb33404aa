#pragma once
// From frames to a recording of an outline, one frame at a time and in bounded memory.
//
// The first frames are held back until channel, level, place and knots are decided; from then on a frame is looked at
// once, in the neighbourhood of the thing, and let go.

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/vision/picture.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How an outline is captured.
struct OutlineCaptureOptions {
  int points = 8;                       ///< control points, 4 to 64; 8 as in the paper
  std::optional<PixelChannel> channel;  ///< nothing: the one that separates best
  bool dark = false;                    ///< the thing is dark on a light ground
  int flame = 1;                        ///< which of several flames, 1 the largest; 0: what moves, flame or not
  Region region;                        ///< where to look, pixels; empty: the whole picture
  std::optional<BaseSide> base;         ///< where the outline is open; nothing: the side that cuts it off, else below
  bool place_knots = true;              ///< put knots where the outline bends, if that fits better than uniform ones
  std::vector<double> knots;      ///< full knot vector to use, of a model or an earlier capture; empty: chosen here
  std::optional<bool> underside;  ///< whether the underside is followed, as in that capture; nothing: where it pays
  double rate_hz = 0;             ///< frames a second, > 0
  std::string source;             ///< where the frames come from, for messages and the recording
  std::size_t held_bytes = 48u << 20;  ///< frames held back for the first decisions, bytes; at least 8 frames are
  int held_frames = 40;                ///< … and frames, 8 to 200
};

/// Why a frame has no outline.
struct DroppedFrame {
  std::size_t frame = 0;  ///< 0-based row of the recording
  std::string reason;     ///< "fade", "nothing there", "elsewhere", "duplicate", "lost"
};

/// What a film is like, whatever is in it.
struct FilmFacts {
  std::size_t pictures = 0;
  double brightest = 255;         ///< the brightest point of all pictures, of 255 levels
  double flat = 0;                ///< share of a picture that is as bright as a camera shows anything, median
  double camera = 0;              ///< how far the whole picture moves from frame to frame, share of its size, mean
  std::vector<std::size_t> cuts;  ///< pictures, 0-based and in order, that begin another scene
};

/// What tells an outline of a flame from one of something else. Shares are of the rows with an outline.
struct OutlineFacts {
  std::size_t rows = 0;            ///< from the first outline until the flame is out for good
  std::size_t absent = 0;          ///< of them, without an outline, although their frame does not repeat the one before
  std::size_t blown = 0;           ///< of those, because the flame was blown out and lit again: see excuse_absence()
  std::size_t seen_from = 0;       ///< the first row with an outline
  std::size_t still = 0;           ///< rows before it in which the thing stood there and did not move
  std::size_t other_before = 0;    ///< rows before it, where most of them show another bright thing elsewhere
  std::size_t other_after = 0;     ///< … and rows after the last outline
  bool fades_out = false;          ///< the thing dims before the last outline, as where a film fades to black
  double lost = 0;                 ///< share of the clip's rows that have no frame, filled or not
  double repeated = 0;             ///< … and whose frame repeats the one before
  double jumps = 0;                ///< share of steps by which base or height change more than a flame's can
  std::array<double, 4> border{};  ///< share that reach the picture's left, upper, right and lower border
  double movement = 0;             ///< how far the shape moves on its base: root mean square over the median height
  double edge_noise = 0;           ///< what the film's stillest edges move by at random, pixels
  double wander = 0;               ///< how far the base moves over how far the shape moves on it
  double steadiness = 0;           ///< how much less its base moves than its tip, of the survey: 1 only the tip moves
  int stands = 1;                  ///< how many times every frame stands in the clip
  double misfit = 0;               ///< distance of edge points from the curve over the median height, mean
  double taper = 0;                ///< how much narrower it is near its tip than at its middle, median
  double lean = 0;                 ///< from upright, degrees, median: 90 lies on its side
  double width = 0;                ///< across its axis, over its height, median
  double light = 0;                ///< luma over the brightest there is
  double contrast = 255;           ///< its brightness less that of what is around it, levels of 255
  double clipped = 0;              ///< share of it that is flat: as bright in every channel as it gets
  double height = 0;               ///< median, pixels
  FilmFacts film;
};

/// What happened, in figures.
struct CaptureReport {
  std::size_t frames = 0;             ///< rows, lost frames included
  std::size_t tracked = 0;            ///< rows with an outline of their own
  std::size_t duplicates = 0;         ///< frames that repeat the one before
  std::size_t filled = 0;             ///< rows filled between their neighbours
  std::vector<DroppedFrame> dropped;  ///< rows without an outline
  double rate_hz = 0;
  int points = 0;
  double threshold = 0;  ///< brightness of the level, 0 black to 255 white
  PixelChannel channel = PixelChannel::kLuma;
  Histogram histogram{};  ///< of brightness, 0 black to 255 white
  int width = 0;          ///< of the picture, pixels
  int height = 0;
  double residual = 0;                ///< mean root-mean-square distance of edge points from the curve, pixels
  bool knots_placed = false;          ///< knots are not uniform
  std::vector<double> knots;          ///< the full knot vector
  bool underside = false;             ///< the underside is followed (attribute `underside`)
  int flames = 0;                     ///< how many there are; 0 where no flame was looked for
  std::optional<std::size_t> out_at;  ///< row from which on the flame is out for good
  OutlineFacts facts;                 ///< what the verdict rests on
  double likely_flame = 1;            ///< how likely a person would call the thing a flame, 0 to 1
  double likely_right = 0;            ///< … and its outline right and fit to be learned from
  bool usable = false;                ///< whether the outline can be learned from
  std::string reason;                 ///< why, or why not and what to film instead: one sentence
  std::vector<std::string> warnings;  ///< what the maker should know, one sentence each
};

/// One of the facts that the verdict weighs, and what it takes from the log odds of a flame and of a right outline: 0
/// where it could not be better.
struct WeighedFact {
  std::string name;
  double value = 0;
  double against_flame = 0;
  double against_right = 0;
};

/// The facts of a capture; those of a flame are left out where none was looked for.
std::vector<WeighedFact> weighed_facts(const CaptureReport& report);

/// Judges anew where it is known why `rows` of the rows have no outline: the flame had been blown out, `times` times,
/// and was lit again. A picture alone cannot tell that from a flame that was not found.
void excuse_absence(CaptureReport& report, std::size_t rows, std::size_t times);

/// A recording of an outline and how it came about.
struct CapturedOutline {
  Recording recording;
  CaptureReport report;
};

/// What is seen of the thing while it is captured, for whoever watches.
struct OutlineSeen {
  std::size_t frames = 0;  ///< rows so far, lost frames included
  bool decided = false;    ///< channel, level and place are; until then frames are held back, and all below is empty
  std::vector<double> polyline;  ///< x and y of 64 points of the outline in the last frame, pixels; empty: not there
  Region found;                  ///< its box in the last frame that it was found in, pixels
  PixelChannel channel = PixelChannel::kLuma;
  double threshold = 0;  ///< brightness of the level, 0 black to 255 white
  double clipped = 0;    ///< share of the thing that is as bright in every channel as it gets
  int flames = 0;        ///< how many there are; 0 where no flame was looked for
};

/// Captures an outline from frames that are fed in their order.
class OutlineCapture {
 public:
  /// Precondition: options.points >= 4 and options.rate_hz > 0.
  explicit OutlineCapture(OutlineCaptureOptions options);
  OutlineCapture(OutlineCapture&&) noexcept;
  OutlineCapture& operator=(OutlineCapture&&) noexcept;
  ~OutlineCapture();

  /// Shows a picture from anywhere in the clip, before the first frames are over: what holds for the whole clip is
  /// decided better when more of it has been seen. It is copied.
  ///
  /// Precondition: the picture has the size and layout of the frames.
  void glimpse(const Picture& picture);

  /// Takes in the next frame; it is borrowed for the call.
  /// Errors: a frame of another size than the first, a region outside the picture, a channel that the picture has not,
  /// nothing that stands out in the first frames.
  Result<void> feed(const Picture& picture);

  /// Notes that the clip lost `count` frames here.
  void lost(int count = 1);

  /// What the film is like so far.
  FilmFacts film() const;

  /// What the frames so far have shown.
  OutlineSeen seen() const;

  /// Ends the clip. Returns the recording: outputs p0.x, p0.y, … and motion base.x, base.y in pixels, flag `filled`,
  /// one row a frame, missing rows empty.
  /// Errors: fewer than 10 frames with an outline, and why.
  Result<CapturedOutline> finish();

 private:
  class Stage;
  std::unique_ptr<Stage> stage_;
};

}  // namespace wisp
