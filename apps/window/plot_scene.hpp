#pragma once
// Models with plain outputs in the window, as moving curves.

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "event.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::window {

inline constexpr std::size_t kKept = 480;      // values per curve, one per frame
inline constexpr std::size_t kMaxCurves = 12;  // inputs and outputs beyond these are not drawn
inline constexpr Colour kPlotGround{16, 17, 22};
inline constexpr std::array<Colour, 6> kPlotPalette{
    {{86, 180, 233}, {240, 228, 66}, {0, 158, 115}, {230, 159, 0}, {204, 121, 167}, {213, 94, 0}}};

class PlotScene {
 public:
  /// Creates a scene. Errors: those of Bank::create().
  static Result<PlotScene> create(const Model& model, std::uint64_t seed) {
    auto bank = Bank::create(model, {.capacity = 1, .seed = seed});
    if (!bank) return bank.error();
    bank->spawn();
    return PlotScene(std::move(*bank), model);
  }

  void resize(int width, int height) { width_ = width, height_ = height; }

  /// Sets every input relative to its trained range: 0 is the middle, −1 and 1 the ends. Clamped to ±1.5.
  void blow(float wind) { wind_ = wind; }

  void pointer_moved(Point) {}
  void pointer_left() {}
  void pointer_pressed(Point) {}
  void pointer_released(Point) {}

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
      const double range = curve.highest > curve.lowest ? curve.highest - curve.lowest : 1;
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
