#pragma once
// How a model was made: what it was learned from, by which recipe, on which scales, and how good it is.
//
// Behaviour may depend on the typed fields. `recipe` and `figures` are for people: nothing reads them back.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wisp {

/// Whether a model may be used, and why not (or why so).
struct Usable {
  bool verdict = false;
  std::string reason;

  bool operator==(const Usable&) const = default;
};

/// A setting of the recipe, as text.
struct Note {
  std::string name;
  std::string value;

  bool operator==(const Note&) const = default;
};

/// A named figure of how good the model is.
struct Figure {
  std::string name;
  double value = 0;

  bool operator==(const Figure&) const = default;
};

/// What one of the model's inputs was in the recordings that it was learned from.
struct InputTraining {
  double scale = 1;    ///< value of the recording's channel that is 1 in the model; > 0
  double one_rms = 0;  ///< RMS of the sound, full scale 1, where the recording's channel is 1; 0: unknown, or no sound

  bool operator==(const InputTraining&) const = default;
};

/// How recorded motion was cut into segments.
struct MotionTraining {
  std::string event;             ///< as parse_event() reads it, such as "zero:forward_speed"
  double min_seconds = 0;        ///< shortest segment; ≥ 0
  double debounce = 0;           ///< standard deviations; ≥ 0
  std::int32_t smooth_rows = 0;  ///< rows that velocities are taken over; 0: no smoothing

  bool operator==(const MotionTraining&) const = default;
};

/// Where a rule or a duration comes from.
enum class Origin : std::uint8_t {
  kDefault,  ///< nothing was there to learn it from
  kGiven,    ///< by the recipe
  kLearned,  ///< from the recordings
};

/// What the rule of extinction was learned from, and how often it is right there.
struct ExtinctionTraining {
  Origin origin = Origin::kDefault;
  std::uint32_t deaths = 0;      ///< recorded extinctions,
  std::uint32_t died = 0;        ///< and those of them that the rule reproduces
  std::uint32_t gusts = 0;       ///< recorded gusts that were survived,
  std::uint32_t spared = 0;      ///< and those of them that the rule survives too
  double vanishing_seconds = 0;  ///< for which a camera sees a flame that has gone out

  bool operator==(const ExtinctionTraining&) const = default;
};

/// What was done to the recordings before learning, and is done to every recording that the model is judged on.
struct Preparation {
  bool detrend = false;    ///< a straight line is taken off every channel; means stay
  double highpass_hz = 0;  ///< ≥ 0; 0: none
  double lowpass_hz = 0;
  double resample_hz = 0;

  bool operator==(const Preparation&) const = default;
};

/// Figures of a flame's own candle, where the film showed one: its width in mean heights of the flame, and its red,
/// green and blue, 0 to 255, as it was lit.
inline constexpr std::array<const char*, 4> kCandleFigures{"candle.width", "candle.red", "candle.green", "candle.blue"};

/// How the model was made.
struct Training {
  std::string program;               ///< name and version of what wrote it
  std::vector<std::string> sources;  ///< file names of all recordings, gusts included
  std::vector<Note> recipe;          ///< settings, given or decided
  std::vector<Figure> figures;       ///< finite
  Usable usable;
  std::vector<InputTraining> inputs;  ///< one an input of the model; empty: it was not learned from recordings
  std::vector<double> residual_sd;    ///< of every output, one step ahead; empty where the dynamics are no regression
  std::optional<bool> underside;      ///< outlines: whether they run on along the flame's underside; none: mixed
  Preparation preparation{};
  bool own_levels = false;                       ///< every recording was taken about its own means
  std::optional<MotionTraining> motion;          ///< chains: how motion was cut
  std::optional<ExtinctionTraining> extinction;  ///< where there is a rule
  std::int64_t multiply_adds_per_frame = 0;      ///< by the paper's count; 0: not counted
  std::int64_t operations_per_frame = 0;         ///< all arithmetic; 0: not counted

  bool operator==(const Training&) const = default;
};

}  // namespace wisp
