#pragma once
// Each LED of an addressable light as a candle of its own, in the light's colour.
#include <vector>

#include "candle.h"
#include "esphome/components/light/addressable_light_effect.h"
#include "esphome/core/hal.h"

namespace esphome {
namespace wisp_candle {

class WispCandleEffect : public light::AddressableLightEffect {
 public:
  template <class Name>  // a string, or its characters in newer versions
  explicit WispCandleEffect(Name name) : AddressableLightEffect(name) {}

  void set_breeze(uint8_t breeze) { this->breeze_ = breeze; }

  void apply(light::AddressableLight& it, const Color& current_color) override {
    const uint32_t now = millis();
    if (this->flames_.size() != static_cast<size_t>(it.size())) {
      this->flames_.resize(it.size());
      uint32_t seed = 77;
      for (candle_state& flame : this->flames_) candle_start(&flame, seed++);
      this->next_ = now;
    }
    if (static_cast<int32_t>(now - this->next_) < 0) return;
    this->next_ = now + 1000 / CANDLE_RATE_HZ;
    int32_t i = 0;
    for (candle_state& flame : this->flames_) {
      flame.breeze = this->breeze_;
      // The mean light at 60 %, so that there is room to flare.
      const int32_t level = static_cast<int32_t>(candle_step(&flame)) * 153 / CANDLE_ONE;
      it[i++] = current_color * static_cast<uint8_t>(level < 0 ? 0 : level > 255 ? 255 : level);
    }
    it.schedule_show();
  }

 protected:
  std::vector<candle_state> flames_;
  uint32_t next_{0};
  uint8_t breeze_{128};
};

}  // namespace wisp_candle
}  // namespace esphome
