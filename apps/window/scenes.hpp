#pragma once
// Scenes of the window: candles; endlessly falling leaves, which land, rest, and are kicked up by wind or start again
// above the picture (any chain whose view is a position or a pose); and models of plain numbers, as moving curves.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "event.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/draw/leaf_flock.hpp"
#include "wisp/draw/live_flames.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"
#include "wisp/run/random.hpp"

namespace wisp::window {

inline constexpr int kPolylinePoints = 96;
inline constexpr float kTrackStep = 1.0F / 120;
inline constexpr std::size_t kTrackSteps = 90;

// Speed of a gust along a row of candles, flame heights a second, and its loss per height. Real breath is too fast to
// see.
inline constexpr float kGustSpeed = 14;
inline constexpr float kGustLoss = 0.03F;

// Wind that corresponds to a candle or a pointer moving at one flame height a second.
inline constexpr float kWindPerSpeed = 0.11F;
inline constexpr float kPointerReach = 0.9F;  // flame heights
inline constexpr float kMaxPointerWind = 1.1F;

// Seconds in which gas rises by one flame height.
inline constexpr float kRiseSeconds = 0.085F;

// Apparent depth of a ring of candles seen from slightly above, as a share of the picture's width.
inline constexpr float kRingDepth = 0.07F;

inline constexpr float kClickPixels = 5;

inline FlameStyle style_of(int candles) {
  FlameStyle style;
  if (candles > 1) style.candle_width = 0.36F;
  return style;
}

class CandleScene {
 public:
  /// Errors: as Bank::create(). Precondition: the model's view is an outline; 1 <= candles <= kMaxCandles.
  static Result<CandleScene> create(const Model& model, int candles, std::uint64_t seed) {
    auto bank = Bank::create(model, {.capacity = candles, .seed = seed, .polyline_points = kPolylinePoints});
    if (!bank) return bank.error();
    return CandleScene(std::move(*bank), model, candles);
  }

  static constexpr int kMaxCandles = 12;

  /// The picture's size from now on.
  void resize(int width, int height) {
    width_ = width;
    height_ = height;
    painter_ = std::make_unique<LiveFlames>(width, height, style_of(candles()));
    arrange();
  }

  /// Wind over the whole scene from now on, 1 a strong gust to the right.
  void blow(float wind) { wind_ = wind; }

  /// A wind that extinguishes a candle of this model.
  // Well above the level of extinction, so that the flame goes out during the puff.
  float strong() const { return 1.7F * level_; }

  void pointer_moved(Point pixel) {
    pointer_ = pixel;
    if (carried_ && std::hypot(pixel.x - pressed_.x, pixel.y - pressed_.y) > kClickPixels) moved_ = true;
    // A carried candle makes its own wind.
    if (carried_) {
      wake_.leave();
    } else {
      wake_.move({pixel.x / unit_, pixel.y / unit_});
    }
  }
  void pointer_pressed(Point pixel) {
    pointer_ = pressed_ = pixel;
    moved_ = false;
    const int near = nearest(pixel);
    const Point base = candles_[static_cast<std::size_t>(near)].place;
    const bool at_candle = std::abs(pixel.x - base.x) < 0.45F * unit_ && pixel.y > base.y - 1.3F * unit_ &&
                           pixel.y < base.y + 2.4F * unit_;
    if (!at_candle) return;
    carried_ = near;
    grip_ = {base.x - pixel.x, base.y - pixel.y};
  }
  void pointer_released(Point pixel) {
    pointer_ = pixel;
    if (!moved_) {
      const Candle& candle = candles_[static_cast<std::size_t>(nearest(pixel))];
      relight(candle);
    }
    carried_.reset();
  }
  void relight_all() {
    for (const Candle& candle : candles_) relight(candle);
  }
  void reset() {
    bank_.reset();
    std::fill(winds_.begin(), winds_.end(), 0.0F);
    wake_ = {};
    arrange();
  }
  void set_noise(bool on) { bank_.set_noise(on ? 1.0F : 0.0F); }

