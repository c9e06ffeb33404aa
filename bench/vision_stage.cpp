// How long the vision stage takes, decoding apart: `wisp_bench_stage CLIP` prints one line of JSON for
// bench/peers/vision.py, which sets it beside OpenCV on the same frames.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <vector>

#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Result<std::deque<OwnedPicture>> decoded(const char* path, double& rate_hz) {
  auto reader = VideoReader::open(path);
  if (!reader) return reader.error();
  rate_hz = reader->info().rate_hz;
  std::deque<OwnedPicture> frames;
  for (;;) {
    const auto frame = reader->next();
    if (!frame) return frame.error();
    if (!*frame) return frames;
    frames.emplace_back((*frame)->picture);
  }
}

Result<double> milliseconds_a_frame(const std::deque<OwnedPicture>& frames, double rate_hz) {
  OutlineCapture capture({.rate_hz = rate_hz, .source = "bench"});
  const auto start = Clock::now();
  for (const OwnedPicture& frame : frames) {
    if (auto ok = capture.feed(frame.picture()); !ok) return ok.error();
  }
  if (auto done = capture.finish(); !done) return done.error();
  return milliseconds_since(start) / static_cast<double>(frames.size());
}

Result<void> run(const char* path) {
  constexpr int kRepeats = 7;
  double rate_hz = 0;
  const auto frames = decoded(path, rate_hz);
  if (!frames) return frames.error();
  std::vector<double> times;
  for (int k = 0; k < kRepeats; ++k) {
    const auto time = milliseconds_a_frame(*frames, rate_hz);
    if (!time) return time.error();
    times.push_back(*time);
  }
  std::sort(times.begin(), times.end());
  std::printf("{\"frames\": %zu, \"ms_per_frame\": %.4f, \"ms_per_frame_least\": %.4f}\n", frames->size(),
              times[kRepeats / 2], times.front());
  return {};
}

}  // namespace
}  // namespace wisp

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: wisp_bench_stage CLIP\n", stderr), 2;
  const auto done = wisp::run(argv[1]);
  if (!done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 1;
  return 0;
}
