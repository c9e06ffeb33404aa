#include "wisp/capture/capture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "capture/capture_clip.hpp"
#include "capture/clip/clip_ear.hpp"
#include "capture/clip/views/view_join.hpp"
#include "capture/vision/film_look.hpp"
#include "record/number_text.hpp"
#include "record/verdict.hpp"
#include "wisp/capture/media/sound.hpp"

namespace wisp {
namespace {

ClipTimes times_of(const VideoReader& reader, const std::optional<FrameRange>& frames) {
  ClipTimes times = reader.times();
  const auto skipped = static_cast<std::size_t>(frames ? frames->first - 1 : 0);
  times.offsets = times.offsets.subspan(std::min(skipped, times.offsets.size()));
  return times;
}

// Returns an error if a range ends after the last frame of a video. A folder of images is checked when it is opened.
// Lost frames at the range's end have times but no rows, so the longer of both counts.
Result<void> check_frames(const std::filesystem::path& path, const std::optional<FrameRange>& frames,
                          const VideoReader& reader, std::size_t rows) {
  const std::size_t read = std::max(rows, times_of(reader, frames).offsets.size());
  const auto last = frames ? frames->first - 1 + static_cast<std::int64_t>(read) : 0;
  if (!frames || reader.info().images || last >= frames->last) return {};
  return Error{path.string() + ": frames " + std::to_string(frames->first) + ":" + std::to_string(frames->last) +
               " reach beyond its end, frame " + std::to_string(last)};
}

// Passes a clip's sound to `hear`, `speed` times as fast. Returns the sound's properties; none without a sound track.
template <class Hear>
Result<std::optional<SoundInfo>> hear_sound(const std::filesystem::path& path, double speed, Hear hear) {
  Result<void> heard;
  auto info = stream_sound(path, [&](const SoundInfo& sound, std::span<const float> samples) {
    heard =
        hear(SoundFormat{.rate_hz = speed * sound.rate_hz, .channels = sound.channels}, sound.begin / speed, samples);
    return static_cast<bool>(heard);
  });
  if (!heard) return heard.error();
  return info;
}

// Mean linear light of a region: black 0, white 1.
double light_of(const Picture& picture, const Region& region, std::vector<std::uint8_t>& pixels) {
  pixels.resize(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
  extract_channel(picture, PixelChannel::kLuma, region, pixels.data());
  std::array<std::size_t, 256> count{};
  for (const std::uint8_t pixel : pixels) ++count[pixel];
  double sum = 0;
  for (int stored = 0; stored < 256; ++stored) {
    const double value = brightness(picture, PixelChannel::kLuma, stored) / 255;
    sum += static_cast<double>(count[static_cast<std::size_t>(stored)]) * linear_light(std::max(0.0, value));
  }
  return sum / static_cast<double>(pixels.size());
}

// Captures a clip rotated by `turn` quarter turns clockwise. `film` receives the film's properties.
Result<Captured> look_at(const std::filesystem::path& path, const ClipCapture& options, int turn, FilmFacts& film,
                         const Progress& progress) {
  auto reader = VideoReader::open(path, {.rate_hz = options.rate_hz, .frames = options.frames, .turn = turn});
  if (!reader) return reader.error();
  const VideoInfo& info = reader->info();
  auto live = LiveCapture::create({.name = path.string(), .rate_hz = info.rate_hz, .pictures = info.images}, options);
  if (!live) return live.error();
  if (auto read = read_into(*reader, live->picture(), options.frames, progress); !read) return read.error();
  film = live->picture().film();
  if (!info.images) {
    const auto heard = hear_sound(path, info.speed, [&](const auto& format, double begin, const auto& samples) {
      return live->hear(format, begin - info.begin / info.speed, samples);
    });
    if (!heard) return heard.error();
  }
  const ClipTimes times = times_of(*reader, options.frames);
  auto captured = live->finish(times);
  if (!captured) return captured;
  if (auto ok = check_frames(path, options.frames, *reader, captured->recording.rows()); !ok) return ok.error();
  if (options.frames) captured->recording.attributes.push_back({"first_frame", std::to_string(options.frames->first)});
  for (std::string& warning : reader->warnings()) captured->report.warnings.push_back(std::move(warning));
  return captured;
}

// Returns the longest run of rows without a break, as frame numbers; none if below 1.5 s or above 95 % of all rows.
template <class Breaks>
std::optional<FrameRange> longest_part(const Recording& recording, std::int64_t first, Breaks breaks) {
  std::size_t begin = 0, best = 0, best_begin = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (breaks(row)) begin = row + 1;
    if (row + 1 - begin > best) best = row + 1 - begin, best_begin = begin;
  }
  const auto rows = static_cast<double>(best);
  if (rows < 1.5 * recording.rate_hz || rows > 0.95 * static_cast<double>(recording.rows())) return {};
  return FrameRange{first + static_cast<std::int64_t>(best_begin),
                    first + static_cast<std::int64_t>(best_begin + best) - 1};
}

// Remedy for a refused film, found by capturing it again with other frames, a rotation or `flame` 0. `reason` replaces
// the reason of the refusal, `advice` is appended to it; both are empty without a remedy.
struct Cure {
  std::string reason;
  std::string advice;
};

Cure cure_of(const std::filesystem::path& path, const ClipCapture& options, const Result<Captured>& refused,
             const FilmFacts& film, const Progress& progress) {
  constexpr const char* kTurned[] = {"", "the film lies on its side; rotate it by 90 degrees clockwise",
                                     "the film is upside down; rotate it by 180 degrees",
                                     "the film lies on its side; rotate it by 90 degrees counter-clockwise"};
  if (options.flame == 0 || options.dark || film_reason(film)) return {};
  const auto usable = [&](const ClipCapture& other, int turn = 0) {
    FilmFacts ignored;
    const auto captured = look_at(path, other, turn, ignored, progress);
    // A blurred glow may be usable in any rotation, but the probability that its outline is right rarely exceeds 0.8.
    return captured && captured->report.verdict->usable &&
           (turn == 0 || std::get<double>(captured->report.find("likely.right")->value) > 0.8);
  };
  const std::int64_t first = options.frames ? options.frames->first : 1;
  if (refused) {
    const auto& channels = refused->recording.channels;
    const auto cut = [&](std::int64_t frame) {
      return std::binary_search(film.cuts.begin(), film.cuts.end(), static_cast<std::size_t>(frame - first));
    };
    ClipCapture part = options;
    part.frames = longest_part(refused->recording, first, [&](std::size_t row) {
      const auto missing = [&](const Channel& channel) { return std::isnan(channel.samples[row]); };
      return cut(first + static_cast<std::int64_t>(row)) || std::any_of(channels.begin(), channels.end(), missing);
    });
    if (part.frames && usable(part)) {
      const auto [begin, end] = *part.frames;
      const std::string frames = " --frames " + std::to_string(begin) + ":" + std::to_string(end);
      if (!cut(begin - 1) && !cut(end + 1)) return {"", "; a part of it is usable:" + frames};
      return {"the film is cut; give one scene of it:" + frames, ""};
    }
  }
  // A remedy is tried on at most the first 120 frames before the whole film.
  const std::int64_t few = std::min<std::int64_t>(120, static_cast<std::int64_t>(film.pictures));
  const auto cures = [&](int flame, int turn) {
    ClipCapture other = options;
    other.flame = flame;
    other.frames = {first, first - 1 + few};
    if (!usable(other, turn)) return false;
    other.frames = options.frames;
    return usable(other, turn);
  };
  for (const int turn : {2, 1, 3}) {
    if (cures(options.flame, turn)) return {kTurned[turn], ""};
  }
  return {"", cures(0, 0) ? "; something that moves can be followed, flame or not: --flame 0" : ""};
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code none;
  if (!is_regular_file(a, none) || !is_regular_file(b, none)) return equivalent(a, b, none);
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return first && second && std::equal(Bytes(first), Bytes(), Bytes(second), Bytes());
}

}  // namespace

Result<Captured> capture(const std::filesystem::path& path, const ClipCapture& options, const Progress& progress) {
  FilmFacts film;
  auto captured = look_at(path, options, 0, film, progress);
  if (captured ? captured->report.verdict->usable : captured.error().message.find("no flame") == std::string::npos)
    return captured;
  bool stopped = false;
  const Progress watched = [&](std::string_view stage, double share) {
    stopped = stopped || !go_on(progress, stage, share);
    return !stopped;
  };
  const Cure cure = cure_of(path, options, captured, film, watched);
  if (stopped) return Error{std::string(kStopped)};
  if (!captured) {
    return Error{cure.reason.empty() ? captured.error().message + cure.advice : path.string() + ": " + cure.reason};
  }
  std::string& reason = captured->report.verdict->reason;
  reason = cure.reason.empty() ? reason + cure.advice : cure.reason;
  set_verdict(captured->recording, false, reason);
  return captured;
}

Result<ClipWind> hear_wind(const std::filesystem::path& path, double rate_hz, std::optional<std::size_t> frames) {
  std::optional<ClipEar> ear;
  double seconds = 0;
  const auto unusable = [&](const Error& why) {
    return Error{path.string() + ": its sound cannot be used: " + why.message};
  };
  const auto film = frames ? VideoReader::open(path, {.rate_hz = rate_hz, .frames = {}}) : Error{"a sound alone"};
  const double speed = film ? film->info().speed : 1;
  const auto heard = hear_sound(path, speed, [&](const SoundFormat& format, double begin, const auto& samples) {
    if (!ear) {
      auto made = ClipEar::create(format, rate_hz);
      if (!made) return Result<void>(unusable(made.error()));
      ear.emplace(std::move(*made));
    }
    ear->feed(begin, samples);
    seconds = begin + static_cast<double>(samples.size()) / format.channels / format.rate_hz;
    return Result<void>();
  });
  if (!heard) return heard.error();
  if (!frames && *heard && (*heard)->cut) {
    return unusable(Error{"it was cut off after " + number_text(seconds, 3) + " s; copy or record it again"});
  }
  if (!ear) {
    ClipWind none;
    none.note = "not heard: the clip has no sound track";
    return none;
  }
  auto wind = ear->finish(frames.value_or(static_cast<std::size_t>(std::max(0.0, seconds * rate_hz + 1e-6))));
  if (!wind) return unusable(wind.error());
  return wind;
}

Result<Captured> capture_views(std::span<const std::filesystem::path> films, std::span<const double> azimuths,
                               ClipCapture options, const Progress& progress) {
  if (auto ok = check_azimuths(azimuths, std::vector<std::string>(films.begin(), films.end())); !ok) return ok.error();
  if (options.frames) return Error{"frames are of one film, and of several the time that all have is taken"};
  std::vector<FilmedView> views;
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < films.size(); ++k) {
    const auto again = std::find_if(films.begin(), films.begin() + static_cast<std::ptrdiff_t>(k),
                                    [&](const auto& other) { return same_file(other, films[k]); });
    if (again != films.begin() + static_cast<std::ptrdiff_t>(k))
      return Error{films[k].string() + ": is the same film as " + again->string() +
                   "; give a film of the same time from another side"};
    auto film = capture(films[k], options, progress);
    if (!film) return film.error();
    std::move(film->report.warnings.begin(), film->report.warnings.end(), std::back_inserter(warnings));
    if (!options.curve) options.curve = curve_of(film->recording);
    FilmedView view{azimuths[k], std::move(film->recording), {}, 0};
    auto reader = VideoReader::open(films[k], {.rate_hz = options.rate_hz, .frames = {}});
    if (reader && !reader->info().images && reader->next()) {  // the first frame sets info().begin
      const auto heard = hear_wind(films[k], view.recording.rate_hz, view.recording.rows());
      if (!heard) return heard.error();
      view.heard_from = -reader->info().begin / reader->info().speed;
      for (const WindFrame& frame : heard->frames) view.loudness.push_back(static_cast<double>(frame.rms));
    }
    views.push_back(std::move(view));
  }
  auto joined = join_views(views);
  if (joined) joined->report.warnings = std::move(warnings);
  return joined;
}

