#pragma once
// Inputs and outputs of a model of plain numbers, as moving curves.

#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "wisp/draw/image.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::window {

class PlotScene {
 public:
  /// Errors: as Bank::create().
  static Result<PlotScene> create(const Model& model, std::uint64_t seed);

  void resize(int width, int height);

  /// Moves every input through its trained range: 0 is its middle, −1 and 1 its ends.
  void blow(float wind) { wind_ = wind; }

  void reset();
  void set_noise(bool on) { bank_.set_noise(on ? 1.0F : 0.0F); }
  void advance(std::chrono::nanoseconds time);
  void draw(Image& image);
  Bank::Clamped clamped() const { return bank_.clamped(); }

 private:
  struct Curve {
    std::string name;
    double lowest = 0, highest = 1;
    std::deque<float> values;  // oldest first
  };

  PlotScene(Bank bank, const Model& model);
  void keep(Curve& curve, float value) const;

  Bank bank_;
  std::vector<Curve> inputs_, outputs_;
  int width_ = 1280, height_ = 800;
  float wind_ = 0;
};

}  // namespace wisp::window
