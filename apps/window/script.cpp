#include "script.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace wisp::window {
namespace {

constexpr const char* kWords = "key, down, up, move, press, release, click, drop, picture, unplug or close";

std::optional<Point> place_in(std::istringstream& words) {
  Point at;
  if (words >> at.x >> at.y && std::isfinite(at.x) && std::isfinite(at.y)) return at;
  return {};
}

// What one line says; nothing where its words are wrong.
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
    if (rest.empty()) return {};
    if (word == "drop") return {Event{FileDropped{rest}}};
    if (rest.find('/') != std::string::npos) return {};
    return {PictureTaken{rest}};
  }
  const auto at = place_in(words);
  if (!at) return {};
  if (word == "move") return {Event{PointerMoved{*at}}};
  if (word == "press") return {Event{PointerTurned{*at, true}}};
  if (word == "release") return {Event{PointerTurned{*at, false}}};
  if (word == "click") return {Event{PointerTurned{*at, true}}, Event{PointerTurned{*at, false}}};
  return {};
}

}  // namespace

Result<std::vector<TimedEvent>> read_script(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return Error{path.string() + ": cannot be read; expected a script of events"};
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
  std::stable_sort(events.begin(), events.end(), [](auto& a, auto& b) { return a.seconds < b.seconds; });
  return events;
}

}  // namespace wisp::window
