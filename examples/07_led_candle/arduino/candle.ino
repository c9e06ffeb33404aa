// An LED that flickers like a candle: LED and resistor on pin 9, candle.c and candle.h beside this file.
#include "candle.h"

static const uint8_t pin = 9;
static candle_state flame;
static uint32_t next_step;

void setup() {
  pinMode(pin, OUTPUT);
  candle_start(&flame, analogRead(A0));  // seeded by the noise of an open pin, so that lamps differ
  next_step = millis();
}

void loop() {
  if ((int32_t)(millis() - next_step) < 0) return;
  next_step += 1000 / CANDLE_RATE_HZ;
  // The mean light at 60 % of full, so that there is room to flare. PWM is linear in light, as the model is.
  const int32_t level = (int32_t)candle_step(&flame) * 153 / CANDLE_ONE;
  analogWrite(pin, level < 0 ? 0 : level > 255 ? 255 : level);
}
