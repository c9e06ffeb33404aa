#pragma once
// Endlessly falling leaves: they land, rest, and are kicked up by wind or start again above the picture. Works for any
// chain whose view is a position or a pose.

#include <chrono>
#include <memory>
#include <vector>

#include "gusts.hpp"
#include "wisp/draw/leaf_flock.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::window {

class LeafScene {
 public:
  /// Errors: as Bank::create(). Precondition: the model's view is a pose or a position; 1 <= leaves <= kMaxLeaves.
  static Result<LeafScene> create(const Model& model, int leaves, std::uint64_t seed);

  static constexpr int kMaxLeaves = 1000;

  void resize(int width, int height);

  /// Wind over the whole scene from now on, 1 a strong gust to the right.
  void blow(float wind) { wind_ = wind; }

  void pointer_moved(Point pixel);

  /// Kicks up the leaves that lie near the pixel.
  void pointer_pressed(Point pixel);

  void reset();
  void set_noise(bool on) { bank_.set_noise(on ? 1.0F : 0.0F); }
  void set_ground(bool there);
  bool ground() const { return ground_; }
  void set_leaves(int count);
  int leaves() const { return bank_.size(); }

  void advance(std::chrono::nanoseconds time);
  void draw(Image& image);

  /// Whether wind moves leaves in the air. Resting leaves are kicked up in any case.
  bool feels_wind() const { return bank_.input_count() >= 3; }

  /// Leaves that lie on the ground.
  int resting() const;

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

  LeafScene(Bank bank, const Model& model, std::uint64_t seed);
  float chance();
  void begin(int slot, bool anywhere);
  std::array<float, 3> wind_at(const std::array<float, 3>& place) const;
  void read_poses();
  void renew(int slot, float seconds);
  void kick(int slot, const std::array<float, 3>& wind);

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

}  // namespace wisp::window
