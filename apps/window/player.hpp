#pragma once
// The player without the window: takes events, sound and time, returns a picture. Runs with and without a display.

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "candle_scene.hpp"
#include "event.hpp"
#include "leaf_scene.hpp"
#include "plot_scene.hpp"
#include "wisp/base/result.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/model/file.hpp"

namespace wisp::window {

/// Scenes that a user can request.
enum class SceneKind { kCandle, kCake, kLeaves };

struct PlayerOptions {
  std::vector<std::filesystem::path> models;  ///< Tab cycles through them; at least one
  std::optional<SceneKind> scene{};           ///< unset: by the first model's view
  int width = 1280;                           ///< picture width, pixels, 64 … 8192
  int height = 800;
  std::uint64_t seed = 1;
  bool hints = true;  ///< show a line for beginners at the start
};

struct PlayerFigures {
  int frames = 0;
  int went_out = 0;  ///< number of extinctions
  int relit = 0;
  std::uint64_t clamped = 0, steps = 0;  ///< Bank::clamped() of the current scene
};

inline constexpr int kMin = 64, kMax = 8192;
inline constexpr int kCake = 7;
inline constexpr int kLeaves = 60;
inline constexpr double kNoticeSeconds = 6;
inline constexpr std::size_t kNoticeBytes = 76;  // maximum bytes per line of a notice

// Strength of the space bar's puff in scenes without candles.
inline constexpr float kPuff = 2;

inline Point pixel_of(Point share, const Image& image) {
  return {share.x * static_cast<float>(image.width()), share.y * static_cast<float>(image.height())};
}

// Wraps `text` into lines of at most `longest` bytes.
inline std::vector<std::string> wrapped(const std::string& text, std::size_t longest) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > longest) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

inline bool is_outline(const Model& model) { return std::holds_alternative<OutlineView>(model.view); }
inline bool is_body(const Model& model) {
  return std::holds_alternative<PoseView>(model.view) || std::holds_alternative<PositionView>(model.view);
}

class Player {
 public:
  /// Creates a player. Errors: the first model cannot be read, or its view does not fit the requested scene.
  static Result<Player> create(const PlayerOptions& options) {
    Player player(options);
    player.resize(options.width, options.height);
    if (auto ok = player.load(options.models.at(0), options.scene); !ok) return ok.error();
    if (options.hints) player.notice("blow, move the pointer past it, or press H");
    return player;
  }

  /// Returns the estimator of wind from sound, which the source of sound opens, feeds and closes.
  Ear& ear() { return ear_; }

  void handle(const Event& event) {
    std::visit(Overloaded{
                   [&](const KeyTurned& turned) {
                     hold(turned.key, turned.down);
                     if (turned.down) press(turned.key);
                   },
                   [&](const PointerMoved& moved) {
                     const Point at = pixel_of(moved.at, image_);
                     std::visit([&](auto& scene) { scene.pointer_moved(at); }, *scene_);
                   },
                   [&](const PointerTurned& turned) {
                     const Point at = pixel_of(turned.at, image_);
                     const auto turn = [&](auto& scene) {
                       turned.down ? scene.pointer_pressed(at) : scene.pointer_released(at);
                     };
                     std::visit(turn, *scene_);
                   },
                   [&](const PointerLeft&) { std::visit([](auto& scene) { scene.pointer_left(); }, *scene_); },
                   [&](const FileDropped& dropped) { drop(dropped.path); },
                   [&](const MicrophoneLost&) {
                     ear_.close(EarState::kMissing);
                     notice("the microphone is gone; the scene goes on, M looks for another");
                   },
                   [&](const Closed&) { closed_ = true; },
               },
               event);
  }

  /// Advances the scene by `time`, with the current wind.
  void advance(std::chrono::nanoseconds time) {
    const double seconds = std::chrono::duration<double>(time).count();
    seconds_ += seconds;
    keys_.advance(static_cast<float>(seconds));
    const float wind = ear_.wind() + keys_.wind();
    if (auto* candles = std::get_if<CandleScene>(&*scene_)) candles->blow_away(wind > 0 ? ear_.wind() / wind : 0);
    std::visit(
        [&](auto& scene) {
          scene.blow(wind);
          scene.advance(time);
        },
        *scene_);
    count_flames();
  }

  /// Draws the current picture, which is valid until the next call.
  const Image& draw() {
    std::visit([&](auto& scene) { scene.draw(image_); }, *scene_);
    draw_indicator();
    if (help_) draw_help();
    const double left = notice_until_ - seconds_;
    if (left > 0 && !notice_.empty()) {
      draw_note(image_, wrapped(notice_, kNoticeBytes), Corner::kBottomLeft,
                std::max(11.0F, static_cast<float>(image_.height()) / 44),
                static_cast<float>(std::min(1.0, left / 0.6)));
    }
    ++figures_.frames;
    return image_;
  }

