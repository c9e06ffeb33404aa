// Tasmota driver: the light flickers like a candle while it is on. Put this file beside Tasmota's other drivers
// (tasmota/tasmota_xdrv_driver), candle.c and candle.h into tasmota/include or lib/lib_div/candle, and build with
// -DUSE_WISP_CANDLE. `WispBreeze 0…255` turns the dial from calm over as recorded (128) to breezy; `Dimmer` is the mean
// light, and 60 leaves room to flare. The candle's light is linear: `LedTable 0`, `Fade 0`.
#ifdef USE_WISP_CANDLE
#ifdef USE_LIGHT
#define XDRV_120 120

#include "candle.h"

static struct {
  candle_state flame;
  uint32_t next = 0;
  bool started = false;
} Wisp;

const char kWispCommands[] PROGMEM = "Wisp|Breeze";
void (*const WispCommand[])(void) PROGMEM = {&CmndWispBreeze};

void CmndWispBreeze(void) {
  if (XdrvMailbox.payload >= 0 && XdrvMailbox.payload <= 255) Wisp.flame.breeze = XdrvMailbox.payload;
  ResponseCmndNumber(Wisp.flame.breeze);
}

void WispStep(void) {
  if (!Wisp.started) {
    candle_start(&Wisp.flame, ESP_getChipId());
    Wisp.next = millis();
    Wisp.started = true;
  }
  if ((int32_t)(millis() - Wisp.next) < 0) return;
  Wisp.next += 1000 / CANDLE_RATE_HZ;
  // The state alone: LightSetBri() would write each step into the settings, which are saved to flash. Never 0, which is off.
  const int32_t level = (int32_t)candle_step(&Wisp.flame) * LightStateClass::DimmerToBri(Settings->light_dimmer) / CANDLE_ONE;
  if (Light.power) light_state.setBri(level < 1 ? 1 : level > 255 ? 255 : level);
}

bool Xdrv120(uint32_t function) {
  if (FUNC_LOOP == function) WispStep();
  if (FUNC_COMMAND == function) return DecodeCommand(kWispCommands, WispCommand);
  return false;
}

#endif  // USE_LIGHT
#endif  // USE_WISP_CANDLE
