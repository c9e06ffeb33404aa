// The front door as functions of WebAssembly: what goes in is JSON and memory, what comes out is the answer.

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "answer.hpp"
#include "capture/clip/frame_grid.hpp"
#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

#define WISP_STUDIO(name) __attribute__((export_name("studio_" #name)))

// The host is told of progress, and answers whether to go on.
extern "C" __attribute__((import_module("env"), import_name("studio_progress"))) int studio_progress(const char* stage,
                                                                                                     std::size_t size,
                                                                                                     double share);

namespace wisp::studio {
namespace {

using nlohmann::json;

// What is being captured, and what has been gathered to learn from.
struct Desk {
  std::optional<LiveCapture> capture;
  std::optional<FallCapture> falls;  // beside the other, where it is not known which of the two a film shows
  std::optional<FrameGrid> grid;
  std::string source;
  std::vector<Recording> recordings;
};

Desk& desk() {
  static Desk the;
  return the;
}

Progress progress() {
  return [](std::string_view stage, double share) { return studio_progress(stage.data(), stage.size(), share) != 0; };
}

json parsed(const char* text, std::size_t size) { return json::parse(text, text + size, nullptr, false); }

std::optional<int> whole(const json& from, const char* name) {
  const auto found = from.find(name);
  if (found == from.end() || !found->is_number()) return std::nullopt;
  return found->get<int>();
}

std::vector<std::string> names(const json& from, const char* name) {
  const auto found = from.find(name);
  return found == from.end() || !found->is_array() ? std::vector<std::string>()
                                                   : found->get<std::vector<std::string>>();
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

// Of small pictures, one byte a pixel: half a minute of a wide film at 60 frames a second takes 100 MB.
constexpr std::size_t kMaxFallBytes = 192u << 20;

FallOptions fall_options(const json& from) {
  return {.height_metres = from.value("height", 0.0), .region = region_of(from), .max_bytes = kMaxFallBytes};
}

// The report as the program's --json has it, and, for pictures, its series.
json report_json(const Report& report) {
  json out = json::parse(to_json(report, -1), nullptr, false);
  json curves = json::array();
  for (const ReportSection& section : report.sections) {
    for (const ReportSeries& series : section.series) {
      curves.push_back({{"id", series.id},
                        {"label", series.label},
                        {"x_label", series.x_label},
                        {"y_label", series.y_label},
                        {"x", series.x},
                        {"y", series.y}});
    }
  }
  return json{{"report", std::move(out)}, {"curves", std::move(curves)}, {"text", to_text(report)}};
}

const char* role_name(Role role) {
  return role == Role::kInput ? "input" : role == Role::kOutput ? "output" : "motion";
}

// A recording: its CSV as bytes, its channels' samples as numbers, one channel after the other.
int hand_over(const Recording& recording, const Report& report) {
  Answer& out = fresh();
  const std::string csv = csv_text(recording);
  const auto bytes = std::as_bytes(std::span(csv));
  out.bytes.assign(bytes.begin(), bytes.end());
  json series = json::array();
  for (const Channel& channel : recording.channels) {
    series.push_back({{"name", channel.name}, {"unit", channel.unit}, {"role", role_name(channel.role)}});
    out.numbers.insert(out.numbers.end(), channel.samples.begin(), channel.samples.end());
  }
  json text = report_json(report);
  text["rate"] = recording.rate_hz;
  text["rows"] = recording.rows();
  json begins = json::array();
  for (const Episode& episode : episodes(recording)) begins.push_back(episode.begin);
  text["episodes"] = std::move(begins);
  text["series"] = std::move(series);
  out.text = text.dump();
  return kDone;
}

template <class SomeRecipe>
SomeRecipe named(const json& from, SomeRecipe recipe) {
  recipe.name = from.value("name", recipe.name);
  recipe.seed = from.value("seed", recipe.seed);
  return recipe;
}

template <class SomeRecipe>
SomeRecipe outline_recipe(const json& from, SomeRecipe defaults) {
  SomeRecipe recipe = named(from, std::move(defaults));
  if (const auto order = whole(from, "order")) recipe.order = *order;
  if (const auto knots = whole(from, "curve")) recipe.input_curve = *knots;
  const std::string noise = from.value("noise", "");
  if (noise == "independent") recipe.noise = OutlineNoise::kIndependent;
  if (noise == "residual") recipe.noise = OutlineNoise::kResidual;
  if (noise == "matched") recipe.noise = OutlineNoise::kMatched;
  if (noise == "drawn") recipe.noise = OutlineNoise::kDrawn;
  recipe.light = from.value("light", false);
  return recipe;
}

template <class SomeRecipe>
SomeRecipe chain_recipe(const json& from, SomeRecipe defaults) {
  SomeRecipe recipe = named(from, std::move(defaults));
  if (const auto rows = whole(from, "smooth")) recipe.smooth_rows = *rows;
  return recipe;
}

Recipe recipe_of(const json& from) {
  const std::string kind = from.value("kind", "flame");
  if (kind == "arx") {
    ArxRecipe recipe{.inputs = names(from, "inputs"), .outputs = names(from, "outputs"), .responses = true};
    recipe.name = from.value("name", "table");
    if (const auto order = whole(from, "order"); order && *order > 0) recipe.na = recipe.nb = *order;
    if (const auto nb = whole(from, "nb")) recipe.nb = *nb;
    recipe.nk.reset();
    if (const auto nk = whole(from, "nk")) recipe.nk = *nk;
    return recipe;
  }
  if (kind == "chain") return chain_recipe(from, ChainRecipe{});
  if (kind == "leaf") return chain_recipe(from, LeafRecipe{});
  if (kind == "outline") return outline_recipe(from, OutlineRecipe{});
  return outline_recipe(from, FlameRecipe{});
}

Result<Recording> read_recording(const char* bytes, std::size_t size, const json& settings) {
  std::istringstream stream(std::string(bytes, size));
  CsvOptions options{.inputs = names(settings, "inputs"), .outputs = names(settings, "outputs")};
  options.rate_hz = settings.value("rate", 0.0);
  return read_csv(stream, settings.value("name", "recording.csv"), options);
}

// Takes the frame into whatever captures. What looks for falls beside a flame gives up where the film is too long.
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

// A film of falls is told by them: of a film of a flame nothing usable comes out as falls.
Result<Captured> finished(Desk& all) {
  if (!all.falls) return all.capture->finish();
  auto falls = all.falls->finish();
  if (!all.capture || (falls && falls->report.verdict->usable)) return falls;
  return all.capture->finish();
}

// What the last `share` of the rows says of a model that was learned from those before; nothing where either part is
// too short for that.
std::optional<json> judged_on_the_end(const std::vector<Recording>& recordings, const Recipe& recipe, double share) {
  std::vector<Recording> begins, ends;
  for (const Recording& recording : recordings) {
    const auto cut = static_cast<std::size_t>((1 - share) * static_cast<double>(recording.rows()));
    begins.push_back(slice(recording, 0, cut));
    ends.push_back(slice(recording, cut, recording.rows()));
  }
  const auto fit = learn(begins, recipe, progress());
  if (!fit) return std::nullopt;
  const auto report = validate(fit->model, ends, {}, progress());
  if (!report) return std::nullopt;
  return report_json(*report);
}

}  // namespace
}  // namespace wisp::studio

using namespace wisp;
using namespace wisp::studio;

extern "C" {

// Begins a capture: {name, rate, pictures, looks_for, flame, points, dark, channel, region, height}. It looks for a
// "flame", for "falls", or for "either".
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

// A frame of three planes as decoders lay them out. `glimpse`: from anywhere in the clip, before the first frames.
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

// Interleaved samples; the first block says when the sound begins, seconds after the first frame.
WISP_STUDIO(sound)
int studio_sound(const float* samples, std::size_t count, int channels, double rate, double begin) {
  Desk& all = desk();
  if (!all.capture) return all.falls ? kDone : fail({"no capture has begun"});
  const auto heard = all.capture->hear({.rate_hz = rate, .channels = channels}, begin, {samples, count});
  return heard ? kDone : fail(heard.error());
}

// {frames, decided, channel, threshold, clipped, flames, box}; numbers: the outline's points. Of falls alone {frames,
// moving}: the box of what moves.
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

// The recording.
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

// Reads a table or a recording: {name, rate, inputs, outputs}.
WISP_STUDIO(table) int studio_table(const char* bytes, std::size_t size, const char* text, std::size_t text_size) {
  const auto recording = read_recording(bytes, size, parsed(text, text_size));
  if (!recording) return fail(recording.error());
  return hand_over(*recording, {});
}

// Puts a recording, as CSV, beside the others that are to be learned from; {name, …} as studio_table.
WISP_STUDIO(add) int studio_add(const char* bytes, std::size_t size, const char* text, std::size_t text_size) {
  auto recording = read_recording(bytes, size, parsed(text, text_size));
  if (!recording) return fail(recording.error());
  desk().recordings.push_back(std::move(*recording));
  return kDone;
}

WISP_STUDIO(clear) void studio_clear() { desk().recordings.clear(); }

// Learns from what was added. Bytes: the model. With `kept_back` what the last part of the rows says is `judged`.
WISP_STUDIO(learn) int studio_learn(const char* text, std::size_t size) {
  const json settings = parsed(text, size);
  const Recipe recipe = recipe_of(settings);
  const auto fit = learn(desk().recordings, recipe, progress());
  if (!fit) return fail(fit.error());
  auto bytes = model_bytes(fit->model);
  if (!bytes) return fail(bytes.error());
  json answer = report_json(fit->report);
  if (const double share = settings.value("kept_back", 0.0); share > 0 && share < 1) {
    if (auto judged = judged_on_the_end(desk().recordings, recipe, share)) answer["judged"] = *std::move(judged);
  }
  Answer& out = fresh();
  out.bytes = std::move(*bytes);
  out.text = answer.dump();
  return kDone;
}

// Judges a model on what was added.
WISP_STUDIO(validate) int studio_validate(const std::byte* bytes, std::size_t size) {
  const auto model = parse_model({bytes, size}, "the model");
  if (!model) return fail(model.error());
  const auto report = validate(*model, desk().recordings, {.responses = true}, progress());
  if (!report) return fail(report.error());
  fresh().text = report_json(*report).dump();
  return kDone;
}
}
