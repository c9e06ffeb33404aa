#include "capture/media/wide_colours.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "wisp/capture/vision/picture.hpp"

namespace wisp {
namespace {

// Matrix from linear light in BT.2020's primaries to BT.709's (ITU-R BT.2087-0, table 2 inverted).
constexpr float kPrimaries[3][3] = {
    {1.6605F, -0.5876F, -0.0728F}, {-0.1246F, 1.1329F, -0.0083F}, {-0.0182F, -0.1006F, 1.1187F}};

constexpr int kSignals = 65536, kLights = 4096;  // table sizes: 16-bit signals; steps of light (¼ level near black)

// HLG signal to light on the camera (ITU-R BT.2100-2, table 5), relative to reference white: signal 0.75 (BT.2408).
double hlg_light(double signal) {
  constexpr double kA = 0.17883277, kB = 0.28466892, kC = 0.55991073;
  const auto light = [](double x) { return x <= 0.5 ? x * x / 3 : (std::exp((x - kC) / kA) + kB) / 12; };
  return light(signal) / light(0.75);
}

// PQ signal to light on the camera (BT.2100-2, table 4: EOTF, inverse OOTF), relative to reference white: 203 cd/m².
double pq_light(double signal) {
  constexpr double kM1 = 2610.0 / 16384, kM2 = 2523.0 / 32, kC1 = 3424.0 / 4096, kC2 = 2413.0 / 128, kC3 = 2392.0 / 128;
  const double power = std::pow(signal, 1 / kM2);
  const double shown = 10000 * std::pow(std::max(power - kC1, 0.0) / (kC2 - kC3 * power), 1 / kM1);
  return linear_light(std::pow(shown / 203, 1 / 2.4));
}

std::vector<float> lights_of(double light(double signal)) {
  std::vector<float> out;
  for (int k = 0; k < kSignals; ++k) out.push_back(static_cast<float>(light(k / (kSignals - 1.0))));
  return out;
}

// Returns the 8-bit level for each light k / kLights, k = 0 to kLights: the inverse of linear_light().
std::vector<std::uint8_t> levels() {
  std::vector<std::uint8_t> out;
  for (int level = 0, k = 0; k <= kLights; ++k) {
    while (level < 255 && linear_light((level + 0.5) / 255) * kLights < k) ++level;
    out.push_back(static_cast<std::uint8_t>(level));
  }
  return out;
}

}  // namespace

bool has_wide_colours(const AVFrame& frame) {
  return frame.colorspace == AVCOL_SPC_BT2020_NCL || frame.colorspace == AVCOL_SPC_BT2020_CL ||
         frame.color_trc == AVCOL_TRC_ARIB_STD_B67 || frame.color_trc == AVCOL_TRC_SMPTE2084;
}

void narrow_colours(const AVFrame& frame, const AVFrame& rgb48, AVFrame& rgb24) {
  static const std::vector<float> hlg = lights_of(hlg_light), pq = lights_of(pq_light), sdr = lights_of(linear_light);
  static const std::vector<std::uint8_t> level = levels();
  const auto& light = frame.color_trc == AVCOL_TRC_ARIB_STD_B67 ? hlg
                      : frame.color_trc == AVCOL_TRC_SMPTE2084  ? pq
                                                                : sdr;
  const bool same = frame.color_primaries == AVCOL_PRI_BT709;
  for (std::ptrdiff_t row = 0; row < rgb48.height; ++row) {
    const auto* in = reinterpret_cast<const std::uint16_t*>(rgb48.data[0] + row * rgb48.linesize[0]);
    std::uint8_t* out = rgb24.data[0] + row * rgb24.linesize[0];
    for (int x = 0; x < rgb48.width; ++x, in += 3) {
      const float red = light[in[0]], green = light[in[1]], blue = light[in[2]];
      for (int k = 0; k < 3; ++k) {
        const float* to = kPrimaries[k];
        const float sum = same ? light[in[k]] : to[0] * red + to[1] * green + to[2] * blue;
        *out++ = level[static_cast<std::size_t>(kLights * std::clamp(sum, 0.0F, 1.0F) + 0.5F)];
      }
    }
  }
}

}  // namespace wisp
