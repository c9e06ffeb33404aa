// Tasmota driver: the light flickers like a candle while it is on. Put this file beside Tasmota's other drivers
// (tasmota/tasmota_xdrv_driver), candle.c and candle.h into tasmota/include or lib/lib_div/candle, and build with
// -DUSE_WISP_CANDLE. `WispBreeze 0…255` turns the dial from calm over as recorded (128) to breezy.
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
  // The mean light at 60 %, so that there is room to flare.
  const int32_t level = (int32_t)candle_step(&Wisp.flame) * 153 / CANDLE_ONE;
  if (TasmotaGlobal.power) LightSetBri(Light.device, level < 0 ? 0 : level > 255 ? 255 : level);
}

bool Xdrv120(uint32_t function) {
  if (FUNC_LOOP == function) WispStep();
  if (FUNC_COMMAND == function) return DecodeCommand(kWispCommands, WispCommand);
  return false;
}

#endif  // USE_LIGHT
#endif  // USE_WISP_CANDLE
