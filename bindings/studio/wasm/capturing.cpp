// Capture as WebAssembly functions: pictures and sound in, a recording out.

#include <optional>
#include <span>

#include "capture/clip/frame_grid.hpp"
#include "reported.hpp"
#include "settings.hpp"
#include "wisp/capture/clip/clip_capture.hpp"

namespace wisp::studio {
namespace {

using nlohmann::json;

// State of the current capture.
struct Desk {
  std::optional<LiveCapture> capture;
  std::optional<FallCapture> falls;  // alone, or beside `capture` where the film may show either
  std::optional<FrameGrid> grid;
  std::string source;
};

Desk& desk() {
  static Desk the;
  return the;
}

Region region_of(const json& from) {
  const auto region = from.find("region");
  if (region == from.end() || !region->is_object()) return {};
  return {region->value("x", 0), region->value("y", 0), region->value("width", 0), region->value("height", 0)};
}

ClipCapture capture_options(const json& from) {
  ClipCapture options;
  options.flame = whole(from, "flame").value_or(1);
  options.points = whole(from, "points").value_or(8);
  options.dark = from.value("dark", false);
  options.channel = channel_from_name(from.value("channel", ""));
  options.region = region_of(from);
  return options;
}

// Maximum size of all stored reduced pictures: a minute of a 4:3 film at 60 frames a second takes 276 MB.
constexpr std::size_t kMaxFallBytes = 288u << 20;

FallOptions fall_options(const json& from) {
  return {.height_metres = from.value("height", 0.0), .region = region_of(from), .max_bytes = kMaxFallBytes};
}

// Passes a frame to all active captures. The search for falls beside a flame is abandoned where the film is too long.
Result<void> take_in(Desk& all, const Picture& picture, double seconds) {
  const std::int64_t before = all.grid->last();
  const int lost = static_cast<int>(all.grid->place(seconds) - before - 1);
  if (all.falls) {
    if (before >= 0) all.falls->lost(lost);
    auto fed = all.falls->feed(picture);
    if (!fed && !all.capture) return fed;
    if (!fed) all.falls.reset();
  }
  if (!all.capture) return {};
  OutlineCapture& capture = all.capture->picture();
  if (before >= 0) capture.lost(lost);
  return capture.feed(picture);
}

// Returns the recording of falls if it is usable or only falls are sought, else the outline's. Flames give none usable.
Result<Captured> finished(Desk& all) {
  const ClipTimes times{.offsets = all.grid->offsets(), .shortened = all.grid->shortened()};
  if (!all.falls) return all.capture->finish(times);
  auto falls = all.falls->finish();
  if (!all.capture || (falls && falls->report.verdict->usable)) return falls;
  return all.capture->finish(times);
}

}  // namespace
}  // namespace wisp::studio

using namespace wisp;
using namespace wisp::studio;

extern "C" {

// Begins a capture: {name, rate, pictures, looks_for, flame, points, dark, channel, region, height}. `looks_for` is
// "flame", "falls" or "either".
WISP_STUDIO(begin) int studio_begin(const char* text, std::size_t size) {
  const json settings = parsed(text, size);
  Desk& all = desk();
  all.source = settings.value("name", "camera");
  const double rate = settings.value("rate", 0.0);
  const ClipSource source{.name = all.source, .rate_hz = rate, .pictures = settings.value("pictures", false)};
  all.capture.reset();
  all.falls.reset();
  all.grid.emplace(rate);
  const std::string looks_for = settings.value("looks_for", "flame");
  if (looks_for != "flame") {
    auto falls = FallCapture::create(source, fall_options(settings));
    if (!falls) return fail(falls.error());
    all.falls.emplace(std::move(*falls));
  }
  if (looks_for == "falls") return kDone;
  auto capture = LiveCapture::create(source, capture_options(settings));
  if (!capture) return fail(capture.error());
  all.capture.emplace(std::move(*capture));
  return kDone;
}

// Takes a frame of three planes in a decoder's layout. `glimpse`: from anywhere in the clip, before the first frames.
WISP_STUDIO(frame)
int studio_frame(int layout, int width, int height, const std::uint8_t* first, int first_stride,
                 const std::uint8_t* second, int second_stride, const std::uint8_t* third, int third_stride, int step,
                 int shift_x, int shift_y, int full_range, int bt709, double seconds, int glimpse) {
  Desk& all = desk();
  if (!all.capture && !all.falls) return fail({"no capture has begun"});
  const Picture picture{.layout = static_cast<PictureLayout>(layout),
                        .width = width,
                        .height = height,
                        .planes = {PicturePlane{first, first_stride, layout == 2 ? step : 1},
                                   PicturePlane{second, second_stride, step}, PicturePlane{third, third_stride, step}},
                        .chroma_shift_x = shift_x,
                        .chroma_shift_y = shift_y,
                        .full_range = full_range != 0,
                        .bt709 = bt709 != 0};
  if (glimpse != 0) {
    if (all.capture) all.capture->picture().glimpse(picture);
    return kDone;
  }
  const auto fed = take_in(all, picture, seconds);
  return fed ? kDone : fail(fed.error());
}

// Takes interleaved samples that begin `begin` seconds after the first frame. Ignored where only falls are looked for.
WISP_STUDIO(sound)
int studio_sound(const float* samples, std::size_t count, int channels, double rate, double begin) {
  Desk& all = desk();
  if (!all.capture) return all.falls ? kDone : fail({"no capture has begun"});
  const auto heard = all.capture->hear({.rate_hz = rate, .channels = channels}, begin, {samples, count});
  return heard ? kDone : fail(heard.error());
}

// Returns {frames, decided, channel, threshold, clipped, flames, box}; numbers: the outline's points. For falls only
// {frames, decided: false, moving}, with the box of the motion.
WISP_STUDIO(seen) int studio_seen() {
  Desk& all = desk();
  if (all.falls && !all.capture) {
    const FallSeen seen = all.falls->seen();
    json text{{"frames", seen.frames}, {"decided", false}};
    if (!seen.moving.empty()) text["moving"] = {seen.moving.x, seen.moving.y, seen.moving.width, seen.moving.height};
    fresh().text = text.dump();
    return kDone;
  }
  if (!all.capture) return fail({"no capture has begun"});
  OutlineSeen seen = all.capture->picture().seen();
  Answer& out = fresh();
  json text{{"frames", seen.frames}, {"decided", seen.decided}};
  if (seen.decided) {
    text["channel"] = channel_name(seen.channel);
    text["threshold"] = seen.threshold;
    text["clipped"] = seen.clipped;
    text["flames"] = seen.flames;
    text["box"] = {seen.found.x, seen.found.y, seen.found.width, seen.found.height};
  }
  out.text = text.dump();
  out.numbers = std::move(seen.polyline);
  return kDone;
}

// Ends the capture and returns the recording.
WISP_STUDIO(finish) int studio_finish() {
  Desk& all = desk();
  if (!all.capture && !all.falls) return fail({"no capture has begun"});
  auto captured = finished(all);
  const std::vector<std::string> odd = all.grid->warnings(all.source);
  all.capture.reset();
  all.falls.reset();
  if (!captured) return fail(captured.error());
  for (const std::string& warning : odd) captured->report.warnings.push_back(warning);
  return hand_over(captured->recording, captured->report);
}
}