  /// Advances the scene by `time`.
  void advance(std::chrono::nanoseconds time) {
    const float seconds = std::chrono::duration<float>(time).count();
    wake_.advance(seconds);
    remember_wind(seconds);
    std::vector<float> inputs(static_cast<std::size_t>(bank_.input_count()));
    for (Candle& candle : candles_) {
      candle.wind = felt_wind(candle);
      if (!inputs.empty()) {
        inputs[wind_input_] = candle.wind;
        bank_.set_inputs(candle.id, inputs);
      }
    }
    bank_.advance(time);
    for (Candle& candle : candles_) {
      candle.smoke.blow(candle.wind, state_of(candle), bank_.step_time(), candle.scene);
    }
  }

  void draw(Image& image) {
    std::vector<std::vector<Point>> outlines;
    outlines.reserve(candles_.size());  // flames point into it
    std::vector<int> order(candles_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return candles_[static_cast<std::size_t>(a)].place.y < candles_[static_cast<std::size_t>(b)].place.y;
    });
    std::vector<Flame> flames;
    for (int k : order) {
      Candle& candle = candles_[static_cast<std::size_t>(k)];
      candle.scene.base = candle.place;
      show_state(state_of(candle), candle.scene);
      outlines.push_back(outline_of(candle));
      flames.push_back({outlines.back(), candle.scene});
    }
    if (flame_) {
      painter_->draw(image, flames);
    } else {
      draw_shapes(image, flames);
    }
  }

  int candles() const { return static_cast<int>(candles_.size()); }
  int burning() const {
    return static_cast<int>(
        std::count_if(candles_.begin(), candles_.end(), [&](const auto& c) { return state_of(c).lit; }));
  }

  /// Whether the model has a wind at all, and whether it can go out.
  bool feels_wind() const { return bank_.input_count() > 0; }
  bool goes_out() const { return bank_.extinction() != nullptr; }

  /// The x of the first candle's tip over its base, in flame heights; 0 where it is out.
  float tip() const {
    const Candle& candle = candles_.front();
    if (!state_of(candle).lit) return 0;
    std::vector<float> points(2 * kPolylinePoints);
    bank_.polyline(candle.id, points);
    std::size_t top = 0;
    for (std::size_t k = 1; k < kPolylinePoints; ++k) {
      if (points[2 * k + 1] > points[2 * top + 1]) top = k;
    }
    return points[2 * top];
  }

  /// How many outputs were clamped, of all.
  Bank::Clamped clamped() const { return bank_.clamped(); }

 private:
  struct Candle {
    InstanceId id;
    Point home{};   // pixel of the flame's base, unless carried
    Point place{};  // where it is
    FlameScene scene{};
    // Past places of the base, newest first, one each kTrackStep: hot gas rises from where it left the wick.
    std::vector<Point> track;
    SmokeDrift smoke;
    float wind = 0;
  };

