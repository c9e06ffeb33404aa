#pragma once
// Endlessly falling leaves in the window, which land, rest, and are kicked up by wind or restart above the picture: any
// chain whose view is a position or a pose.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "event.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/draw/leaf.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/random.hpp"

namespace wisp::window {

// Height of the visible room, metres.
inline constexpr float kViewHeight = 1.5F;
inline constexpr float kDepth = 0.55F;       // leaves fall within this distance before and behind the middle
inline constexpr float kAbove = 0.12F;       // least restart height above the picture's upper edge
inline constexpr float kShownLarger = 1.5F;  // scale factor of display: a leaf in a room is a few pixels
inline constexpr float kLift = 0.006F;       // height above the floor, so that the floor does not cut a resting leaf

inline constexpr float kGustMetres = 1.6F;  // metres per second at wind 1

inline constexpr float kPointerMetres = 0.22F;  // radius of the pointer's wind, metres
inline constexpr float kMaxWake = 2.5F;         // maximum wind from the pointer, metres per second
inline constexpr float kKicking = 0.55F;  // wind that lifts a resting leaf, metres per second, × 0.8 … 1.5 by leaf
inline constexpr int kMaxKicks = 40;      // maximum leaves lifted per frame, as each searches the whole chain
inline constexpr float kMinRest = 1.5F;   // least seconds on the ground before a restart
inline constexpr float kMoreRest = 4;     // largest random addition to kMinRest, seconds
inline constexpr float kFade = 0.6F;      // seconds of fading out before a restart
inline constexpr float kCatch = 0.25F;    // seconds of fading in

inline float room_width(int width, int height) {
  return kViewHeight * static_cast<float>(width) / static_cast<float>(height);
}

class LeafScene {
 public:
  /// Errors: as Bank::create(). Precondition: the view is a pose or a position; 1 <= leaves <= kMaxLeaves.
  static Result<LeafScene> create(const Model& model, int leaves, std::uint64_t seed) {
    auto bank = Bank::create(model, {.capacity = kMaxLeaves, .seed = seed});
    if (!bank) return bank.error();
    LeafScene scene(std::move(*bank), model, seed);
    scene.set_leaves(leaves);
    return scene;
  }

  static constexpr int kMaxLeaves = 1000;

  void resize(int width, int height) {
    width_ = width, height_ = height;
    wake_.leave();  // its last place is in the former picture's unit
    painter_ = std::make_unique<LeafFlock>(width, height, leaf_camera_from_side(kViewHeight), style_);
  }

  /// Sets the wind over the whole scene; 1 is a strong gust to the right.
  void blow(float wind) { wind_ = wind; }

  void pointer_moved(Point pixel) {
    pointer_ = pixel;
    const float metre = painter_->pixels_per_metre();
    wake_.move({pixel.x / metre, -pixel.y / metre});
  }

  void pointer_left() { wake_.leave(); }
  void pointer_released(Point) {}

  /// Kicks up the leaves near the pixel.
  void pointer_pressed(Point pixel) {
    pointer_moved(pixel);
    for (int slot = 0; slot < bank_.slots(); ++slot) {
      const Life& life = lives_[static_cast<std::size_t>(slot)];
      const auto at = painter_->pixel_of(life.last);
      if (!at || life.last[2] > 0.05F) continue;
      const float away = std::hypot(at->x - pixel.x, at->y - pixel.y) / painter_->pixels_per_metre();
      if (away < kPointerMetres) kick(slot, {1.2F * (chance() - 0.5F), 0.6F * (chance() - 0.5F), 1.2F});
    }
  }

  void reset() {
    bank_.reset();
    wake_ = {};
    for (int slot = 0; slot < bank_.slots(); ++slot) begin(slot, true);
    read_poses();
  }
  void set_noise(bool on) { bank_.set_noise(on ? 1.0F : 0.0F); }
  void set_ground(bool there) {
    ground_ = there;
    if (ChainFacet* chain = bank_.chain()) chain->set_ground(there ? std::optional<float>(kLift) : std::nullopt);
  }
  bool ground() const { return ground_; }
  void set_leaves(int count) {
    count = std::clamp(count, 1, kMaxLeaves);
    while (bank_.size() > count) bank_.end(bank_.at(bank_.slots() - 1));
    while (bank_.size() < count) {
      const int slot = static_cast<int>(bank_.spawn().slot);
      lives_.resize(static_cast<std::size_t>(bank_.slots()));
      Life& life = lives_[static_cast<std::size_t>(slot)];
      life.look = static_cast<std::uint8_t>(slot);
      life.size = 0.8F + 0.4F * chance();
      begin(slot, true);
    }
    lives_.resize(static_cast<std::size_t>(bank_.slots()));
    read_poses();
  }
  int leaves() const { return bank_.size(); }

