#include "draw/flame/flame_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp::drawing {
namespace {

// Light over how much glowing soot is in view (0 none … 1 the thickest part): rim, body, core, each melting into the
// next, so that layers have a visible edge and no line.
class SootRamp {
 public:
  explicit SootRamp(const FlameStyle& style) {
    const Light rim = emission_of(style.rim);
    const Light body = emission_of(style.body);
    const Light core = emission_of(style.core);
    for (int k = 0; k <= kSteps; ++k) {
      const float v = static_cast<float>(k) / kSteps;
      const float to_rim = smooth_step(0.0F, 0.42F, v);
      const float to_body = smooth_step(0.30F, 0.66F, v);
      const float to_core = smooth_step(0.56F, 0.94F, v);
      Light light = to_rim * rim;
      light = (1 - to_body) * light + to_body * body;
      table_[k] = (1 - to_core) * light + to_core * core;
    }
  }

  Light at(float soot) const {
    const float x = std::clamp(soot, 0.0F, 1.0F) * kSteps;
    const int k = std::min(static_cast<int>(x), kSteps - 1);
    const float part = x - static_cast<float>(k);
    return (1 - part) * table_[k] + part * table_[k + 1];
  }

 private:
  static constexpr int kSteps = 256;
  std::array<Light, kSteps + 1> table_{};
};

// How much of the fuel glows as soot at the share t of the way from the base to the tip: the dark zone around the wick,
// the luminous zone, and the tip where it burns off.
float soot_profile(float t) {
  const float rise = 0.04F + 0.34F * smooth_step(0.04F, 0.22F, t) + 0.62F * smooth_step(0.14F, 0.44F, t);
  const float burn_off = 1 - 0.55F * smooth_step(0.74F, 1.04F, t);
  return rise * burn_off;
}

// Soot fills the whole flame above, but low down it is only inside the blue mantle, which would turn purple with it.
float soot_depth(float t, float thick) {
  const float shell = 0.50F * (1 - smooth_step(0.05F, 0.34F, t));
  return std::max(0.0F, thick - shell) / (1 - shell);
}

// The blue mantle: a thin shell of burning gas, seen edge-on at the sides, that fades upwards.
float mantle(float t, float thick) {
  const float shell = std::exp(-7.0F * thick * thick) + 0.05F;
  return shell * (1 - smooth_step(0.00F, 0.27F, t));
}

}  // namespace

void add_flame_light(LightField& field, const FlameShape& shape, const FlameMood& mood, const FlameStyle& style,
                     const Plane& shade) {
  if (shape.empty() || shape.thickest <= 0) return;
  const SootRamp ramp(style);
  const Light blue = emission_of(style.base);
  const float per_reach = 1 / std::max(1e-3F, shape.reach);
  for (int y = 0; y < shape.box.height; ++y) {
    for (int x = 0; x < shape.box.width; ++x) {
      const float covered = shape.coverage.row(y)[x];
      if (covered == 0) continue;
      const float thick = std::min(1.0F, shape.thickness.row(y)[x] / shape.thickest);
      const float dx = static_cast<float>(shape.box.x + x) + 0.5F - shape.base.x;
      const float dy = static_cast<float>(shape.box.y + y) + 0.5F - shape.base.y;
      const float t = std::sqrt(dx * dx + dy * dy) * per_reach;
      const Light soot = ramp.at(mood.soot * soot_depth(t, thick) * soot_profile(t));
      const Light light = soot + 0.26F * mantle(t, thick) * blue;
      const float clear = shade.values.empty() ? 1 : 1 - shade.row(y)[x];
      field.add(shape.box.x + x, shape.box.y + y, mood.brightness * covered * clear * light);
    }
  }
}

}  // namespace wisp::drawing
