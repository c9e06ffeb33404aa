#pragma once
// WLED usermod: segments flicker like candles, each with its own chance. Add candle.c and candle.h to the build,
// register with `usermods.add(new WispCandleUsermod());` in usermods_list.cpp.
#include "candle.h"
#include "wled.h"

class WispCandleUsermod : public Usermod {
 public:
  void setup() override {
    for (uint8_t k = 0; k < kMax; ++k) candle_start(&flames_[k], 77u + 1000u * k);
  }

  // WLED calls this when the strip is about to be shown: what stands in it is dimmed as the candle burns.
  void handleOverlayDraw() override {
    const uint32_t now = millis();
    uint8_t steps = 0;
    while (static_cast<int32_t>(now - next_) >= 0 && steps++ < 5) {
      next_ += 1000 / CANDLE_RATE_HZ;
      for (uint8_t k = 0; k < kMax; ++k) light_[k] = candle_step(&flames_[k]);
    }
    if (steps > 5) next_ = now;  // WLED was away for long
    for (uint8_t s = 0; s < strip.getSegmentsNum() && s < kMax; ++s) {
      const Segment& segment = strip.getSegment(s);
      // The mean light at 60 %, so that there is room to flare.
      int32_t level = static_cast<int32_t>(light_[s]) * 153 / CANDLE_ONE;
      level = level < 0 ? 0 : level > 255 ? 255 : level;
      for (uint16_t i = segment.start; i < segment.stop; ++i) {
        const uint32_t c = strip.getPixelColor(i);
        strip.setPixelColor(i, RGBW32(R(c) * level / 255, G(c) * level / 255, B(c) * level / 255, W(c) * level / 255));
      }
    }
  }

  uint16_t getId() override { return 0x5750; }

 private:
  static constexpr uint8_t kMax = 16;
  candle_state flames_[kMax];
  int16_t light_[kMax] = {};
  uint32_t next_ = 0;
};
