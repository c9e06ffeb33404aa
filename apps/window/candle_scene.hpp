#pragma once
// Candles in the window: a row or a cake, with wind from the microphone, the pointer and carrying.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "event.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/draw/live_flames.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::window {

inline constexpr int kPolylinePoints = 96;
inline constexpr float kTrackStep = 1.0F / 120;
inline constexpr std::size_t kTrackSteps = 90;

// Speed of a gust along a row of candles, flame heights per second (slower than real breath, so that gusts are seen to
// move), and the share of the wind lost per flame height.
inline constexpr float kGustSpeed = 14;
inline constexpr float kGustLoss = 0.03F;

// Wind on a candle that moves, or from a pointer that moves, at one flame height per second.
inline constexpr float kWindPerSpeed = 0.11F;
inline constexpr float kPointerReach = 0.9F;  // radius of the wind from the pointer, flame heights
inline constexpr float kMaxPointerWind = 1.1F;

// Seconds in which gas rises by one flame height.
inline constexpr float kRiseSeconds = 0.085F;

// Apparent depth of a ring of candles seen from slightly above, as a share of the picture's width.
inline constexpr float kRingDepth = 0.07F;

inline constexpr float kClickPixels = 5;

class CandleScene {
 public:
  /// Errors: as Bank::create(). Precondition: the model's view is an outline; 1 <= candles <= kMaxCandles.
  static Result<CandleScene> create(const Model& model, int candles, std::uint64_t seed) {
    const auto round = in_the_round(model);
    auto bank =
        Bank::create(round ? *round : model, {.capacity = candles, .seed = seed, .polyline_points = kPolylinePoints});
    if (!bank) return bank.error();
    return CandleScene(std::move(*bank), model, candles);
  }

  static constexpr int kMaxCandles = 12;

  /// Sets the picture's size. Pointer and candles keep their places in it, and a drag goes on.
  void resize(int width, int height) {
    const Point scale{static_cast<float>(width) / static_cast<float>(std::exchange(width_, width)),
                      static_cast<float>(height) / static_cast<float>(std::exchange(height_, height))};
    for (Point* at : {&pointer_, &pressed_, &grip_}) *at = {scale.x * at->x, scale.y * at->y};
    wake_.leave();  // its last place is in the former picture's unit
    painter_ = std::make_unique<LiveFlames>(width, height, style_);
    arrange(scale);
  }

  /// Sets the wind over the whole scene; 1 is a strong gust to the right.
  void blow(float wind) { wind_ = wind; }

  /// Sets the share of the wind that blows away from the viewer instead of to the right; only if the flame is a body.
  void blow_away(float share) { away_ = bank_.body() ? share : 0; }

  /// Turns the viewer around the candles, by `angle` in radians, anticlockwise from above; only if they are bodies.
  void turn(float angle) {
    if (!bank_.body()) return;
    azimuth_ += angle;
    bank_.body()->look(std::cos(azimuth_), -std::sin(azimuth_));
    if (candles() > 1) arrange();
  }

  /// Returns a wind that extinguishes a candle of this model.
  // The wind is well above the level of extinction, so that the flame is extinguished during a puff.
  float strong() const { return 1.7F * level_; }

