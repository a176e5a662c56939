// Where the soft core begins: memory is as the bitstream left it, the stack is empty.
#include <stddef.h>

#include "firmware/firmware.hpp"
#include "firmware/self_test_vectors.hpp"

extern "C" {

extern uint32_t gridrt_bss_start[];
extern uint32_t gridrt_bss_end[];

void gridrt_main();

// The compiler turns loops and copies of objects into calls of these.
void* memset(void* to, int value, size_t bytes) {
  auto* out = static_cast<uint8_t*>(to);
  for (size_t i = 0; i < bytes; ++i) out[i] = static_cast<uint8_t>(value);
  return to;
}

void* memcpy(void* to, const void* from, size_t bytes) {
  auto* out = static_cast<uint8_t*>(to);
  const auto* in = static_cast<const uint8_t*>(from);
  for (size_t i = 0; i < bytes; ++i) out[i] = in[i];
  return to;
}

void gridrt_main() {
  using gridrt::firmware::Firmware;
  using gridrt::firmware::Registers;
  constexpr uint32_t kNap = 1U << 16U;  ///< clocks, about a millisecond
  for (uint32_t* word = gridrt_bss_start; word != gridrt_bss_end; ++word) *word = 0;
  Registers registers;
  Firmware firmware(registers, gridrt::firmware::kSelfTestVectors);
  firmware.start();
  for (;;) {
    if (!firmware.poll()) registers.write(gridrt::wire::registers::Watch::kSleep, kNap);
  }
}
}

asm(".section .start, \"ax\"\n"
    ".global gridrt_start\n"
    "gridrt_start:\n"
    "  la sp, gridrt_stack_top\n"
    "  j gridrt_main\n");
