#pragma once
// Converts frames and sound from any source (file, camera, browser) to a recording of an outline and wind, or of the
// falls of a light object before a plain wall. The wall is estimated as the median over the whole film, so FallCapture
// stores reduced pictures of all frames until the film's end.

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

/// Frames `first` to `last`, 1-based and inclusive.
struct FrameRange {
  std::int64_t first = 1;
  std::int64_t last = 1;
};

/// Measure of the wind that is derived from sound; it also names the channel. Names differ, so that a model learned
/// from one measure is never driven by another.
enum class WindMeasure {
  kSpeed,  ///< "wind": proportional to wind speed, 0 where nothing is heard, attenuated under other sounds
  kHeard,  ///< "wind.heard": proportional to wind speed, other sounds included
  kRms,    ///< "wind.rms": the paper's plain root mean square, minus the background's; full scale 1
};

/// Returns the name of the measure's channel.
std::string wind_channel_name(WindMeasure measure);

/// Returns the frame's wind by `measure`.
double wind_value(const WindFrame& frame, WindMeasure measure);

/// The wind estimated from a clip's sound.
struct ClipWind {
  std::vector<WindFrame> frames;  ///< one per frame of the picture; empty where nothing can be heard
  double background = 0;          ///< root mean square of the sound without wind, full scale 1
  double one_rms = 0;             ///< root mean square of the wind band at speed 1, full scale 1
  double clipped_share = 0;       ///< share of samples at full scale
  std::size_t uncovered = 0;      ///< number of picture frames after the sound's end: their wind is missing (NaN)
  std::size_t holes = 0;          ///< number of picture frames before the sound or in its gaps: their wind is missing
  std::string note;               ///< a clause for the user: the share of the clip with wind, or why there is none
};

/// Parametrisation of a clip's outlines, which another clip's outlines can share.
struct SharedCurve {
  std::vector<double> knots{};      ///< the full knot vector
  std::optional<bool> underside{};  ///< whether the outline includes the underside; none: unknown
};

/// Returns the curve of a recording of an outline; none where the recording has no outline or its knots are unreadable.
std::optional<SharedCurve> curve_of(const Recording& recording);

/// Returns the curve that a model of an outline expects of the recordings on which it is validated.
/// Errors: the model has no outline.
Result<SharedCurve> curve_of(const Model& model);

/// Options of capturing a clip.
struct ClipCapture {
  int points = 8;                          ///< control points, 4 to 64; 8 as in the paper
  std::optional<PixelChannel> channel{};   ///< colour channel to segment by; none: the one that separates best
  bool dark = false;                       ///< the object is dark on a light background
  int flame = 0;                           ///< size rank of the flame to capture, 1 the largest; 0: any moving object
  Region region{};                         ///< search region, pixels; empty: the whole picture
  std::optional<FrameRange> frames{};      ///< frames to capture; none: all. Sound before them is analysed too
  double rate_hz = 0;                      ///< frames per second: needed for a folder of images, overrides a video's
  WindMeasure wind = WindMeasure::kSpeed;  ///< measure of the wind in the sound
  std::optional<SharedCurve> curve{};      ///< curve of another clip; overrides `points`
};

/// Options of capturing a clip, by default of its largest flame instead of any moving object.
struct FlameCapture : ClipCapture {
  FlameCapture() { flame = 1; }
};

/// A recording and a report on its capture. The fields are those of an outline; for falls see FallCapture::finish().
struct Captured {
  /// Outputs p0.x, p0.y, …, motion base.x, base.y, and, where the clip has sound, an input named by the wind's measure;
  /// one row per frame, missing rows NaN.
  Recording recording;
  /// Verdict whether a model can be learned from the outline; sections Frames, Outline (with the histogram as series
  /// `brightness`), Facts and Wind.
  Report report;
};

/// Name, rate and kind of a clip's source.
struct ClipSource {
  std::string name{};     ///< name for messages and the recording
  double rate_hz = 0;     ///< frames per second, > 0
  bool pictures = false;  ///< still images without sound: missing sound is no defect
};

/// Timing of a clip's unevenly spaced frames.
struct ClipTimes {
  std::span<const float> offsets{};  ///< per row: actual minus nominal time of its frame, in rows; empty: all 0
  int shortened = 0;                 ///< number of gaps that were shortened
};

