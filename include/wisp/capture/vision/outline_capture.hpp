#pragma once
// Captures an outline as a recording, one frame at a time.
//
// The first frames are buffered until channel, level, position and knots are chosen; from then on each frame is
// processed at once, in the neighbourhood of the object, and released.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/vision/picture.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Options of capturing an outline.
struct OutlineCaptureOptions {
  int points = 8;                       ///< control points, 4 to 64; 8 as in the paper
  std::optional<PixelChannel> channel;  ///< colour channel to segment by; none: the one that separates best
  bool dark = false;                    ///< the object is dark on a light background
  int flame = 1;                        ///< size rank of the flame to capture, 1 the largest; 0: any moving object
  Region region;                        ///< search region, pixels; empty: the whole picture
  std::vector<double> knots;            ///< full knot vector of a model or an earlier capture; empty: estimated
  std::optional<bool> underside;        ///< whether the curve includes the underside; none: if it fits better
  double rate_hz = 0;                   ///< frames a second, > 0
  std::size_t first_frame = 1;          ///< number of the first frame in its film, for messages
  std::string source;                   ///< name of the frames' source, for messages and the recording
  std::size_t held_bytes = 48u << 20;   ///< bytes of buffered frames, at least 8 frames, that start the first decisions
  int held_frames = 40;                 ///< number of buffered frames at which the first decisions are made, 8 to 200
};

/// A frame without an outline, and the reason.
struct DroppedFrame {
  std::size_t frame = 0;  ///< 0-based row of the recording
  std::string reason;     ///< "fade", "nothing there", "elsewhere", "duplicate", "lost"
};

/// Properties of a film that do not depend on its subject.
struct FilmFacts {
  std::size_t pictures = 0;
  double brightest = 255;         ///< brightness of the brightest point of all pictures, 0 to 255
  double flat = 0;                ///< median share of a picture that is saturated
  double camera = 0;              ///< mean displacement of the whole picture per frame, share of its size
  std::vector<std::size_t> cuts;  ///< rows that begin another scene, 0-based, ascending
};

/// Features that distinguish the outline of a flame from other objects. Shares are of rows with an outline.
struct OutlineFacts {
  std::size_t rows = 0;            ///< number of rows from the first outline to the last
  std::size_t absent = 0;          ///< number of rows among `rows` without an outline, repeated frames excluded
  std::size_t blown = 0;           ///< number of absent rows for which the flame was blown out: see excuse_absence()
  std::size_t seen_from = 0;       ///< index of the first row with an outline
  std::size_t still = 0;           ///< number of rows before `seen_from` in which the object stands motionless
  std::size_t other_before = 0;    ///< number of rows before `seen_from`, if most show another object; else 0
  std::size_t other_after = 0;     ///< number of rows after the last outline, if most show another object; else 0
  bool fades_out = false;          ///< the object dims before it disappears, as in a fade to black
  double lost = 0;                 ///< share of the clip's rows without a frame, filled or not
  double repeated = 0;             ///< share of the clip's rows whose frame repeats the previous one
  std::size_t frozen = 0;          ///< number of repeated rows in stretches in which the film stands still
  double jumps = 0;                ///< share of row steps in which base or height change too much for a flame
  std::array<double, 4> border{};  ///< share of rows that reach the picture's left, upper, right and lower border
  double movement = 0;             ///< root-mean-square motion of the shape relative to its base, over median height
  double edge_noise = 0;           ///< random displacement of the outline's stiller points, standard deviation, px
  double wander = 0;               ///< motion of the base over motion of the shape relative to it
  double steadiness = 0;           ///< tip's motion / (tip's + base's motion), in sampled frames; 1: tip only
  int stands = 1;                  ///< number of consecutive rows that show each frame of the film
  double taper = 0;                ///< median reduction of the width from the middle to near the tip
  double lean = 0;                 ///< median inclination from upright, degrees: 90 is horizontal
  double width = 0;                ///< median of the maximum width across the axis, over height
  bool burns = true;               ///< the object is lit and changes shape; false: none such was found
  double light = 0;                ///< luma of the object divided by that of the picture's brightest points
  double contrast = 255;           ///< brightness of the object minus that of its surroundings, levels of 255
  double clipped = 0;              ///< share of the object that is saturated in every channel
  double height = 0;               ///< median height, pixels
  FilmFacts film;
};