  CandleScene(Bank bank, const Model& model, int candles) : bank_(std::move(bank)), flame_(is_flame(model)) {
    if (model.extinction) {
      wind_input_ = model.extinction->input;
      level_ = static_cast<float>(model.extinction->level);
    }
    for (int k = 0; k < candles; ++k) {
      Candle& candle = candles_.emplace_back();
      candle.id = bank_.spawn();
      candle.scene.seed = static_cast<std::uint64_t>(k) + 1;
    }
    winds_.assign(kTrackSteps, 0.0F);
    polyline_.resize(2 * kPolylinePoints);
    resize(width_, height_);
  }
  void arrange() {
    const FlameScene frame = framed(width_, height_);
    const int count = candles();
    const float spacing = 0.86F * static_cast<float>(width_) / static_cast<float>(count);
    unit_ = count == 1 ? frame.pixels_per_unit
                       : std::min({frame.pixels_per_unit * 0.62F, 1.35F * spacing, 0.3F * static_cast<float>(height_)});
    for (int k = 0; k < count; ++k) {
      Candle& candle = candles_[static_cast<std::size_t>(k)];
      const float across = static_cast<float>(k) - 0.5F * static_cast<float>(count - 1);
      candle.home = {frame.base.x + spacing * across, frame.base.y};
      // In a ring as on a cake: alternately behind and in front, evenly spaced across the picture.
      if (count > 1) {
        const float turn = across / (0.5F * static_cast<float>(count));
        const float deep = std::sqrt(1 - turn * turn) * (k % 2 == 0 ? 1.0F : -1.0F);
        candle.home.y += std::min(kRingDepth * static_cast<float>(width_), 0.5F * unit_) * deep;
      }
      candle.place = candle.home;
      candle.scene.pixels_per_unit = unit_;
      candle.track.assign(kTrackSteps, candle.home);
    }
    carried_.reset();
  }
  void remember_wind(float seconds) {
    for (passed_ += seconds; passed_ >= kTrackStep; passed_ -= kTrackStep) {
      carry(kTrackStep);
      std::rotate(winds_.begin(), winds_.end() - 1, winds_.end());
      for (Candle& candle : candles_) {
        std::rotate(candle.track.begin(), candle.track.end() - 1, candle.track.end());
        candle.track[0] = candle.place;
      }
      winds_[0] = wind_;
    }
    // The first candle feels the present wind, not that of the last whole step.
    winds_[0] = wind_;
  }
  // The wind at a candle: later and weaker along the row.
  float heard_wind(const Candle& candle) const {
    const float edge = wind_ < 0 ? candles_.back().place.x : candles_.front().place.x;
    const float away = candles() > 1 ? std::abs(candle.place.x - edge) / unit_ : 0;
    const auto back = static_cast<std::size_t>(away / kGustSpeed / kTrackStep);
    return winds_[std::min(back, kTrackSteps - 1)] * std::max(0.5F, 1 - kGustLoss * away);
  }
  float felt_wind(const Candle& candle) const {
    float wind = heard_wind(candle);
    // The pointer's wake acts half a flame height above the base.
    const float dx = wake_.at().x - candle.place.x / unit_;
    const float dy = wake_.at().y - (candle.place.y / unit_ - 0.5F);
    const float near = std::exp(-(dx * dx + dy * dy) / (kPointerReach * kPointerReach));
    wind += std::clamp(kWindPerSpeed * wake_.speed().x, -kMaxPointerWind, kMaxPointerWind) * near;
    const float carried = (candle.track[0].x - candle.track[6].x) / unit_ / (6 * kTrackStep);
    return wind - kWindPerSpeed * carried;
  }
  void carry(float seconds) {
    for (int k = 0; k < candles(); ++k) {
      Candle& candle = candles_[static_cast<std::size_t>(k)];
      if (carried_ != k || !moved_) continue;
      const Point to{
          std::clamp(pointer_.x + grip_.x, 0.0F, static_cast<float>(width_)),
          std::clamp(pointer_.y + grip_.y, 0.35F * static_cast<float>(height_), 0.97F * static_cast<float>(height_))};
      // The candle follows the pointer with a short delay, as a hand would.
      const float share = 1 - std::exp(-seconds / 0.03F);
      candle.place = {candle.place.x + share * (to.x - candle.place.x),
                      candle.place.y + share * (to.y - candle.place.y)};
    }
  }
  std::vector<Point> outline_of(const Candle& candle) {
    bank_.polyline(candle.id, polyline_);
    std::vector<Point> points(kPolylinePoints);
    for (std::size_t k = 0; k < points.size(); ++k) {
      Point p{polyline_[2 * k], polyline_[2 * k + 1]};
      // Gas at this height left the wick some time ago, where the wick then was.
      const float back = std::max(0.0F, p.y) * kRiseSeconds / kTrackStep;
      const auto at = std::min(static_cast<std::size_t>(back), kTrackSteps - 2);
      const float part = std::min(1.0F, back - static_cast<float>(at));
      const float was = candle.track[at].x + part * (candle.track[at + 1].x - candle.track[at].x);
      p.x += (was - candle.track[0].x) / unit_;
      points[k] = p;
    }
    return points;
  }
  int nearest(Point pixel) const {
    int best = 0;
    float least = 1e30F;
    for (int k = 0; k < candles(); ++k) {
      const float away = std::abs(candles_[static_cast<std::size_t>(k)].place.x - pixel.x);
      if (away < least) best = k, least = away;
    }
    return best;
  }
  void relight(const Candle& candle) {
    if (ExtinctionFacet* extinction = bank_.extinction()) extinction->relight(candle.id);
  }
  LitState state_of(const Candle& candle) const {
    const ExtinctionFacet* extinction = bank_.extinction();
    return extinction ? *extinction->state_of(candle.id) : LitState{};
  }