  /// Sets the picture's size, clamped to 64 … 8192.
  void resize(int width, int height) {
    width = std::clamp(width, kMin, kMax);
    height = std::clamp(height, kMin, kMax);
    if (image_.width() == width && image_.height() == height) return;
    image_ = Image(width, height);
    if (scene_) std::visit([&](auto& scene) { scene.resize(width, height); }, *scene_);
  }

  /// Shows a text at the lower edge for some seconds.
  void notice(std::string text) {
    notice_ = std::move(text);
    notice_until_ = seconds_ + kNoticeSeconds;
  }

  const std::string& said() const { return notice_; }

  bool closed() const { return closed_; }

  /// Return whether the key for the microphone, or for full screen, was pressed since the last call.
  bool take_microphone_request() { return std::exchange(microphone_request_, false); }
  bool take_full_screen_request() { return std::exchange(full_screen_request_, false); }

  PlayerFigures figures() const {
    PlayerFigures figures = figures_;
    const auto clamped = std::visit([](const auto& scene) { return scene.clamped(); }, *scene_);
    figures.clamped = clamped.clamped;
    figures.steps = clamped.steps;
    return figures;
  }

  /// Returns one line on the state for tests and logs: flames burning, leaves resting, the tip's lean.
  std::string state() const {
    if (const auto* candles = std::get_if<CandleScene>(&*scene_)) {
      return "candles " + std::to_string(candles->candles()) + " burning " + std::to_string(candles->burning()) +
             " tip " + std::to_string(candles->tip());
    }
    if (const auto* leaves = std::get_if<LeafScene>(&*scene_)) {
      return "leaves " + std::to_string(leaves->leaves()) + " resting " + std::to_string(leaves->resting());
    }
    return "plot";
  }

  const std::string& model_name() const { return name_; }

 private:
  using Scene = std::variant<CandleScene, LeafScene, PlotScene>;

