#pragma once
// Record of a model's making: source recordings, recipe, scales, and quality.
//
// Programs may depend on the typed fields. `recipe` and `figures` are for people: programs read only kCandleFigures.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wisp {

/// Verdict on whether a model may be used, with the reason.
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

/// A named figure of the model's quality.
struct Figure {
  std::string name;
  double value = 0;

  bool operator==(const Figure&) const = default;
};

/// Scale of one of the model's inputs in the training recordings.
struct InputTraining {
  double scale = 1;    ///< value of the recording's channel that is 1 in the model; > 0
  double one_rms = 0;  ///< RMS of the sound, full scale 1, at the channel's value 1; 0: unknown, or no sound

  bool operator==(const InputTraining&) const = default;
};

/// Settings by which recorded motion was cut into segments.
struct MotionTraining {
  std::string event;             ///< event in the syntax of parse_event(), such as "zero:forward_speed"
  double min_seconds = 0;        ///< shortest segment; ≥ 0
  double debounce = 0;           ///< minimum excursion around an event, in the signal's standard deviations; ≥ 0
  std::int32_t smooth_rows = 0;  ///< number of rows over which velocities are estimated; 0: no smoothing

  bool operator==(const MotionTraining&) const = default;
};

/// Origin of the rule of extinction.
enum class Origin : std::uint8_t {
  kDefault,  ///< default rule: no data to learn a rule from
  kGiven,    ///< set by the recipe
  kLearned,  ///< learned from the recordings
};

/// Data from which the rule of extinction was learned, and its success on them.
struct ExtinctionTraining {
  Origin origin = Origin::kDefault;
  std::uint32_t deaths = 0;      ///< number of recorded extinctions
  std::uint32_t died = 0;        ///< number of recorded extinctions that the rule reproduces
  std::uint32_t gusts = 0;       ///< number of recorded gusts that were survived
  std::uint32_t spared = 0;      ///< number of survived gusts in which the rule extinguishes nothing
  double vanishing_seconds = 0;  ///< time for which an extinguished flame stays visible to the camera

  bool operator==(const ExtinctionTraining&) const = default;
};

/// Preprocessing of the training recordings, and of every recording on which the model is judged.
struct Preparation {
  bool detrend = false;    ///< remove a linear trend from every channel; means stay
  double highpass_hz = 0;  ///< ≥ 0; 0: none
  double lowpass_hz = 0;   ///< ≥ 0; 0: none
  double resample_hz = 0;  ///< ≥ 0; 0: none

  bool operator==(const Preparation&) const = default;
};

/// Names of the figures that describe the filmed candle, if the film shows it: width in mean flame heights, and red,
/// green and blue, 0 to 255, as lit in the film.
inline constexpr std::array<const char*, 4> kCandleFigures{"candle.width", "candle.red", "candle.green", "candle.blue"};

/// Record of how the model was made.
struct Training {
  std::string program;               ///< name and version of the program that wrote it
  std::vector<std::string> sources;  ///< file names of all recordings, those of gusts included
  std::vector<Note> recipe;          ///< settings, given or chosen
  std::vector<Figure> figures;       ///< finite figures
  Usable usable;
  std::vector<InputTraining> inputs;  ///< one per input of the model; empty: the model was not learned from recordings
  std::vector<double> residual_sd;    ///< one-step residual standard deviation per output; chains: empty
  std::optional<bool> underside;      ///< whether outlines include the flame's underside; none: unknown or mixed
  Preparation preparation{};
  bool own_levels = false;                       ///< every recording was centred on its own means
  std::optional<MotionTraining> motion;          ///< for chains
  std::optional<ExtinctionTraining> extinction;  ///< present if the model has a rule of extinction
  std::int64_t multiply_adds_per_frame = 0;      ///< number of nonzero coefficients; 0: not counted
  std::int64_t operations_per_frame = 0;         ///< all arithmetic; 0: not counted

  bool operator==(const Training&) const = default;
};

}  // namespace wisp