  Bank bank_;
  bool flame_;  // otherwise drawn as a plain shape
  std::size_t wind_input_ = 0;
  float level_ = 2;
  std::vector<Candle> candles_;
  int width_ = 1280, height_ = 800;
  float unit_ = 300;
  float wind_ = 0;
  std::vector<float> winds_;  // past winds of the scene, newest first, one each kTrackStep
  float passed_ = 0;          // seconds passed of the current kTrackStep
  PointerWake wake_;
  Point pointer_{};
  Point pressed_{};
  std::optional<int> carried_;
  Point grip_{};  // from the pointer to the carried candle's base
  bool moved_ = false;
  std::unique_ptr<LiveFlames> painter_;
  std::vector<float> polyline_;
};

// Height of the visible room, metres.
inline constexpr float kViewHeight = 1.5F;
inline constexpr float kDepth = 0.55F;       // leaves fall this far before and behind the middle
inline constexpr float kAbove = 0.12F;       // over the picture's upper edge
inline constexpr float kShownLarger = 1.5F;  // a leaf in a room is a few pixels
inline constexpr float kLift = 0.006F;       // over the floor, so that the floor does not cut a resting leaf

inline constexpr float kGustMetres = 1.6F;  // metres a second of a wind of 1

inline constexpr float kPointerMetres = 0.22F;  // metres around the pointer that feel it
inline constexpr float kMaxWake = 2.5F;         // metres a second
inline constexpr float kKicking = 0.55F;        // wind that lifts a resting leaf, metres a second
inline constexpr int kMaxKicks = 40;            // a frame, since each searches all segments
inline constexpr float kMinRest = 1.5F;         // seconds on the ground before it begins again
inline constexpr float kMoreRest = 4;
inline constexpr float kFade = 0.6F;    // seconds of fading out before a restart
inline constexpr float kCatch = 0.25F;  // seconds of fading in

inline float room_width(int width, int height) {
  return kViewHeight * static_cast<float>(width) / static_cast<float>(height);
}

inline void put(Bank& bank, int slot, const BodyMoment& body) {
  if (ChainFacet* chain = bank.chain()) chain->place(bank.at(slot), body);
}

class LeafScene {
 public:
  /// Errors: as Bank::create(). Precondition: the model's view is a pose or a position; 1 <= leaves <= kMaxLeaves.
  static Result<LeafScene> create(const Model& model, int leaves, std::uint64_t seed) {
    auto bank = Bank::create(model, {.capacity = kMaxLeaves, .seed = seed});
    if (!bank) return bank.error();
    LeafScene scene(std::move(*bank), model, seed);
    scene.set_leaves(leaves);
    return scene;
  }

  static constexpr int kMaxLeaves = 1000;