  void advance(std::chrono::nanoseconds time) {
    const float seconds = std::chrono::duration<float>(time).count();
    seconds_ += seconds;
    kicks_ = 0;
    wake_.advance(seconds);
    const auto each = static_cast<std::size_t>(bank_.input_count());
    inputs_.assign(static_cast<std::size_t>(bank_.slots()) * each, 0.0F);
    for (int slot = 0; slot < bank_.slots(); ++slot) {
      const Life& life = lives_[static_cast<std::size_t>(slot)];
      const auto wind = wind_at(life.last);
      if (each >= 3) std::copy(wind.begin(), wind.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(slot * each));
      if (life.rested > 0 && std::hypot(wind[0], wind[2]) > kKicking * (0.8F + 0.8F * static_cast<float>(slot % 7) / 7))
        kick(slot, wind);
    }
    if (each > 0) bank_.set_inputs(inputs_);
    bank_.advance(time);
    read_poses();
    for (int slot = 0; slot < bank_.slots(); ++slot) renew(slot, seconds);
  }
  void draw(Image& image) {
    std::vector<FlockLeaf> leaves;
    leaves.reserve(lives_.size());
    for (const Life& life : lives_) {
      const float going = std::clamp((life.patience - life.rested) / kFade, 0.0F, 1.0F);
      const float coming = std::clamp(life.age / kCatch, 0.0F, 1.0F);
      FlockLeaf leaf{{life.last, life.attitude}, life.look, life.size, going * coming};
      // A resting leaf is curved and touches the floor with its rim, so its middle is above the floor.
      leaf.pose.position[2] = std::max(leaf.pose.position[2], kLift);
      leaves.push_back(leaf);
    }
    painter_->draw(image, leaves);
  }

  /// Returns the number of leaves on the ground.
  int resting() const {
    return static_cast<int>(std::count_if(lives_.begin(), lives_.end(), [](const Life& l) { return l.rested > 0; }));
  }

  Bank::Clamped clamped() const { return bank_.clamped(); }

 private:
  // State of a leaf in addition to its state in the bank.
  struct Life {
    std::array<float, 3> last{};  // last displayed position
    std::array<float, 4> attitude{1, 0, 0, 0};
    float rested = 0;    // seconds without moving on the ground
    float patience = 8;  // seconds of rest before it restarts above
    float age = 0;       // seconds since its start
    std::uint8_t look = 0;
    float size = 1;
  };

