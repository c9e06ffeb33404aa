/* What starts a program on a bare Cortex-M0: its stack, its entry, and its data. */
#include <stdint.h>

int main(void);
extern uint32_t data_from, data_begin, data_end, bss_begin, bss_end, stack_end;

void reset(void) {
  uint32_t *from = &data_from, *to = &data_begin;
  while (to < &data_end) *to++ = *from++;
  for (to = &bss_begin; to < &bss_end; ++to) *to = 0;
  main();
  for (;;) continue;
}

__attribute__((section(".vectors"), used)) static const void* const vectors[2] = {&stack_end, (const void*)reset};