  void resize(int width, int height) {
    width_ = width;
    height_ = height;
    painter_ = std::make_unique<LeafFlock>(width, height, leaf_camera_from_side(kViewHeight), style_);
  }

  /// Wind over the whole scene from now on, 1 a strong gust to the right.
  void blow(float wind) { wind_ = wind; }

  void pointer_moved(Point pixel) {
    pointer_ = pixel;
    const float metre = painter_->pixels_per_metre();
    wake_.move({pixel.x / metre, -pixel.y / metre});
  }

  /// Kicks up the leaves that lie near the pixel.
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
      // A resting leaf is bent and stands on its rim.
      leaf.pose.position[2] = std::max(leaf.pose.position[2], kLift);
      leaves.push_back(leaf);
    }
    painter_->draw(image, leaves);
  }

  /// Whether wind moves leaves in the air. Resting leaves are kicked up in any case.
  bool feels_wind() const { return bank_.input_count() >= 3; }

  /// Leaves that lie on the ground.
  int resting() const {
    return static_cast<int>(std::count_if(lives_.begin(), lives_.end(), [](const Life& l) { return l.rested > 0; }));
  }

  Bank::Clamped clamped() const { return bank_.clamped(); }

 private:
  // State of a leaf that the bank does not hold.
  struct Life {
    std::array<float, 3> last{};  // where it was shown last
    std::array<float, 4> attitude{1, 0, 0, 0};
    float rested = 0;    // seconds without moving on the ground
    float patience = 8;  // seconds that it rests before it begins again above
    float age = 0;       // seconds since it began
    std::uint8_t look = 0;
    float size = 1;
  };

  LeafScene(Bank bank, const Model& model, std::uint64_t seed) : bank_(std::move(bank)), seed_(seed) {
    poses_ = bank_.output_count() >= 7;
    // A leaf's long axis is the body's x, across which the pose has its half width.
    if (const auto* pose = std::get_if<PoseView>(&model.view)) {
      if (pose->half_width > 0) style_.length = static_cast<float>(2 * pose->half_width);
      if (pose->half_length > 0) style_.width = static_cast<float>(2 * pose->half_length);
    }
    style_.length *= kShownLarger;
    style_.width *= kShownLarger;
    set_ground(true);
    resize(width_, height_);
  }
  // A random number in [0, 1) of the scene's own stream.
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
    put(bank_, slot, body);
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
    // The floor turns wind upwards.
    body.velocity = {(0.5F + 0.3F * chance()) * wind[0], wind[1] + 0.5F * (chance() - 0.5F) * strength,
                     (0.55F + 0.7F * chance()) * strength};
    body.spin = {6 * (chance() - 0.5F), 6 * (chance() - 0.5F), 5 * (chance() - 0.5F)};
    put(bank_, slot, body);
    life.rested = 0;
    life.patience = kMinRest + kMoreRest * chance();
  }

  Bank bank_;
  bool poses_ = true;  // of 7 outputs; else positions only
  LeafStyle style_;
  std::uint64_t seed_ = 1, drawn_ = 0;
  bool ground_ = true;
  int width_ = 1280, height_ = 800;
  float wind_ = 0;
  float seconds_ = 0;
  PointerWake wake_;
  Point pointer_{};
  int kicks_ = 0;  // of this frame
  std::vector<Life> lives_;
  std::vector<float> outputs_, inputs_;
  std::unique_ptr<LeafFlock> painter_;
};

inline constexpr std::size_t kKept = 480;      // values of a curve, one a frame
inline constexpr std::size_t kMaxCurves = 12;  // more could not be distinguished
inline constexpr Colour kPlotGround{16, 17, 22};
inline constexpr std::array<Colour, 6> kPlotPalette{
    {{86, 180, 233}, {240, 228, 66}, {0, 158, 115}, {230, 159, 0}, {204, 121, 167}, {213, 94, 0}}};

