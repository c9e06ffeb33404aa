// How long the vision stage takes, decoding apart: `wisp_bench_stage CLIP` prints one line of JSON for
// bench/peers/vision.py, which sets it beside OpenCV on the same frames.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {
namespace {

// Processor time of this thread: the machine may be busy with other things.
double milliseconds_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct StageTime {
  double milliseconds = 0;
  std::size_t frames = 0;
};

// The whole stage from the first frame to the recording, the first decisions included; frames come fresh from the
// decoder, as they do in use, and its time is left out.
Result<StageTime> time_stage(const char* path) {
  auto reader = VideoReader::open(path);
  if (!reader) return reader.error();
  OutlineCapture capture({.rate_hz = reader->info().rate_hz, .source = path});
  StageTime time;
  const auto timed = [&](const auto& work) {
    const double start = milliseconds_now();
    auto done = work();
    time.milliseconds += milliseconds_now() - start;
    return done;
  };
  for (;;) {
    const auto frame = reader->next();
    if (!frame) return frame.error();
    if (!*frame) break;
    if (auto fed = timed([&] { return capture.feed((*frame)->picture); }); !fed) return fed.error();
    ++time.frames;
  }
  if (auto done = timed([&] { return capture.finish(); }); !done) return done.error();
  return time;
}

Result<void> run(const char* path) {
  constexpr int kRepeats = 5;
  std::vector<double> times;
  std::size_t frames = 0;
  for (int k = 0; k < kRepeats; ++k) {
    const auto time = time_stage(path);
    if (!time) return time.error();
    frames = time->frames;
    times.push_back(time->milliseconds / static_cast<double>(frames));
  }
  std::sort(times.begin(), times.end());
  std::printf("{\"frames\": %zu, \"ms_per_frame\": %.4f, \"ms_per_frame_least\": %.4f}\n", frames, times[kRepeats / 2],
              times.front());
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
