#pragma once
// From frames and sound that come from anywhere, a file, a camera, a browser, to a recording: of an outline and wind,
// or of something light that is dropped before a plain wall. The wall is the median of the film: what is to be seen of
// a fall can only be decided when the film is over, so small pictures of all frames are kept until then.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/capture/vision/image.hpp"
#include "wisp/capture/vision/outline_capture.hpp"
#include "wisp/capture/vision/picture.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp {

class ClipEar;

namespace fall {
struct Fall;
}

/// Frames first to last, 1-based and inclusive.
struct FrameRange {
  std::int64_t first = 1;
  std::int64_t last = 1;
};

/// What is made of the sound, and the name of the channel that holds it. Names differ, so that a model that was
/// learned from one is never driven by another.
enum class WindMeasure {
  kSpeed,  ///< "wind": proportional to wind speed, 0 where nothing is heard, held back under other sounds
  kHeard,  ///< "wind.heard": proportional to wind speed, other sounds included
  kRms,    ///< "wind.rms": the paper's plain root mean square, less the background's; full scale 1
};

/// The channel's name.
std::string wind_channel_name(WindMeasure measure);

/// A frame's value.
double wind_value(const WindFrame& frame, WindMeasure measure);

/// What was heard in a clip.
struct ClipWind {
  std::vector<WindFrame> frames;  ///< one a frame of the picture; empty where nothing can be heard
  double background = 0;          ///< root mean square of the stretches without wind, full scale 1
  double one_rms = 0;             ///< of the wind's band where speed is 1, full scale 1
  double clipped_share = 0;       ///< of samples at full scale
  std::size_t uncovered = 0;      ///< frames of the picture that the sound does not reach: their wind is missing (NaN)
  std::size_t holes = 0;          ///< … and others that lie before or in holes of the sound: missing too
  std::string note;               ///< one clause for people: what was heard, or why nothing was
};

/// How a clip's outlines are parametrised, so that another clip's can be alike.
struct SharedCurve {
  std::vector<double> knots{};      ///< the full knot vector
  std::optional<bool> underside{};  ///< whether the outline runs on along the underside; none: unknown
};

/// The curve of a recording of an outline; none where the recording has no outline or its knots are not readable.
std::optional<SharedCurve> curve_of(const Recording& recording);

/// The curve that a model of an outline expects of the recordings that it is validated on.
/// Errors: the model is not of an outline.
Result<SharedCurve> curve_of(const Model& model);

/// How a clip is captured.
struct ClipCapture {
  int points = 8;                          ///< control points, 4 to 64; 8 as in the paper
  std::optional<PixelChannel> channel{};   ///< none: the one that separates best
  bool dark = false;                       ///< the thing is dark on a light ground
  int flame = 0;                           ///< which of several flames, 1 the largest; 0: whatever moves, flame or not
  Region region{};                         ///< where to look, pixels; empty: the whole picture
  std::optional<FrameRange> frames{};      ///< 1-based and inclusive; none: all. The sound is heard from the beginning
  double rate_hz = 0;                      ///< frames a second: needed for a folder of images, overrides a video's own
  WindMeasure wind = WindMeasure::kSpeed;  ///< what is made of the sound
  std::optional<SharedCurve> curve{};      ///< of another clip; overrides `points`
};

/// How a flame is captured: the largest one, by the light that it gives.
struct FlameCapture : ClipCapture {
  FlameCapture() { flame = 1; }
};

/// A recording and what happened on the way to it.
struct Captured {
  Recording recording;  ///< outputs p0.x, p0.y, …, motion base.x, base.y, and, where the clip has sound, an input
                        ///< named by the wind's measure; one row a frame, missing rows empty
  Report
      report;  ///< whether the outline can be learned from; flames, out_at, frames, tracked, duplicates, filled,
               ///< dropped, rate_hz, points, threshold, channel, wind {…}, and the series `brightness`: the histogram
};

/// Where a clip comes from.
struct ClipSource {
  std::string name{};     ///< for messages and the recording
  double rate_hz = 0;     ///< frames a second, > 0
  bool pictures = false;  ///< pictures, which have no sound: that none is heard is no defect
};