/// Captures a clip whose frames and sound are fed incrementally; only outlines and wind are kept.
class LiveCapture {
 public:
  /// Errors: points out of range, an invalid rate.
  static Result<LiveCapture> create(const ClipSource& source, const ClipCapture& options = {});
  LiveCapture(LiveCapture&&) noexcept;
  LiveCapture& operator=(LiveCapture&&) noexcept;
  ~LiveCapture();

  /// Returns the outline capture, to which the frames are fed in order; if `options.frames` is given, only its frames.
  OutlineCapture& picture() { return picture_; }

  /// Takes the next block of interleaved samples, full scale ±1, which begins `begin` seconds after the clip's first
  /// frame (not the range's); negative: before it. The first block's format holds for all. Errors: an unusable format.
  Result<void> hear(const SoundFormat& format, double begin, std::span<const float> samples);

  /// Ends the clip; outlines of unevenly spaced frames are interpolated to their nominal times.
  /// Errors: those of OutlineCapture, and sound that is shorter than a frame.
  Result<Captured> finish(const ClipTimes& times = {});

 private:
  LiveCapture(ClipSource source, const ClipCapture& options);
  Result<ClipWind> wind_of(std::size_t rows) const;

  ClipSource source_;
  WindMeasure measure_;
  std::size_t skipped_;  // number of frames before the range
  OutlineCapture picture_;
  std::unique_ptr<ClipEar> ear_;
};

/// Options of capturing falls.
struct FallOptions {
  double height_metres = 0;            ///< height of wall that the picture shows, 0.01 to 100; 0: unknown, taken as 1
  Region region{};                     ///< search region, pixels; empty: the whole picture
  std::optional<FrameRange> frames{};  ///< frames of a file; none: all
  double rate_hz = 0;                  ///< frame rate of a file: needed for a folder of images, overrides a video's
                                       ///< own: slow motion needs the rate of filming
  std::size_t max_bytes = 384u << 20;  ///< bound of the stored reduced pictures, one byte per pixel: about 7000 frames
                                       ///< of a 16:9 film
};

/// Observations so far, while a film is being captured.
struct FallSeen {
  std::size_t frames = 0;      ///< number of rows so far, lost frames included
  std::size_t max_frames = 0;  ///< number of frames that fit in FallOptions::max_bytes; 0 before the first
  Region moving{};             ///< bounding box of pixels that moved since the previous frame; empty: none
};

/// Captures falls from frames that are fed in their order.
class FallCapture {
 public:
  /// Errors: an invalid rate, a height out of range.
  static Result<FallCapture> create(const ClipSource& source, const FallOptions& options = {});

  /// Takes the next frame; it is borrowed for the call.
  /// Errors: a frame whose size differs from the first one's, a region of less than 16 × 16 pixels, too many frames.
  Result<void> feed(const Picture& picture);

  /// Records that the film lost `count` frames here.
  void lost(int count = 1);

  /// Returns the observations from the frames so far.
  FallSeen seen() const;

  /// Ends the film. Returns the recording: one episode per fall, one row per frame, none missing. Outputs: pos.x, pos.y
  /// (always 0) and pos.z, in metres from the middle of the picture's lower border, z up. If the objects are elongated
  /// enough to have an orientation, also q.w, q.x, q.y, q.z: the body's second axis is the long axis, its third the
  /// normal, both in the picture plane. Flag `filled`.
  /// Errors: fewer than 16 frames; no fall, with the reason, such as: nothing moves, everything moves.
  Result<Captured> finish();

 private:
  FallCapture(ClipSource source, const FallOptions& options);
  std::vector<std::uint8_t> reduced(const Picture& picture) const;
  double metres_per_pixel() const;
  Recording recorded(const std::vector<fall::Fall>& falls, bool tilt) const;

  ClipSource source_;
  FallOptions options_;
  Region frame_{};   // region of the first picture; empty: none yet
  Region region_{};  // search region
  int step_ = 1;     // picture pixels per reduced pixel, in each direction
  int width_ = 0;    // width of the reduced pictures
  int height_ = 0;
  std::vector<std::vector<std::uint8_t>> frames_;  // empty: lost
  Region moving_{};
};

}  // namespace wisp
