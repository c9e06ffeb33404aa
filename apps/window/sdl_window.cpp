// The window, by SDL2: the picture as a texture, a microphone, keys, pointer and dropped files.

#define SDL_MAIN_HANDLED
#include <SDL.h>
#include <fcntl.h>
#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "window.hpp"

namespace wisp::window {
namespace {

#ifdef _WIN32
constexpr const char* kNowhere = "NUL";
#else
constexpr const char* kNowhere = "/dev/null";
#endif

// Calls `act` with standard error silenced: without a sound card or screen, the system's libraries write a dozen lines
// there in addition to the error that they return.
template <class Act>
auto quietly(Act act) {
  const int kept = ::dup(2), nowhere = ::open(kNowhere, O_WRONLY);
  if (nowhere >= 0) ::dup2(nowhere, 2), ::close(nowhere);
  const auto done = act();
  if (kept >= 0) ::dup2(kept, 2), ::close(kept);
  return done;
}

class Microphone {
 public:
  Microphone() = default;
  ~Microphone() { close(); }
  Microphone(const Microphone&) = delete;
  Microphone& operator=(const Microphone&) = delete;

  // Opens the system's default microphone and the ear for it. Errors: there is none, or access is denied.
  Result<void> open(Ear& ear) {
    close();
    const auto none = [](const std::string& why) {
      return Error{"no microphone: " + why + "; arrows, space and the pointer blow too"};
    };
    if (quietly([] { return SDL_InitSubSystem(SDL_INIT_AUDIO); }) != 0) return none(SDL_GetError());
    SDL_AudioSpec wanted{}, got{};
    wanted.freq = 48000;
    wanted.format = AUDIO_F32SYS;
    wanted.channels = 1;
    wanted.samples = kSoundBlock;
    device_ = quietly([&] { return SDL_OpenAudioDevice(nullptr, 1, &wanted, &got, SDL_AUDIO_ALLOW_FREQUENCY_CHANGE); });
    if (device_ == 0) return none(SDL_GetError());
    channels_ = std::max<int>(1, got.channels);
    if (auto ok = ear.open({.rate_hz = static_cast<double>(got.freq), .channels = channels_}); !ok) {
      close();
      return none(ok.error().message);
    }
    SDL_PauseAudioDevice(device_, 0);
    return {};
  }

  void close() {
    if (device_ != 0) SDL_CloseAudioDevice(device_);
    device_ = 0;
  }

  bool is_open() const { return device_ != 0; }
  bool is(SDL_AudioDeviceID device) const { return device_ != 0 && device_ == device; }
  SDL_AudioDeviceID device() const { return device_; }

  // Passes the samples since the last call to the ear.
  void pass_on(Ear& ear) {
    if (device_ == 0) return;
    constexpr Uint32 kMaxWaitingBytes = 4 * 48000 / 2;  // half a second; more comes from a pause of the window
    block_.resize(static_cast<std::size_t>(kSoundBlock) * channels_);
    if (SDL_GetQueuedAudioSize(device_) > kMaxWaitingBytes) SDL_ClearQueuedAudio(device_);
    for (;;) {
      const Uint32 bytes = SDL_DequeueAudio(device_, block_.data(), static_cast<Uint32>(4 * block_.size()));
      const std::size_t samples = bytes / 4 / channels_ * channels_;
      if (samples == 0) return;
      ear.hear(std::span(block_).first(samples));
    }
  }

  // Drops the samples since the last call.
  void forget() {
    if (device_ != 0) SDL_ClearQueuedAudio(device_);
  }

