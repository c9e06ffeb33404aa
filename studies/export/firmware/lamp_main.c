/* Plays a lamp made by `wisp export` on whatever it was compiled for, and prints what it did.

   Steps, a hash of all outputs (FNV-1a over their low bytes first), and, on AVR, the most cycles that a step took.
   Compiled with -DLAMP_HEADER='"lamp.h"' -DLAMP_NAME=lamp -DLAMP_STEPS=1000. */
#include LAMP_HEADER

#define JOINED(a, b) a##b
#define NAMED(a, b) JOINED(a, b)

static NAMED(LAMP_NAME, _state) lamp;

static uint32_t play(uint32_t steps, uint16_t* slowest);

#ifdef __AVR__
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

static void put(char c) {
  while (!(UCSR0A & (1 << UDRE0))) continue;
  UDR0 = (uint8_t)c;
}
static uint16_t clock(void) { return TCNT1; }
static void start(void) {
  TCCR1B = 1; /* timer 1 counts cycles */
  UCSR0B = 1 << TXEN0;
}
static void stop(void) {
  cli();
  sleep_enable();
  sleep_cpu();
}
#elif defined(__arm__) && !defined(__linux__)
/* Semihosting, as debuggers and QEMU offer it. */
static int call(int number, const void* argument) {
  register int r0 __asm__("r0") = number;
  register const void* r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
static void put(char c) { call(3, &c); }
static uint16_t clock(void) { return 0; }
static void start(void) {}
static void stop(void) { call(0x18, (const void*)0x20026); }
#else
#include <stdio.h>
static void put(char c) { putchar(c); }
static uint16_t clock(void) { return 0; }
static void start(void) {}
static void stop(void) {}
#endif

static uint32_t play(uint32_t steps, uint16_t* slowest) {
  uint32_t hash = 2166136261u, k;
  for (k = 0; k < steps; ++k) {
    const uint16_t before = clock();
    const int16_t light = NAMED(LAMP_NAME, _step)(&lamp);
    const uint16_t took = (uint16_t)(clock() - before);
    if (took > *slowest) *slowest = took;
    hash = (hash ^ ((uint16_t)light & 0xffu)) * 16777619u;
    hash = (hash ^ ((uint16_t)light >> 8)) * 16777619u;
  }
  return hash;
}

static void put_hex(uint32_t word) {
  int shift;
  for (shift = 28; shift >= 0; shift -= 4) put("0123456789abcdef"[word >> shift & 15u]);
}

int main(void) {
  uint16_t slowest = 0;
  uint32_t hash;
  start();
  NAMED(LAMP_NAME, _start)(&lamp, 7);
  hash = play(LAMP_STEPS, &slowest);
  put_hex(hash);
  put(' ');
  put_hex(slowest);
  put('\n');
  stop();
  return 0;
}