  explicit Player(const PlayerOptions& options) : options_(options) {}
  Result<Scene> scene_for(const Model& model, std::optional<SceneKind> asked) const {
    const bool leaves = asked == SceneKind::kLeaves;
    if (asked && !(leaves ? is_body(model) : is_outline(model))) {
      return Error{"--scene: the model is no " + std::string(leaves ? "leaf" : "flame") + "; its outputs are " +
                   (is_outline(model) ? "an outline"
                    : is_body(model)  ? "a body's motion"
                                      : "plain numbers")};
    }
    const auto as_scene = [](auto made) -> Result<Scene> {
      if (!made) return made.error();
      return Scene(std::move(*made));
    };
    if (is_outline(model)) {
      return as_scene(CandleScene::create(model, asked == SceneKind::kCake ? kCake : 1, options_.seed));
    }
    if (is_body(model)) return as_scene(LeafScene::create(model, kLeaves, options_.seed));
    return as_scene(PlotScene::create(model, options_.seed));
  }
  Result<void> load(const std::filesystem::path& path, std::optional<SceneKind> asked) {
    auto model = read_model(path);
    if (!model) return model.error();
    auto scene = scene_for(*model, asked);
    if (!scene) return scene.error();
    show(std::move(*scene), *model);
    return {};
  }
  void show(Scene scene, const Model& model) {
    scene_.emplace(std::move(scene));
    model_ = model;
    name_ = model.name;
    std::visit(
        [&](auto& shown) {
          shown.resize(image_.width(), image_.height());
          shown.set_noise(noise_);
        },
        *scene_);
    const auto* candles = std::get_if<CandleScene>(&*scene_);
    burning_ = candles ? candles->burning() : 0;
  }
  void press(Key key) {
    auto* candles = std::get_if<CandleScene>(&*scene_);
    auto* leaves = std::get_if<LeafScene>(&*scene_);
    switch (key) {
      case Key::kSpace:
        keys_.puff(candles ? candles->strong() : kPuff);
        if (candles && !candles->goes_out()) notice("this flame was never seen to go out, so it does not");
        break;
      case Key::kEnter:
        if (candles) candles->relight_all();
        break;
      case Key::kUp:
      case Key::kPlus:
        more(1);
        break;
      case Key::kDown:
      case Key::kMinus:
        more(-1);
        break;
      case Key::kC:
        if (candles) show_candles(candles->candles() == 1 ? kCake : 1);
        break;
      case Key::kTab:
        next_model();
        break;
      case Key::kG:
        if (leaves) {
          leaves->set_ground(!leaves->ground());
          notice(leaves->ground() ? "ground: there" : "ground: gone, leaves fall for ever");
        }
        break;
      case Key::kN:
        noise_ = !noise_;
        std::visit([&](auto& scene) { scene.set_noise(noise_); }, *scene_);
        notice(noise_ ? "noise: on, as learned" : "noise: off, only what wind does is left");
        break;
      case Key::kR:
        keys_.calm();
        std::visit([](auto& scene) { scene.reset(); }, *scene_);
        break;
      case Key::kM:
        microphone_request_ = true;
        break;
      case Key::kF11:
        full_screen_request_ = true;
        break;
      case Key::kH:
        help_ = !help_;
        break;
      case Key::kQ:
        closed_ = true;
        break;
      default:
        break;
    }
  }
  void hold(Key key, bool down) {
    if (key == Key::kLeft) left_ = down;
    if (key == Key::kRight) right_ = down;
    keys_.hold((right_ ? 1 : 0) - (left_ ? 1 : 0));
  }
  // Adds or removes leaves, or candles.
  void more(int direction) {
    if (auto* leaves = std::get_if<LeafScene>(&*scene_)) {
      const int now = leaves->leaves();
      leaves->set_leaves(direction > 0 ? now + std::max(1, now / 2) : now - std::max(1, now / 3));
      notice(std::to_string(leaves->leaves()) + (leaves->leaves() == 1 ? " leaf" : " leaves"));
    } else if (auto* candles = std::get_if<CandleScene>(&*scene_)) {
      show_candles(std::clamp(candles->candles() + direction, 1, CandleScene::kMaxCandles));
    }
  }
  void show_candles(int wanted) {
    const auto* candles = std::get_if<CandleScene>(&*scene_);
    if (!candles || wanted == candles->candles()) return;
    if (auto made = CandleScene::create(*model_, wanted, options_.seed)) show(std::move(*made), *model_);
  }
  void next_model() {
    if (options_.models.size() < 2) return notice("there is one model only; drop another .wisp file here");
    model_index_ = (model_index_ + 1) % options_.models.size();
    drop(options_.models[model_index_].string());
  }
  // Loads a model. If it cannot be shown, displays a notice and keeps the scene.
  void drop(const std::string& path) {
    const std::string file = std::filesystem::path(path).filename().string();
    if (auto ok = load(path, {}); !ok) {
      std::string reason = ok.error().message;
      reason = reason.starts_with(path) ? reason.substr(path.size()) : ": " + reason;
      notice("cannot play " + file + reason);
      return;
    }
    notice("playing " + name_ + " (" + file + ")");
  }
  void count_flames() {
    const auto* candles = std::get_if<CandleScene>(&*scene_);
    if (!candles) return;
    const int now = candles->burning();
    figures_.went_out += std::max(0, burning_ - now);
    figures_.relit += std::max(0, now - burning_);
    burning_ = now;
  }
  void draw_indicator() {
    if (ear_.state() == EarState::kOff) return;
    const bool listens = ear_.state() == EarState::kListening;
    std::string text = listens ? "microphone " : "no microphone";
    // Wind meter of eight steps up to a gust of 2.
    for (int k = 0; listens && k < 8; ++k) text += ear_.wind() * 4 > static_cast<float>(k) ? "●" : "·";
    const std::array<std::string, 1> lines{text};
    draw_note(image_, lines, Corner::kTopRight, std::max(11.0F, static_cast<float>(image_.height()) / 52));
  }
  void draw_help() {
    std::vector<std::string> lines;
    if (std::holds_alternative<CandleScene>(*scene_)) {
      lines = {"blow\tinto the microphone: it leans, flickers, goes out",
               "pointer\tmove it past the flame; drag the candle, or beside it to go round",
               "click, Enter\tlight it again",
               "← →\twind",
               "Space\ta strong blow",
               "C\tone candle, or a cake",
               "+ −\tmore or fewer candles"};
    } else if (std::holds_alternative<LeafScene>(*scene_)) {
      lines = {"blow\tinto the microphone: a gust", "pointer\tmove it: leaves go along",
               "click\tkick up what lies there",    "← →, Space\tgusts",
               "+ −\tmore or fewer leaves",         "G\tground, or none"};
    } else {
      lines = {"← →, Space\tmove the inputs"};
    }
    lines.insert(lines.end(),
                 {"N\tchance, on or off", "R\tfrom the start", "M\tmicrophone, on or off", "Tab\tthe next model",
                  "F11\tfull screen", "H, F1\tthis page", "Esc\tquit", "", "Drop a .wisp file here to play it."});
    draw_note(image_, lines, Corner::kTopLeft, std::max(11.0F, static_cast<float>(image_.height()) / 44));
  }

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
  bool closed_ = false, microphone_request_ = false, full_screen_request_ = false;
  std::string notice_;
  double notice_until_ = 0;
  double seconds_ = 0;
  PlayerFigures figures_;
  int burning_ = 0;
  Image image_;
};

}  // namespace wisp::window
