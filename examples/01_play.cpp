// Plays a flame for two seconds at 60 frames a second, with a gust from the left in the middle, and prints where its
// highest point is: one line a frame, seconds, x and y.
//
//   01_play MODEL.wisp

#include <chrono>
#include <cstdio>
#include <vector>

#include "wisp/play.hpp"

int main(int argc, char** argv) {
  const auto model = wisp::read_model(argc > 1 ? argv[1] : "flame.wisp");
  if (!model) return std::puts(model.error().message.c_str()), 1;
  auto bank = wisp::Bank::create(*model);
  if (!bank) return std::puts(bank.error().message.c_str()), 1;
  if (bank->polyline_points() == 0) return std::puts("the model has no outline to play"), 1;

  const wisp::InstanceId flame = bank->spawn();
  std::vector<float> wind(static_cast<std::size_t>(bank->input_count()));
  std::vector<float> outline(2 * static_cast<std::size_t>(bank->polyline_points()));
  for (int frame = 0; frame < 120; ++frame) {
    wind.assign(wind.size(), frame > 30 && frame < 60 ? 1.0f : 0.0f);  // 1 is a strong gust
    bank->set_common_inputs(wind);
    bank->advance(std::chrono::nanoseconds(16'666'667));
    bank->polyline(flame, outline);  // x, y, x, y, … in flame heights

    std::size_t top = 0;
    for (std::size_t point = 0; point < outline.size(); point += 2) {
      if (outline[point + 1] > outline[top + 1]) top = point;
    }
    std::printf("%.3f %.4f %.4f\n", frame / 60.0, outline[top], outline[top + 1]);
  }
}
