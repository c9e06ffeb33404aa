#include <cstdio>

#include "course.hpp"
#include "window.hpp"

namespace wisp::window {
namespace {

std::string frame_name(int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "frame-%05d", frame);
  return name;
}

}  // namespace

Result<PlayReport> play_without_display(const PlayOptions& options) {
  auto player = Player::create(options.player);
  if (!player) return player.error();
  auto course = Course::open(options, *player);
  if (!course) return course.error();
  PlayReport report;
  FrameCosts costs;
  for (int frame = 1; frame <= options.frames && !player->closed(); ++frame) {
    if (options.interrupted && *options.interrupted) break;
    const auto now = time_of_frame(frame);
    course->bring(std::chrono::duration<double>(now).count(), *player, [&](const Event& e) { player->handle(e); });
    const double before = thread_milliseconds();
    player->advance(now - time_of_frame(frame - 1));
    const Image& image = player->draw();
    costs.add(thread_milliseconds() - before);
    if (!options.pictures) continue;
    std::vector<std::string> names = course->wanted();
    if (!course->takes_pictures()) names = {frame_name(frame)};
    for (const std::string& name : names) {
      if (auto ok = write_png(*options.pictures / (name + ".png"), image); !ok) return ok.error();
      report.pictures.push_back({name, frame, player->state()});
    }
  }
  costs.report(report);
  report.figures = player->figures();
  report.state = player->state();
  return report;
}

}  // namespace wisp::window
