#pragma once
// The player without the window: events, sound and time in, a picture out. It runs the same with a display and without.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "candle_scene.hpp"
#include "ear.hpp"
#include "event.hpp"
#include "leaf_scene.hpp"
#include "plot_scene.hpp"

namespace wisp::window {

/// The scene, where a model can be shown in several.
enum class SceneKind { kCandle, kCake, kLeaves };

/// A player's start.
struct PlayerOptions {
  std::vector<std::filesystem::path> models;  ///< Tab goes from one to the next; at least one
  std::optional<SceneKind> scene{};           ///< unset: by the first model's view
  int width = 1280;                           ///< of the picture, pixels, 64 … 8192
  int height = 800;
  std::uint64_t seed = 1;
  bool hints = true;  ///< a line for beginners at the start
};

/// Counts of a run.
struct PlayerFigures {
  int frames = 0;
  int went_out = 0;  ///< flames, counted
  int relit = 0;
  std::uint64_t clamped = 0, steps = 0;  ///< of the bank that runs now
};

class Player {
 public:
  /// Errors: a model cannot be read; the first has no view for the scene that was requested.
  static Result<Player> create(const PlayerOptions& options);

  /// The ear. The source of sound opens, feeds and closes it.
  Ear& ear() { return ear_; }

  /// Handles user input.
  void handle(const Event& event);

  /// Advances the scene by `time`, with the wind heard now.
  void advance(std::chrono::nanoseconds time);

  /// Draws the current picture. Valid until the next call.
  const Image& draw();

  /// The picture's size from now on, clamped to 64 … 8192.
  void resize(int width, int height);

  /// Shows a text at the lower edge for some seconds.
  void notice(std::string text);

  /// The last notice.
  const std::string& said() const { return notice_; }

  bool closed() const { return closed_; }

  /// Whether the key for the microphone, or for full screen, was pressed since the last call.
  bool take_microphone_wish() { return std::exchange(microphone_wish_, false); }
  bool take_full_screen_wish() { return std::exchange(full_screen_wish_, false); }

  PlayerFigures figures() const;

  /// One line on the state for tests and logs: flames burning, leaves resting, the tip's lean.
  std::string state() const;

  const std::string& model_name() const { return name_; }

 private:
  using Scene = std::variant<CandleScene, LeafScene, PlotScene>;

  explicit Player(const PlayerOptions& options) : options_(options) {}
  Result<Scene> scene_for(const Model& model, std::optional<SceneKind> asked) const;
  Result<void> load(const std::filesystem::path& path, std::optional<SceneKind> asked);
  void show(Scene scene, const Model& model);
  void press(Key key);
  void hold(Key key, bool down);
  void more(int direction);
  void next_cake();
  void next_model();
  void drop(const std::string& path);
  void count_flames();
  void draw_indicator();
  void draw_help();

  PlayerOptions options_;
  std::optional<Scene> scene_;
  std::optional<Model> model_;
  std::string name_;
  std::size_t model_index_ = 0;
  Ear ear_;
  KeyWind keys_;
  bool left_ = false, right_ = false;
  bool noise_ = true;
  bool help_ = false;
  bool closed_ = false, microphone_wish_ = false, full_screen_wish_ = false;
  std::string notice_;
  double notice_until_ = 0;
  double seconds_ = 0;
  PlayerFigures figures_;
  int burning_ = 0;
  Image image_;
};

}  // namespace wisp::window