class PlotScene {
 public:
  /// Errors: as Bank::create().
  static Result<PlotScene> create(const Model& model, std::uint64_t seed) {
    auto bank = Bank::create(model, {.capacity = 1, .seed = seed});
    if (!bank) return bank.error();
    bank->spawn();
    return PlotScene(std::move(*bank), model);
  }

  void resize(int width, int height) { width_ = width, height_ = height; }

  /// Moves every input through its trained range: 0 is its middle, −1 and 1 its ends.
  void blow(float wind) { wind_ = wind; }

  void reset() {
    bank_.reset();
    for (auto* curves : {&inputs_, &outputs_}) {
      for (Curve& curve : *curves) curve.values.clear();
    }
  }
  void set_noise(bool on) { bank_.set_noise(on ? 1.0F : 0.0F); }
  void advance(std::chrono::nanoseconds time) {
    std::vector<float> values;
    for (Curve& input : inputs_) {
      const double middle = (input.lowest + input.highest) / 2, half = (input.highest - input.lowest) / 2;
      values.push_back(static_cast<float>(middle + half * static_cast<double>(std::clamp(wind_, -1.5F, 1.5F))));
      keep(input, values.back());
    }
    if (!values.empty()) bank_.set_common_inputs(values);
    bank_.advance(time);
    std::vector<float> outputs(static_cast<std::size_t>(bank_.slots()) * bank_.output_count());
    bank_.outputs(outputs);
    for (std::size_t k = 0; k < outputs_.size(); ++k) keep(outputs_[k], outputs[k]);
  }
  void draw(Image& image) {
    image = Image(width_, height_, kPlotGround);
    std::vector<const Curve*> shown;
    for (const Curve& curve : inputs_) shown.push_back(&curve);
    for (const Curve& curve : outputs_) shown.push_back(&curve);
    shown.resize(std::min(shown.size(), kMaxCurves));
    std::vector<LegendEntry> legend;
    const float margin = 0.06F * static_cast<float>(height_);
    const float band = (static_cast<float>(height_) - 2 * margin) / static_cast<float>(shown.size());
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const Curve& curve = *shown[k];
      const LineStyle style{.colour = kPlotPalette[k % kPlotPalette.size()], .width = 2, .closed = false, .casing = 0};
      const double range = std::max(1e-9, curve.highest - curve.lowest);
      const float bottom = margin + band * static_cast<float>(k + 1) - 0.12F * band;
      std::vector<Point> line;
      for (std::size_t at = 0; at < curve.values.size(); ++at) {
        const std::size_t age = curve.values.size() - 1 - at;
        const double share = (static_cast<double>(curve.values[at]) - curve.lowest) / range;
        line.push_back({static_cast<float>(width_) * (0.97F - 0.94F * static_cast<float>(age) / kKept),
                        bottom - 0.76F * band * static_cast<float>(share)});
      }
      draw_outline(image, line, style);
      legend.push_back({curve.name + (k < inputs_.size() ? " (in)" : ""), style});
    }
    draw_legend(image, legend, Corner::kTopLeft);
  }
  Bank::Clamped clamped() const { return bank_.clamped(); }

 private:
  struct Curve {
    std::string name;
    double lowest = 0, highest = 1;
    std::deque<float> values;  // oldest first
  };

  PlotScene(Bank bank, const Model& model) : bank_(std::move(bank)) {
    for (const Input& input : model.inputs) inputs_.push_back({input.name, input.lowest, input.highest, {}});
    for (const Output& output : model.outputs) outputs_.push_back({output.name, output.lowest, output.highest, {}});
  }
  void keep(Curve& curve, float value) const {
    curve.values.push_back(value);
    if (curve.values.size() > kKept) curve.values.pop_front();
  }

  Bank bank_;
  std::vector<Curve> inputs_, outputs_;
  int width_ = 1280, height_ = 800;
  float wind_ = 0;
};

}  // namespace wisp::window