  LeafScene(Bank bank, const Model& model, std::uint64_t seed) : bank_(std::move(bank)), seed_(seed) {
    poses_ = bank_.output_count() >= 7;
    // A leaf's long axis is the body's x, to which the view's half width refers.
    if (const auto* pose = std::get_if<PoseView>(&model.view)) {
      if (pose->half_width > 0) style_.length = static_cast<float>(2 * pose->half_width);
      if (pose->half_length > 0) style_.width = static_cast<float>(2 * pose->half_length);
    }
    style_.length *= kShownLarger;
    style_.width *= kShownLarger;
    set_ground(true);
    resize(width_, height_);
  }
  // Returns a random number in [0, 1) of the scene's own stream.
  float chance() {
    const std::uint32_t word = random_words({.seed = seed_, .stream = 0x1EAF, .step = drawn_++})[0];
    return static_cast<float>(word >> 8) / 16777216.0F;
  }
  // Starts a leaf above the picture, or anywhere in the air.
  void begin(int slot, bool anywhere) {
    const float half = 0.62F * room_width(width_, height_);
    BodyMoment body;
    body.position = {half * (2 * chance() - 1), kDepth * (2 * chance() - 1),
                     anywhere ? 0.15F + 4 * chance() : kViewHeight + kAbove + 0.5F * chance()};
    const float turn = 6.2831853F * chance(), tilt = 0.6F * (chance() - 0.5F);
    body.orientation = {std::cos(turn / 2), tilt, 0, std::sin(turn / 2)};
    body.velocity = {0.3F * (chance() - 0.5F), 0.3F * (chance() - 0.5F), -0.5F};
    if (ChainFacet* chain = bank_.chain()) chain->place(bank_.at(slot), body);
    Life& life = lives_[static_cast<std::size_t>(slot)];
    life = {body.position, body.orientation, 0, kMinRest + kMoreRest * chance(), 0, life.look, life.size};
  }
  std::array<float, 3> wind_at(const std::array<float, 3>& place) const {
    std::array<float, 3> wind{kGustMetres * wind_, 0, 0};
    // Eddies, so that a gust is not uniform.
    const float eddy = std::sin(3.1F * place[0] - 7.7F * seconds_ + 2.3F * place[1]) +
                       std::sin(5.3F * place[2] + 4.1F * seconds_ - 3.7F * place[1]);
    wind[0] *= 1 + 0.22F * eddy;
    wind[2] = 0.10F * kGustMetres * std::abs(wind_) * (1 + eddy);
    const auto at = painter_->pixel_of(place);
    if (!at) return wind;
    const float metre = painter_->pixels_per_metre();
    const float dx = (at->x - pointer_.x) / metre, dy = (at->y - pointer_.y) / metre;
    const float near = std::exp(-(dx * dx + dy * dy) / (kPointerMetres * kPointerMetres));
    const Point speed = wake_.speed();
    const float size = std::hypot(speed.x, speed.y);
    const float held = size > kMaxWake ? kMaxWake / size : 1;
    wind[0] += near * held * speed.x;
    wind[2] += near * held * speed.y;
    return wind;
  }
  void read_poses() {
    outputs_.resize(static_cast<std::size_t>(bank_.slots()) * bank_.output_count());
    bank_.outputs(outputs_);
  }
  // Restarts a leaf that has rested long enough or left the view.
  void renew(int slot, float seconds) {
    Life& life = lives_[static_cast<std::size_t>(slot)];
    const float* row = outputs_.data() + static_cast<std::ptrdiff_t>(slot) * bank_.output_count();
    const std::array<float, 3> now{row[0], row[1], row[2]};
    const float moved =
        std::abs(now[0] - life.last[0]) + std::abs(now[1] - life.last[1]) + std::abs(now[2] - life.last[2]);
    const bool lies = ground_ && now[2] < 2 * kLift && moved < 1e-5F;
    life.rested = lies ? life.rested + seconds : 0;
    life.last = now;
    if (poses_) life.attitude = {row[3], row[4], row[5], row[6]};
    life.age += seconds;
    const float half = 0.75F * room_width(width_, height_) + 0.3F;
    const bool gone = now[2] < -0.5F || now[2] > 6 || std::abs(now[0]) > half || std::abs(now[1]) > 2.2F;
    if (gone || life.rested > life.patience) begin(slot, false);
  }
  void kick(int slot, const std::array<float, 3>& wind) {
    if (++kicks_ > kMaxKicks) return;
    Life& life = lives_[static_cast<std::size_t>(slot)];
    BodyMoment body;
    body.position = {life.last[0], life.last[1], kLift + 0.02F};
    body.orientation = life.attitude;
    const float strength = std::hypot(wind[0], wind[1], wind[2]);
    // The floor deflects wind upwards.
    body.velocity = {(0.5F + 0.3F * chance()) * wind[0], wind[1] + 0.5F * (chance() - 0.5F) * strength,
                     (0.55F + 0.7F * chance()) * strength};
    body.spin = {6 * (chance() - 0.5F), 6 * (chance() - 0.5F), 5 * (chance() - 0.5F)};
    if (ChainFacet* chain = bank_.chain()) chain->place(bank_.at(slot), body);
    life.rested = 0;
    life.patience = kMinRest + kMoreRest * chance();
  }

  Bank bank_;
  bool poses_ = true;  // 7 outputs; else positions only
  LeafStyle style_;
  std::uint64_t seed_ = 1, drawn_ = 0;
  bool ground_ = true;
  int width_ = 1280, height_ = 800;
  float wind_ = 0;
  float seconds_ = 0;
  PointerWake wake_;
  Point pointer_{};
  int kicks_ = 0;  // kicks in this frame
  std::vector<Life> lives_;
  std::vector<float> outputs_, inputs_;
  std::unique_ptr<LeafFlock> painter_;
};

}  // namespace wisp::window
