#pragma once
// Candles in a dark room: one, or several on a cake. Wind from the left reaches the leftmost candle first; the flame of
// a carried candle trails behind it; an extinguished candle smokes, and a click lights it.

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "gusts.hpp"
#include "wisp/draw/live_flames.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::window {

class CandleScene {
 public:
  /// Errors: as Bank::create(). Precondition: the model's view is an outline; 1 <= candles <= kMaxCandles.
  static Result<CandleScene> create(const Model& model, int candles, std::uint64_t seed);

  static constexpr int kMaxCandles = 12;

  /// The picture's size from now on.
  void resize(int width, int height);

  /// Wind over the whole scene from now on, 1 a strong gust to the right.
  void blow(float wind) { wind_ = wind; }

  /// A wind that extinguishes a candle of this model.
  float strong() const;

  void pointer_moved(Point pixel);
  void pointer_pressed(Point pixel);
  void pointer_released(Point pixel);
  void relight_all();
  void reset();
  void set_noise(bool on) { bank_.set_noise(on ? 1.0F : 0.0F); }

  /// Advances the scene by `time`.
  void advance(std::chrono::nanoseconds time);

  void draw(Image& image);

  int candles() const { return static_cast<int>(candles_.size()); }
  int burning() const;

  /// Whether the model has a wind at all, and whether it can go out.
  bool feels_wind() const { return bank_.input_count() > 0; }
  bool goes_out() const { return bank_.extinction() != nullptr; }

  /// The x of the first candle's tip over its base, in flame heights; 0 where it is out.
  float tip() const;

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

  CandleScene(Bank bank, const Model& model, int candles);
  void arrange();
  void remember_wind(float seconds);
  float heard_wind(const Candle& candle) const;
  float felt_wind(const Candle& candle) const;
  void carry(float seconds);
  std::vector<Point> outline_of(const Candle& candle);
  int nearest(Point pixel) const;
  void relight(const Candle& candle);
  LitState state_of(const Candle& candle) const;

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

}  // namespace wisp::window