 private:
  SDL_AudioDeviceID device_ = 0;
  int channels_ = 1;
  std::vector<float> block_;
};

// Pictures above kMaxPixels are drawn smaller and scaled up by the window. Slow frames lower the limit to kMinPixels.
constexpr double kMaxPixels = 1280.0 * 800.0;
constexpr double kMinPixels = 240'000;
constexpr double kBudgetMs = 13;  // time for step and picture, of 16.7 ms per frame

// Interval at which a hidden window checks whether it is shown again.
constexpr int kHiddenMs = 500;

// Minimum length of a frame, in case vertical sync does not limit the rate.
constexpr double kShortestFrameMs = 1000.0 / 150;

// Key codes in the order of Key; then further keys with the same functions.
constexpr SDL_Keycode kCodes[] = {SDLK_LEFT, SDLK_RIGHT, SDLK_UP,    SDLK_DOWN, SDLK_SPACE, SDLK_RETURN,
                                  SDLK_TAB,  SDLK_PLUS,  SDLK_MINUS, SDLK_c,    SDLK_g,     SDLK_h,
                                  SDLK_m,    SDLK_n,     SDLK_q,     SDLK_r,    SDLK_F11};
constexpr std::pair<SDL_Keycode, Key> kAlso[] = {
    {SDLK_KP_ENTER, Key::kEnter}, {SDLK_KP_PLUS, Key::kPlus}, {SDLK_EQUALS, Key::kPlus}, {SDLK_KP_MINUS, Key::kMinus},
    {SDLK_F1, Key::kH},           {SDLK_QUESTION, Key::kH},   {SDLK_ESCAPE, Key::kQ}};

Key key_of(SDL_Keycode code) {
  for (const auto& [also, key] : kAlso) {
    if (also == code) return key;
  }
  return static_cast<Key>(std::find(std::begin(kCodes), std::end(kCodes), code) - std::begin(kCodes));
}

struct Destroy {
  void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
  void operator()(SDL_Renderer* renderer) const { SDL_DestroyRenderer(renderer); }
  void operator()(SDL_Texture* texture) const { SDL_DestroyTexture(texture); }
};

// Shuts SDL down. Declared before the members that use SDL, so that it is destroyed after them.
struct Session {
  Session() { SDL_SetMainReady(); }
  ~Session() { SDL_Quit(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

Error no_display() { return {"no display was found; wisp play needs one, --frames N --png DIR draws without"}; }

class Window {
 public:
  Window(Player& player, Course& course, const PlayOptions& options)
      : player_(player), course_(course), options_(options) {}

  Result<void> open() {
    if (quietly([] { return SDL_Init(SDL_INIT_VIDEO); }) != 0) return no_display();
    // Without a screen SDL chooses a driver that shows nothing; accept it only where it was requested.
    const std::string_view driver = SDL_GetCurrentVideoDriver();
    if ((driver == "offscreen" || driver == "dummy") && std::getenv("SDL_VIDEODRIVER") == nullptr) return no_display();
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    const std::string title = "Wisp: " + player_.model_name();
    window_.reset(SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, options_.player.width,
                                   options_.player.height, SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI));
    if (!window_) return Error{error("no window can be opened")};
    // A script does not wait for the screen.
    renderer_.reset(SDL_CreateRenderer(window_.get(), -1, course_.scripted() ? 0U : Uint32{SDL_RENDERER_PRESENTVSYNC}));
    if (!renderer_) renderer_.reset(SDL_CreateRenderer(window_.get(), -1, SDL_RENDERER_SOFTWARE));
    if (!renderer_) return Error{error("nothing can be drawn in the window")};
    SDL_RendererInfo info;
    if (SDL_GetRendererInfo(renderer_.get(), &info) == 0) {
      report_.renderer = info.name;
      synced_ = (info.flags & SDL_RENDERER_PRESENTVSYNC) != 0;
    }
    SDL_EventState(SDL_DROPFILE, SDL_ENABLE);
    fit_picture();
    if (options_.microphone && !options_.sound) open_microphone();
    return {};
  }

  Result<PlayReport> run() {
    last_ = SDL_GetPerformanceCounter();
    std::chrono::nanoseconds shown{0};
    for (int frame = 1; !player_.closed() && (options_.frames == 0 || frame <= options_.frames); ++frame) {
      if (options_.interrupted && *options_.interrupted) break;
      const Uint64 began = SDL_GetPerformanceCounter();
      take_events();
      if (wait_while_hidden()) continue;
      const auto passed = time_passed(frame);
      shown += passed;
      course_.bring(std::chrono::duration<double>(shown).count(), player_, [&](const Event& event) { push(event); });
      if (course_.scripted()) take_events();
      microphone_.pass_on(player_.ear());
      const double before = thread_milliseconds();
      player_.advance(passed);
      const Image& image = player_.draw();
      const double cost = thread_milliseconds() - before;
      report_.add_frame(cost);
      if (auto ok = show(image); !ok) return ok.error();
      if (auto ok = keep(course_.wanted(), frame); !ok) return ok.error();
      SDL_RenderPresent(renderer_.get());
      hold_back(began);
      draw_smaller(cost);
    }
    report_.figures = player_.figures();
    report_.state = player_.state();
    return report_;
  }

 private:
  std::string error(const char* what) const { return std::string(what) + ": " + SDL_GetError(); }

  // Fits the picture to the window, with at most max_pixels_.
  void fit_picture() {
    int width = 0, height = 0;
    if (SDL_GetRendererOutputSize(renderer_.get(), &width, &height) != 0 || width < 1 || height < 1) return;
    const double pixels = static_cast<double>(width) * height;
    const double scale = std::min(1.0, std::sqrt(max_pixels_ / pixels));
    player_.resize(static_cast<int>(std::lround(width * scale)), static_cast<int>(std::lround(height * scale)));
  }

  void open_microphone() {
    if (auto ok = microphone_.open(player_.ear()); !ok) {
      player_.ear().close(EarState::kMissing);
      player_.notice(ok.error().message);
      report_.said.push_back(ok.error().message);
    }
  }

  Point share_of(int x, int y) const {
    int width = 1, height = 1;
    SDL_GetWindowSize(window_.get(), &width, &height);
    return {static_cast<float>(x) / static_cast<float>(std::max(1, width)),
            static_cast<float>(y) / static_cast<float>(std::max(1, height))};
  }

  void take(const SDL_Event& event) {
    switch (event.type) {
      case SDL_QUIT:
        return player_.handle(Closed{});
      case SDL_KEYDOWN:
      case SDL_KEYUP:
        if (event.key.repeat == 0) player_.handle(KeyTurned{key_of(event.key.keysym.sym), event.type == SDL_KEYDOWN});
        return;
      case SDL_MOUSEMOTION:
        return player_.handle(PointerMoved{share_of(event.motion.x, event.motion.y)});
      case SDL_MOUSEBUTTONDOWN:
      case SDL_MOUSEBUTTONUP:
        return player_.handle(
            PointerTurned{share_of(event.button.x, event.button.y), event.type == SDL_MOUSEBUTTONDOWN});
      case SDL_FINGERUP:
        return player_.handle(PointerLeft{});
      case SDL_DROPFILE: {
        const std::unique_ptr<char, void (*)(void*)> file(event.drop.file, SDL_free);
        return player_.handle(FileDropped{file.get()});
      }
      case SDL_AUDIODEVICEREMOVED:
        if (event.adevice.iscapture != 0 && microphone_.is(event.adevice.which)) {
          microphone_.close();
          player_.handle(MicrophoneLost{});
          report_.said.push_back(player_.said());
        }
        return;
      case SDL_AUDIODEVICEADDED:
        if (event.adevice.iscapture != 0 && player_.ear().state() == EarState::kMissing) open_microphone();
        return;
      case SDL_WINDOWEVENT: {
        const auto what = event.window.event;
        if (what == SDL_WINDOWEVENT_SIZE_CHANGED) {
          max_pixels_ = kMaxPixels;
          fit_picture();
        }
        if (what == SDL_WINDOWEVENT_LEAVE) player_.handle(PointerLeft{});
        if (what == SDL_WINDOWEVENT_MINIMIZED || what == SDL_WINDOWEVENT_HIDDEN) hidden_ = true;
        if (what == SDL_WINDOWEVENT_RESTORED || what == SDL_WINDOWEVENT_SHOWN) hidden_ = false;
        return;
      }
      default:
        return;
    }
  }

  void take_events() {
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0) take(event);
    const std::string title = "Wisp: " + player_.model_name();
    if (title != SDL_GetWindowTitle(window_.get())) SDL_SetWindowTitle(window_.get(), title.c_str());
    if (player_.take_full_screen_request()) toggle_full_screen();
    if (!player_.take_microphone_request() || options_.sound) return;
    if (microphone_.is_open()) {
      microphone_.close();
      player_.ear().close(EarState::kOff);
      player_.notice("microphone off");
    } else {
      open_microphone();
    }
  }

  // Pushes a script's event to SDL's queue, through which a person's events come too.
  void push(const Event& event) const {
    SDL_Event sdl{};
    int width = 1, height = 1;
    SDL_GetWindowSize(window_.get(), &width, &height);
    const auto x = [&](Point at) { return static_cast<int>(std::lround(at.x * static_cast<float>(width))); };
    const auto y = [&](Point at) { return static_cast<int>(std::lround(at.y * static_cast<float>(height))); };
    if (const auto* key = std::get_if<KeyTurned>(&event)) {
      sdl.type = key->down ? SDL_KEYDOWN : SDL_KEYUP;
      sdl.key.keysym.sym = key->key == Key::kNone ? SDLK_UNKNOWN : kCodes[static_cast<std::size_t>(key->key)];
    } else if (const auto* moved = std::get_if<PointerMoved>(&event)) {
      sdl.type = SDL_MOUSEMOTION;
      sdl.motion.x = x(moved->at), sdl.motion.y = y(moved->at);
    } else if (const auto* turned = std::get_if<PointerTurned>(&event)) {
      sdl.type = turned->down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
      sdl.button.x = x(turned->at), sdl.button.y = y(turned->at);
    } else if (const auto* dropped = std::get_if<FileDropped>(&event)) {
      sdl.type = SDL_DROPFILE;
      sdl.drop.file = SDL_strdup(dropped->path.c_str());
    } else if (std::holds_alternative<MicrophoneLost>(event)) {
      sdl.type = SDL_AUDIODEVICEREMOVED;
      sdl.adevice.which = microphone_.device();
      sdl.adevice.iscapture = 1;
    } else {
      sdl.type = SDL_QUIT;
    }
    SDL_PushEvent(&sdl);
  }

  void toggle_full_screen() {
    const bool full = (SDL_GetWindowFlags(window_.get()) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
    SDL_SetWindowFullscreen(window_.get(), full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
  }

  // Sleeps while the window is hidden. Returns whether it slept.
  bool wait_while_hidden() {
    if (!hidden_ || course_.scripted()) return false;
    SDL_Event event;
    if (SDL_WaitEventTimeout(&event, kHiddenMs) != 0) take(event);
    microphone_.forget();
    last_ = SDL_GetPerformanceCounter();
    return true;
  }

  std::chrono::nanoseconds time_passed(int frame) {
    const Uint64 now = SDL_GetPerformanceCounter();
    const double seconds = static_cast<double>(now - last_) / static_cast<double>(SDL_GetPerformanceFrequency());
    last_ = now;
    if (course_.scripted()) return time_of_frame(frame) - time_of_frame(frame - 1);
    return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * std::clamp(seconds, 0.0, 0.25)));
  }

  Result<void> show(const Image& image) {
    if (!texture_ || texture_width_ != image.width() || texture_height_ != image.height()) {
      texture_width_ = image.width();
      texture_height_ = image.height();
      texture_.reset(SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_ARGB8888, SDL_TEXTUREACCESS_STREAMING,
                                       texture_width_, texture_height_));
      if (!texture_) return Error{error("no picture can be shown in the window")};
    }
    SDL_UpdateTexture(texture_.get(), nullptr, image.pixels().data(), 4 * image.width());
    SDL_RenderCopy(renderer_.get(), texture_.get(), nullptr, nullptr);
    return {};
  }

