// The one thing that firmware touches: 32-bit words at the byte addresses of protocol.toml
// ([registers], [peripherals]; wire::kWindows and wire::registers).
#pragma once

#include <stdint.h>

namespace gridrt::firmware {

#ifdef GRIDRT_SOFT_CORE

/// On the soft core they are memory.
class Registers {
 public:
  [[nodiscard]] uint32_t read(uint32_t address) { return *at(address); }
  void write(uint32_t address, uint32_t data) { *at(address) = data; }

 private:
  static constexpr uintptr_t kBase = 0x10000000;
  static volatile uint32_t* at(uint32_t address) {
    return reinterpret_cast<volatile uint32_t*>(kBase + address);
  }
};

#else

/// Elsewhere somebody plays the hardware: a test, or a virtual board.
class Registers {
 public:
  Registers() = default;
  Registers(const Registers&) = delete;
  Registers& operator=(const Registers&) = delete;

  /// `address` is a multiple of 4 below 0x1000; what is not there reads as 0. Must not wait.
  virtual uint32_t read(uint32_t address) = 0;
  /// As read(); what is not there, or cannot be written, ignores it.
  virtual void write(uint32_t address, uint32_t data) = 0;

 protected:
  ~Registers() = default;
};

#endif

}  // namespace gridrt::firmware
