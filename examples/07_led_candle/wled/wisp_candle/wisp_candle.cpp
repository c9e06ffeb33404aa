// WLED usermod: LEDs flicker like candles. Each LED is a candle of its own, or each segment, as the settings say; the
// dial goes from calm (0) over as recorded (128) to breezy (255). Put candle.c and candle.h into this folder.
#include "candle.h"
#include "wled.h"

class WispCandleUsermod : public Usermod {
 public:
  void setup() override {
    for (uint16_t k = 0; k < kMax; ++k) candle_start(&flames_[k], 77u + k);
  }

  void loop() override {}

  // WLED calls this before the strip is shown: dims each pixel by its candle's light.
  void handleOverlayDraw() override {
    if (!enabled_) return;
    step(millis());
    const uint16_t length = strip.getLengthTotal();
    if (each_led_) {
      for (uint16_t i = 0; i < length; ++i) dim(i, light_[i % kMax]);
      return;
    }
    for (uint8_t s = 0; s < strip.getSegmentsNum(); ++s) {
      const Segment& segment = strip.getSegment(s);
      for (uint16_t i = segment.start; i < segment.stop && i < length; ++i) dim(i, light_[s % kMax]);
    }
  }

  void addToConfig(JsonObject& root) override {
    JsonObject top = root.createNestedObject(F("WispCandle"));
    top[F("enabled")] = enabled_;
    top[F("eachLed")] = each_led_;
    top[F("breeze")] = breeze_;
  }

  bool readFromConfig(JsonObject& root) override {
    JsonObject top = root[F("WispCandle")];
    bool complete = !top.isNull();
    complete &= getJsonValue(top[F("enabled")], enabled_, true);
    complete &= getJsonValue(top[F("eachLed")], each_led_, true);
    complete &= getJsonValue(top[F("breeze")], breeze_, 128);
    return complete;
  }

  uint16_t getId() override { return USERMOD_ID_UNSPECIFIED; }

 private:
  void step(uint32_t now) {
    uint8_t steps = 0;
    while (static_cast<int32_t>(now - next_) >= 0 && steps++ < 5) {
      next_ += 1000 / CANDLE_RATE_HZ;
      for (uint16_t k = 0; k < kMax; ++k) {
        flames_[k].breeze = static_cast<uint8_t>(breeze_);
        // The mean light at 60 %, so that there is room to flare.
        const int32_t level = static_cast<int32_t>(candle_step(&flames_[k])) * 153 / CANDLE_ONE;
        light_[k] = static_cast<uint8_t>(level < 0 ? 0 : level > 255 ? 255 : level);
      }
    }
    if (steps > 5) next_ = now;  // more than five steps late: drops the rest
  }

  static void dim(uint16_t i, uint8_t level) {
    const uint32_t c = strip.getPixelColor(i);
    strip.setPixelColor(i, RGBW32(R(c) * level / 255, G(c) * level / 255, B(c) * level / 255, W(c) * level / 255));
  }

  static constexpr uint16_t kMax = 96;  // candles; further LEDs repeat them
  candle_state flames_[kMax];
  uint8_t light_[kMax] = {};
  uint32_t next_ = 0;
  bool enabled_ = true;
  bool each_led_ = true;
  int breeze_ = 128;
};

static WispCandleUsermod wisp_candle;
REGISTER_USERMOD(wisp_candle);