  // Saves the rendered picture before it is presented.
  Result<void> keep(const std::vector<std::string>& names, int frame) {
    if (names.empty() || !options_.pictures) return {};
    int width = 0, height = 0;
    SDL_GetRendererOutputSize(renderer_.get(), &width, &height);
    Image seen(std::max(1, width), std::max(1, height));
    if (SDL_RenderReadPixels(renderer_.get(), nullptr, SDL_PIXELFORMAT_ARGB8888, seen.pixels().data(),
                             4 * seen.width()) != 0)
      return Error{error("the window's picture cannot be read")};
    for (std::uint32_t& pixel : seen.pixels()) pixel |= 0xFF000000U;
    for (const std::string& name : names) {
      if (auto ok = write_png(*options_.pictures / (name + ".png"), seen); !ok) return ok;
      report_.pictures.push_back({name, frame, player_.state()});
    }
    return {};
  }

  // Limits the frame rate where vertical sync does not.
  void hold_back(Uint64 began) const {
    if (course_.scripted()) return;
    const double per_ms = static_cast<double>(SDL_GetPerformanceFrequency()) / 1000;
    const double took = static_cast<double>(SDL_GetPerformanceCounter() - began) / per_ms;
    const double least = synced_ ? kShortestFrameMs : 1000.0 / kFrameRate;
    if (took < least) SDL_Delay(static_cast<Uint32>(least - took + 0.5));
  }

