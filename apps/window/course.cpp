#include "window.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>
#include <utility>

namespace wisp::window {
namespace {

constexpr const char* kWords = "key, down, up, move, press, release, click, drop, picture, unplug or close";

// Parses one line; returns an empty list if its words are wrong.
std::vector<std::variant<Event, PictureTaken>> meaning(const std::string& word, std::istringstream& words) {
  if (word == "close") return {Event{Closed{}}};
  if (word == "unplug") return {Event{MicrophoneLost{}}};
  if (word == "key" || word == "down" || word == "up") {
    std::string name;
    words >> name;
    const Key key = key_named(name);
    if (key == Key::kNone) return {};
    if (word == "key") return {Event{KeyTurned{key, true}}, Event{KeyTurned{key, false}}};
    return {Event{KeyTurned{key, word == "down"}}};
  }
  if (word == "drop" || word == "picture") {
    std::string rest;
    std::getline(words >> std::ws, rest);
    while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back()))) rest.pop_back();
    if (rest.empty()) return {};
    if (word == "drop") return {Event{FileDropped{rest}}};
    if (rest.find('/') != std::string::npos) return {};
    return {PictureTaken{rest}};
  }
  Point at;
  if (!(words >> at.x >> at.y) || !std::isfinite(at.x) || !std::isfinite(at.y)) return {};
  if (word == "move") return {Event{PointerMoved{at}}};
  if (word == "press") return {Event{PointerTurned{at, true}}};
  if (word == "release") return {Event{PointerTurned{at, false}}};
  if (word == "click") return {Event{PointerTurned{at, true}}, Event{PointerTurned{at, false}}};
  return {};
}

}  // namespace

Key key_named(std::string_view name) {
  // Names in the order of Key.
  constexpr std::string_view kNames[] = {"left", "right", "up", "down", "space", "enter", "tab", "plus", "minus",
                                         "c",    "g",     "h",  "m",    "n",     "q",     "r",   "f11"};
  return static_cast<Key>(std::find(std::begin(kNames), std::end(kNames), name) - std::begin(kNames));
}

Result<std::vector<TimedEvent>> read_script(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<TimedEvent> events;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    std::istringstream words(line);
    if ((words >> std::ws).eof()) continue;
    double seconds = 0;
    std::string word;
    const bool timed = static_cast<bool>(words >> seconds >> word) && seconds >= 0 && seconds <= 1e6;
    const auto what = timed ? meaning(word, words) : std::vector<std::variant<Event, PictureTaken>>{};
    if (what.empty()) {
      return Error{path.string() + ":" + std::to_string(number) + ": found \"" + line +
                   "\", expected SECONDS and one of " + kWords + " with what belongs to it"};
    }
    for (const auto& one : what) events.push_back({seconds, one});
  }
  if (!file.eof()) return Error{path.string() + ": cannot be read; expected a script of events"};  // a folder opens
  std::stable_sort(events.begin(), events.end(), [](auto& a, auto& b) { return a.seconds < b.seconds; });
  return events;
}

Result<Course> Course::open(const PlayOptions& options, Player& player) {
  Course course;
  if (options.script) {
    auto events = read_script(*options.script);
    if (!events) return events.error();
    course.events_ = std::move(*events);
    course.scripted_ = true;
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

bool Course::takes_pictures() const {
  const auto takes = [](const TimedEvent& event) { return std::holds_alternative<PictureTaken>(event.what); };
  return std::any_of(events_.begin(), events_.end(), takes);
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

Result<PlayReport> play_without_display(const PlayOptions& options) {
  auto player = Player::create(options.player);
  if (!player) return player.error();
  auto course = Course::open(options, *player);
  if (!course) return course.error();
  PlayReport report;
  for (int frame = 1; frame <= options.frames && !player->closed(); ++frame) {
    if (options.interrupted && *options.interrupted) break;
    const auto now = time_of_frame(frame);
    course->bring(std::chrono::duration<double>(now).count(), *player, [&](const Event& e) { player->handle(e); });
    const double before = thread_milliseconds();
    player->advance(now - time_of_frame(frame - 1));
    const Image& image = player->draw();
    report.add_frame(thread_milliseconds() - before);
    if (!options.pictures) continue;
    std::vector<std::string> names = course->wanted();
    if (!course->takes_pictures()) names = {picture_name(frame)};
    for (const std::string& name : names) {
      if (auto ok = write_png(*options.pictures / (name + ".png"), image); !ok) return ok.error();
      report.pictures.push_back({name, frame, player->state()});
    }
  }
  report.figures = player->figures();
  report.state = player->state();
  return report;
}

}  // namespace wisp::window
