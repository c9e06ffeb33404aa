// One call into every layer, so that each must link with all that it stands on. Nothing here exists: bad data are a
// sentence, and the sentences are counted.

#include <cstdio>
#include <span>

#include "wisp/base/file.hpp"
#include "wisp/capture/capture.hpp"
#include "wisp/capture/vision/image.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/learn.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/mat.hpp"
#include "wisp/run/random.hpp"
#include "wisp/simulate/candle_clip.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/wisp.h"

namespace {

template <class T>
int complaints(const wisp::Result<T>& result) {
  if (result) return 0;
  std::printf("%s\n", result.error().message.c_str());
  return 1;
}

}  // namespace

int main() {
  int count = complaints(wisp::read_file("nowhere/file"));
  count += complaints(wisp::read_model("nowhere/model.wisp"));
  count += complaints(wisp::read_csv("nowhere/recording.csv"));
  count += complaints(wisp::read_mat("nowhere/recording.mat", {}));
  count += complaints(wisp::capture("nowhere/clip.mp4", wisp::FlameCapture{}));
  count += complaints(wisp::learn(std::span<const wisp::Recording>{}, wisp::FlameRecipe{}));
  count += complaints(wisp::WindLevel::create({.rate_hz = 1}));
  count += complaints(wisp::write_png("nowhere/picture.png", wisp::Image(2, 2)));
  count += complaints(wisp::VideoWriter::create("nowhere/film.mp4", {}));
  count += complaints(wisp::simulate_candle({.seconds = 0}, {}));

  const bool report = wisp::to_text(wisp::Report{}).size() < 100;
  const bool random = wisp::normal_pair(0)[0] > 5;
  const bool vision = !wisp::channel_name(wisp::PixelChannel{}).empty();
  return count == 10 && report && random && vision && wisp_version() > 0 ? 0 : 1;
}
