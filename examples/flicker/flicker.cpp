// Plays a flame for two seconds at 60 frames a second, with a gust from the left in the middle, and prints where its
// highest point is: one line a frame, seconds, x and y.
//
//   flicker MODEL.wisp

#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace {

constexpr int kFramesPerSecond = 60;

int complain(const wisp::Error& error) {
  std::fprintf(stderr, "flicker: %s\n", error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: flicker MODEL.wisp\n");
    return 2;
  }
  const auto model = wisp::read_model(argv[1]);
  if (!model) return complain(model.error());
  auto bank = wisp::Bank::create(*model);
  if (!bank) return complain(bank.error());
  if (bank->polyline_points() == 0) return complain({std::string(argv[1]) + ": has no outline to play"});

  const wisp::InstanceId flame = bank->spawn();
  std::vector<float> wind(static_cast<std::size_t>(bank->input_count()));
  std::vector<float> outline(2 * static_cast<std::size_t>(bank->polyline_points()));
  for (int frame = 0; frame < 2 * kFramesPerSecond; ++frame) {
    const float seconds = static_cast<float>(frame) / kFramesPerSecond;
    wind.assign(wind.size(), seconds > 0.5f && seconds < 1.0f ? 1.0f : 0.0f);
    bank->set_common_inputs(wind);
    bank->advance(std::chrono::nanoseconds(std::chrono::seconds(1)) / kFramesPerSecond);
    bank->polyline(flame, outline);

    std::size_t top = 0;
    for (std::size_t point = 0; point < outline.size(); point += 2) {
      if (outline[point + 1] > outline[top + 1]) top = point;
    }
    std::printf("%.3f %.4f %.4f\n", seconds, outline[top], outline[top + 1]);
  }
  return 0;
}