Result<Recording> capture_wind(const std::filesystem::path& path, double rate_hz, WindMeasure measure) {
  const auto wind = hear_wind(path, rate_hz);
  if (!wind) return wind.error();
  if (wind->frames.empty()) return Error{path.string() + ": wind " + wind->note};
  Recording recording{.source = path.string(), .rate_hz = rate_hz};
  recording.attributes.push_back({"source", path.string()});
  join_wind(*wind, measure, recording);
  return recording;
}

Result<Recording> capture_brightness(const std::filesystem::path& path, const ClipCapture& options,
                                     const Progress& progress, std::vector<std::string>* warnings) {
  auto reader = VideoReader::open(path, {.rate_hz = options.rate_hz, .frames = options.frames});
  if (!reader) return reader.error();
  const std::int64_t first = options.frames ? options.frames->first - 1 : 0;
  Channel channel{"brightness", "", Role::kOutput, {}};
  std::vector<std::uint8_t> pixels;
  for (;;) {
    const auto frame = reader->next();
    if (!frame) return frame.error();
    if (!*frame) break;
    const Picture& picture = (*frame)->picture;
    const Region region = options.region.empty() ? picture.frame() : intersection(options.region, picture.frame());
    if (region.empty())
      return Error{path.string() + ": the region lies outside its picture of " + std::to_string(picture.width) + " x " +
                   std::to_string(picture.height) + " pixels"};
    // Rows of lost frames are missing (NaN).
    channel.samples.resize(static_cast<std::size_t>((*frame)->index - first), std::nan(""));
    channel.samples.push_back(light_of(picture, region, pixels));
    const std::int64_t frames = options.frames ? options.frames->last - first : reader->info().frames;
    const double done = static_cast<double>(channel.samples.size()) / std::max(1.0, static_cast<double>(frames));
    if (!go_on(progress, "measuring", std::min(1.0, done))) return Error{std::string(kStopped)};
  }
  if (auto ok = check_frames(path, options.frames, *reader, channel.samples.size()); !ok) return ok.error();
  if (channel.samples.empty()) return Error{path.string() + ": has no frame that can be read; give a clip that plays"};
  const double usual = mean(present(channel.samples));
  if (!(usual > 0)) return Error{path.string() + ": is black throughout, there is no light to measure"};
  for (double& value : channel.samples) value /= usual;
  if (warnings) *warnings = reader->warnings();
  return Recording{.source = path.string(), .rate_hz = reader->info().rate_hz, .channels = {std::move(channel)}};
}

Result<Captured> capture_falls(const std::filesystem::path& path, const FallOptions& options,
                               const Progress& progress) {
  auto reader = VideoReader::open(path, {.rate_hz = options.rate_hz, .frames = options.frames});
  if (!reader) return reader.error();
  auto capture = FallCapture::create({path.string(), reader->info().rate_hz, reader->info().images}, options);
  if (!capture) return capture.error();
  if (auto read = read_into(*reader, *capture, options.frames, progress); !read) return read.error();
  if (auto ok = check_frames(path, options.frames, *reader, 0); !ok) return ok.error();
  auto captured = capture->finish();
  if (!captured) return captured;
  for (std::string& warning : reader->warnings()) captured->report.warnings.push_back(std::move(warning));
  return captured;
}

}  // namespace wisp