  // Reduces the picture's size after about a second of slow frames.
  void draw_smaller(double milliseconds) {
    if (course_.scripted()) return;
    slow_ += (milliseconds - slow_) / 30;
    if (slow_ < kBudgetMs || max_pixels_ <= kMinPixels) return;
    max_pixels_ = std::max(kMinPixels, 0.7 * max_pixels_);
    slow_ = 0;
    fit_picture();
  }

  Player& player_;
  Course& course_;
  const PlayOptions& options_;
  Session session_;
  std::unique_ptr<SDL_Window, Destroy> window_;
  std::unique_ptr<SDL_Renderer, Destroy> renderer_;
  std::unique_ptr<SDL_Texture, Destroy> texture_;
  int texture_width_ = 0, texture_height_ = 0;
  Microphone microphone_;
  bool synced_ = false;
  bool hidden_ = false;
  Uint64 last_ = 0;
  double max_pixels_ = kMaxPixels;
  double slow_ = 0;
  PlayReport report_;
};

}  // namespace

bool has_window() { return true; }

Result<PlayReport> play_in_window(const PlayOptions& options) {
  auto player = Player::create(options.player);
  if (!player) return player.error();
  auto course = Course::open(options, *player);
  if (!course) return course.error();
  Window window(*player, *course, options);
  if (auto ok = window.open(); !ok) return ok.error();
  return window.run();
}

}  // namespace wisp::window