  void pointer_moved(Point pixel) {
    if (turning_) turn((pointer_.x - pixel.x) / static_cast<float>(width_) * 3.1415927F);
    pointer_ = pixel;
    if (std::hypot(pixel.x - pressed_.x, pixel.y - pressed_.y) > kClickPixels) moved_ = true;  // no click
    // The wind on a carried candle comes from the candle's own motion.
    if (turning_ || carried_) return wake_.leave();
    wake_.move({pixel.x / unit_, pixel.y / unit_});
  }
  void pointer_left() { wake_.leave(); }
  void pointer_pressed(Point pixel) {
    pointer_ = pressed_ = pixel;
    moved_ = false;
    const int near = nearest(pixel);
    const Point base = candles_[static_cast<std::size_t>(near)].place;
    const bool at_candle = std::abs(pixel.x - base.x) < 0.45F * unit_ && pixel.y > base.y - 1.3F * unit_ &&
                           pixel.y < base.y + 2.4F * unit_;
    turning_ = !at_candle;
    if (turning_) return;
    carried_ = near;
    grip_ = {base.x - pixel.x, base.y - pixel.y};
  }
  void pointer_released(Point pixel) {
    pointer_ = pixel;
    if (!moved_) relight(candles_[static_cast<std::size_t>(nearest(pixel, true))]);
    carried_.reset();
    turning_ = false;
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

  void advance(std::chrono::nanoseconds time) {
    const float seconds = std::chrono::duration<float>(time).count();
    wake_.advance(seconds);
    remember_wind(seconds);
    std::vector<float> inputs(static_cast<std::size_t>(bank_.input_count()));
    for (Candle& candle : candles_) {
      candle.wind = felt_wind(candle);
      if (inputs.empty()) continue;
      const float away = away_ * heard_wind(candle), right = candle.wind - away;
      inputs[wind_input_] = right;
      if (bank_.body()) {
        inputs[0] = std::cos(azimuth_) * right - std::sin(azimuth_) * away;
        inputs[1] = -std::sin(azimuth_) * right - std::cos(azimuth_) * away;
      }
      bank_.set_inputs(candle.id, inputs);
    }
    bank_.advance(time);
    for (Candle& candle : candles_) candle.smoke.blow(candle.wind, state_of(candle), bank_.step_time(), candle.scene);
  }

  void draw(Image& image) {
    std::vector<std::vector<Point>> outlines;
    outlines.reserve(candles_.size());  // never reallocated, as `flames` refers to its elements
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

  bool goes_out() const { return bank_.extinction() != nullptr; }

  /// Returns the x of the first candle's tip relative to its base, in flame heights; 0 if the candle is out.
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

  /// Returns the number of steps of all candles, and of those in which an output was clamped.
  Bank::Clamped clamped() const { return bank_.clamped(); }

 private:
  struct Candle {
    InstanceId id;
    Point home{};   // pixel of the flame's base, unless carried
    Point place{};  // current pixel of the flame's base
    FlameScene scene{};
    // Past positions of the base, newest first, one per kTrackStep: hot gas rises from where it left the wick.
    std::vector<Point> track;
    SmokeDrift smoke;
    float wind = 0;
  };

  CandleScene(Bank bank, const Model& model, int candles)
      : bank_(std::move(bank)), flame_(is_flame(model)), style_(candle_style(model)) {
    if (candles > 1) style_.candle_width = 0.36F;
    if (model.extinction) {
      wind_input_ = model.extinction->input;
      level_ = static_cast<float>(model.extinction->level);
    }
    for (int k = 0; k < candles; ++k) {
      Candle& candle = candles_.emplace_back();
      candle.id = bank_.spawn();
      candle.scene.seed = static_cast<std::uint64_t>(k) + 1;
      candle.track.resize(kTrackSteps);
    }
    winds_.assign(kTrackSteps, 0.0F);
    polyline_.resize(2 * kPolylinePoints);
    resize(width_, height_);
  }
  // Puts the candles where they stand; `kept`: scale of the distances to which they were carried from there.
  void arrange(Point kept = {}) {
    const FlameScene frame = framed(width_, height_);
    const int count = candles();
    const float spacing = 0.86F * static_cast<float>(width_) / static_cast<float>(count);
    unit_ = count == 1 ? frame.pixels_per_unit
                       : std::min({frame.pixels_per_unit * 0.62F, 1.35F * spacing, 0.3F * static_cast<float>(height_)});
    for (int k = 0; k < count; ++k) {
      Candle& candle = candles_[static_cast<std::size_t>(k)];
      const float across = static_cast<float>(k) - 0.5F * static_cast<float>(count - 1);
      const Point from = candle.home;
      candle.home = {frame.base.x + spacing * across, frame.base.y};
      // On a cake, candles form a ring: alternately behind and in front, evenly spaced across the picture.
      if (count > 1) {
        const float turn = across / (0.5F * static_cast<float>(count));
        const float deep = std::sqrt(1 - turn * turn) * (k % 2 == 0 ? 1.0F : -1.0F);
        const float c = std::cos(azimuth_), s = std::sin(azimuth_);
        candle.home.x = frame.base.x + 0.5F * spacing * static_cast<float>(count) * (c * turn - s * deep);
        candle.home.y += std::min(kRingDepth * static_cast<float>(width_), 0.5F * unit_) * (s * turn + c * deep);
      }
      const auto moved = [&](Point at) {
        return Point{candle.home.x + kept.x * (at.x - from.x), candle.home.y + kept.y * (at.y - from.y)};
      };
      candle.place = moved(candle.place);
      for (Point& at : candle.track) at = moved(at);
      candle.scene.pixels_per_unit = unit_;
    }
    if (kept == Point{}) carried_.reset();
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
    // The first candle gets the present wind, not that of the last whole step.
    winds_[0] = wind_;
  }
  // Returns the wind at a candle: delayed and weaker along the row.
  float heard_wind(const Candle& candle) const {
    const auto by_x = [](const Candle& a, const Candle& b) { return a.place.x < b.place.x; };
    const auto [left, right] = std::minmax_element(candles_.begin(), candles_.end(), by_x);
    const float edge = wind_ < 0 ? right->place.x : left->place.x;
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
    if (!carried_ || !moved_) return;
    Point& place = candles_[static_cast<std::size_t>(*carried_)].place;
    const float tall = static_cast<float>(height_);
    const Point to{std::clamp(pointer_.x + grip_.x, 0.0F, static_cast<float>(width_)),
                   std::clamp(pointer_.y + grip_.y, 0.35F * tall, 0.97F * tall)};
    // The candle follows the pointer with a short delay, as a hand would.
    const float share = 1 - std::exp(-seconds / 0.03F);
    place = {place.x + share * (to.x - place.x), place.y + share * (to.y - place.y)};
  }
  std::vector<Point> outline_of(const Candle& candle) {
    bank_.polyline(candle.id, polyline_);
    std::vector<Point> points(kPolylinePoints);
    for (std::size_t k = 0; k < points.size(); ++k) {
      Point p{polyline_[2 * k], polyline_[2 * k + 1]};
      // Gas at this height left the wick earlier, at the wick's position then.
      const float back = std::max(0.0F, p.y) * kRiseSeconds / kTrackStep;
      const auto at = std::min(static_cast<std::size_t>(back), kTrackSteps - 2);
      const float part = std::min(1.0F, back - static_cast<float>(at));
      const float was = candle.track[at].x + part * (candle.track[at + 1].x - candle.track[at].x);
      p.x += (was - candle.track[0].x) / unit_;
      points[k] = p;
    }
    return points;
  }
  // Returns the candle nearest to a pixel, or of those that are out; of candles at one x, that of the nearest flame.
  int nearest(Point pixel, bool out = false) const {
    int best = 0;
    float least = 1e30F;
    for (int k = 0; k < candles(); ++k) {
      const Candle& candle = candles_[static_cast<std::size_t>(k)];
      const float below = candle.place.y - 0.5F * unit_ - pixel.y;
      const float away = std::abs(candle.place.x - pixel.x) + 0.1F * std::abs(below);
      if (away < least && !(out && state_of(candle).lit)) best = k, least = away;
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
  bool flame_;  // false: drawn as a plain shape
  FlameStyle style_;
  std::size_t wind_input_ = 0;
  float level_ = 2;
  std::vector<Candle> candles_;
  int width_ = 1280, height_ = 800;
  float unit_ = 300;
  float wind_ = 0, away_ = 0;
  float azimuth_ = 0;  // of the viewer, radians
  bool turning_ = false;
  std::vector<float> winds_;  // past winds of the scene, newest first, one per kTrackStep
  float passed_ = 0;          // elapsed seconds of the current kTrackStep
  PointerWake wake_;
  Point pointer_{};
  Point pressed_{};
  std::optional<int> carried_;
  Point grip_{};  // offset from the pointer to the carried candle's base
  bool moved_ = false;
  std::unique_ptr<LiveFlames> painter_;
  std::vector<float> polyline_;
};

}  // namespace wisp::window