/// Figures and verdict of a capture.
struct CaptureReport {
  std::size_t frames = 0;             ///< number of rows, lost frames included
  std::size_t first_frame = 1;        ///< number of row 0 in the film, for the reason
  std::size_t tracked = 0;            ///< number of rows with an outline of their own
  std::size_t duplicates = 0;         ///< number of frames that repeat the previous one
  std::size_t filled = 0;             ///< number of rows interpolated between their neighbours
  std::vector<DroppedFrame> dropped;  ///< rows without an outline
  double rate_hz = 0;
  int points = 0;
  double threshold = 0;  ///< segmentation threshold, brightness from 0 black to 255 white
  PixelChannel channel = PixelChannel::kLuma;
  Histogram histogram{};  ///< histogram of brightness, 0 black to 255 white
  int width = 0;          ///< picture width, pixels
  int height = 0;
  double residual = 0;                ///< mean root-mean-square distance of edge points from the curve, pixels
  bool knots_placed = false;          ///< the knots are not uniform
  std::vector<double> knots;          ///< the full knot vector
  bool underside = false;             ///< the outline includes the underside (attribute `underside`)
  int flames = 0;                     ///< number of flames; 0 where any moving or a dark object was requested
  std::optional<std::size_t> out_at;  ///< row from which on the flame stays extinguished
  OutlineFacts facts;                 ///< features from which the verdict is derived
  double likely_flame = 1;            ///< probability that a person would call the object a flame; 1 where flames is 0
  double likely_right = 0;            ///< probability that its outline is correct and fit for learning
  bool usable = false;                ///< whether the outline can be learned from
  std::string reason;                 ///< reason of the verdict, and if unusable what to film instead: one sentence
  std::vector<std::string> warnings;  ///< warnings for the author of the film, one sentence each
};

/// A feature of the verdict, and its penalties on the log odds of a flame and of a correct outline; 0: none.
struct WeighedFact {
  std::string name;
  double value = 0;
  double against_flame = 0;
  double against_right = 0;
};

/// Returns the features of a capture; features that only flames have are left out where any object was requested.
std::vector<WeighedFact> weighed_facts(const CaptureReport& report);

/// Recomputes the verdict given that `rows` rows have no outline because the flame was blown out and relit `times`
/// times. Pictures alone cannot distinguish an extinguished flame from a flame that was not found.
void excuse_absence(CaptureReport& report, std::size_t rows, std::size_t times);

/// A recording of an outline and the report on its capture.
struct CapturedOutline {
  Recording recording;
  CaptureReport report;
};

/// Observations of the object during capture, for live display.
struct OutlineSeen {
  std::size_t frames = 0;        ///< number of rows so far, lost frames included
  bool decided = false;          ///< channel, level and position are chosen; until then all fields below are empty
  std::vector<double> polyline;  ///< x and y of 64 outline points in the last frame, pixels; empty: no outline
  Region found;                  ///< bounding box of the bright region found last, pixels
  PixelChannel channel = PixelChannel::kLuma;
  double threshold = 0;  ///< segmentation threshold, brightness from 0 black to 255 white
  double clipped = 0;    ///< share of the object that is saturated in every channel
  int flames = 0;        ///< number of flames; 0 where any moving or a dark object was requested
};

/// Captures an outline from frames that are fed in their order.
class OutlineCapture {
 public:
  /// Precondition: options.points >= 4 and options.rate_hz > 0.
  explicit OutlineCapture(OutlineCaptureOptions options);
  OutlineCapture(OutlineCapture&&) noexcept;
  OutlineCapture& operator=(OutlineCapture&&) noexcept;
  ~OutlineCapture();

  /// Copies a picture from anywhere in the clip to the sample on which the first decisions are based, since these hold
  /// for the whole clip. Without effect after them. Precondition: the picture has the size and layout of the frames.
  void glimpse(const Picture& picture);

  /// Takes the next frame; it is borrowed for the call.
  /// Errors: a frame whose size differs from the first one's, a region outside the picture, a channel that the picture
  /// lacks, fewer flames than `flame`; where no flame is searched for, no object that stands out in the first frames.
  Result<void> feed(const Picture& picture);

  /// Records that the clip lost `count` frames here.
  void lost(int count = 1);

  /// Returns the film's properties so far.
  FilmFacts film() const;

  /// Returns the observations from the frames so far.
  OutlineSeen seen() const;

  /// Ends the clip. Returns the recording: outputs p0.x, p0.y, … and motion base.x, base.y in pixels, flag `filled`,
  /// one row per frame, missing rows NaN. Errors: fewer than 10 frames with an outline, with the reason.
  Result<CapturedOutline> finish();

 private:
  class Stage;
  std::unique_ptr<Stage> stage_;
};

}  // namespace wisp
