#include "course.hpp"

#include <algorithm>
#include <ctime>

namespace wisp::window {

Result<Course> Course::open(const PlayOptions& options, Player& player) {
  Course course;
  if (options.script) {
    auto events = read_script(*options.script);
    if (!events) return events.error();
    course.events_ = std::move(*events);
    course.scripted_ = true;
    course.takes_pictures_ = std::any_of(course.events_.begin(), course.events_.end(), [](const TimedEvent& event) {
      return std::holds_alternative<PictureTaken>(event.what);
    });
  }
  if (options.sound) {
    auto sound = SoundFile::open(*options.sound);
    if (!sound) return sound.error();
    if (auto ok = player.ear().open(sound->format()); !ok) return Error{*options.sound + ": " + ok.error().message};
    course.sound_.emplace(std::move(*sound));
  }
  if (options.pictures) {
    std::error_code code;
    std::filesystem::create_directories(*options.pictures, code);
    if (code) return Error{options.pictures->string() + ": cannot be made: " + code.message()};
  }
  return course;
}

void Course::bring(double seconds, Player& player, const std::function<void(const Event&)>& deliver) {
  wanted_.clear();
  for (; next_ < events_.size() && events_[next_].seconds <= seconds; ++next_) {
    const auto& what = events_[next_].what;
    if (const auto* event = std::get_if<Event>(&what)) {
      deliver(*event);
    } else {
      wanted_.push_back(std::get<PictureTaken>(what).name);
    }
  }
  if (sound_) player.ear().hear(sound_->until(seconds, kSoundBlock));
}

double thread_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void FrameCosts::add(double milliseconds) {
  ++frames_;
  sum_ += milliseconds;
  if (frames_ > 10) worst_ = std::max(worst_, milliseconds);
}

void FrameCosts::report(PlayReport& report) const {
  report.draw_ms = frames_ > 0 ? sum_ / frames_ : 0;
  report.worst_draw_ms = worst_;
}

}  // namespace wisp::window