/// When a clip's frames came, where they came unevenly.
struct ClipTimes {
  std::span<const float> offsets{};  ///< a row: how far its frame was from its place, in rows; empty: all were there
  int shortened = 0;                 ///< holes that were made shorter than they were
};

/// Captures a clip whose frames and sound come one after the other, in bounded memory.
class LiveCapture {
 public:
  /// Errors: points out of range, a rate that is none.
  static Result<LiveCapture> create(const ClipSource& source, const ClipCapture& options = {});
  LiveCapture(LiveCapture&&) noexcept;
  LiveCapture& operator=(LiveCapture&&) noexcept;
  ~LiveCapture();

  /// What takes the frames, in their order; of `options.frames` only those in the range.
  OutlineCapture& picture() { return picture_; }

  /// Takes the next block of interleaved samples, full scale ±1, which begins `begin` seconds after the clip's first
  /// frame (not the range's), or before it, negative. The first one says what the sound is.
  /// Errors: sound that cannot be used.
  Result<void> hear(const SoundFormat& format, double begin, std::span<const float> samples);

  /// Ends the clip; outlines of frames that were not in their places are interpolated there.
  /// Errors: as OutlineCapture, and sound that is shorter than a frame.
  Result<Captured> finish(const ClipTimes& times = {});

 private:
  LiveCapture(ClipSource source, const ClipCapture& options);
  Result<ClipWind> wind_of(std::size_t rows) const;

  ClipSource source_;
  WindMeasure measure_;
  std::size_t skipped_;  // frames before the range
  OutlineCapture picture_;
  std::unique_ptr<ClipEar> ear_;
};

/// How falls are captured.
struct FallOptions {
  double height_metres = 0;            ///< how much of the wall the picture's height shows, 0.01 to 100; 0: not known,
                                       ///< 1 is taken
  Region region{};                     ///< where to look, pixels; empty: the whole picture
  std::optional<FrameRange> frames{};  ///< of a file: 1-based and inclusive; none: all
  double rate_hz = 0;                  ///< of a file: frames a second, needed for a folder of images, overrides a
                                       ///< video's own: a film in slow motion has the rate that it was filmed at
  std::size_t max_bytes = 384u << 20;  ///< of small pictures that are kept, one byte a pixel: about 6900 frames of a
                                       ///< wide film
};

/// What is seen while a film comes in, for whoever watches.
struct FallSeen {
  std::size_t frames = 0;      ///< rows so far, lost frames included
  std::size_t max_frames = 0;  ///< that fit; 0 before the first
  Region moving{};             ///< box of what moved since the frame before, pixels; empty: nothing
};

/// Captures falls from frames that are fed in their order.
class FallCapture {
 public:
  /// Errors: a rate that is none, a height out of range.
  static Result<FallCapture> create(const ClipSource& source, const FallOptions& options = {});

  /// Takes in the next frame; it is borrowed for the call.
  /// Errors: a frame of another size than the first, a region outside the picture, more frames than fit.
  Result<void> feed(const Picture& picture);

  /// Notes that the film lost `count` frames here.
  void lost(int count = 1);

  /// What the frames so far have shown.
  FallSeen seen() const;

  /// Ends the film. Returns the recording: outputs pos.x, pos.y (0: a picture is flat), pos.z in metres, z up, from the
  /// middle of the picture's lower border; where the thing is long enough to tell how it lies, q.w, q.x, q.y, q.z: its
  /// long axis, the body's second, and its normal, the third, lie in the picture. Flag `filled`. One episode a fall,
  /// one row a frame, none missing.
  /// Errors: no fall, and why: nothing moves, everything moves, or only what touches the picture's edge does.
  Result<Captured> finish();

 private:
  FallCapture(ClipSource source, const FallOptions& options);
  std::vector<std::uint8_t> reduced(const Picture& picture) const;
  double metres_per_pixel() const;
  Recording recorded(const std::vector<fall::Fall>& falls, bool tilt) const;

  ClipSource source_;
  FallOptions options_;
  Region frame_{};   // of the first picture; empty: none yet
  Region region_{};  // that is looked at
  int step_ = 1;     // pixels that make one of the small picture, either way
  int width_ = 0;    // of the small pictures
  int height_ = 0;
  std::vector<std::vector<std::uint8_t>> frames_;  // empty: lost
  Region moving_{};
};

}  // namespace wisp
