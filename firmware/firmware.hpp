// The board's firmware: control reports, boot from flash, self-test, watchdog, journal. The same
// source runs on the soft core, in unit tests and inside a virtual board; it reaches the outside
// through Registers only. No heap, no recursion, and every wait ends.
#pragma once

#include <stdint.h>

#include "firmware/journal.hpp"
#include "firmware/registers.hpp"
#include "gridrt_firmware_protocol.hpp"

namespace gridrt::firmware {

/// An image and rays with known answers: frames as a host would send them (sections, Commit, one
/// Trace), and the bytes that a board in order answers. The build makes them from the reference
/// device (firmware/vectors); the memory stays the caller's.
struct SelfTestVectors {
  const uint32_t* frames = nullptr;  ///< words, the first byte lowest
  uint32_t frame_words = 0;
  const uint8_t* answers = nullptr;
  uint32_t answer_bytes = 0;
  uint32_t rays = 0;
};

/// Result of the latest self-test, as SelfTestReport tells it.
struct SelfTestResult {
  wire::SelfTestState state = wire::SelfTestState::kNever;
  uint32_t runs = 0;
  uint32_t bytes = 0;  ///< of answers that were right
};

/// What became of the image in flash, as BootReport tells it.
struct BootResult {
  wire::BootState state = wire::BootState::kNone;
  wire::BootError error = wire::BootError::kNone;
  uint16_t refusal = 0;
  uint32_t detail = 0;
  uint32_t bytes = 0;
  uint32_t fingerprint[4] = {0, 0, 0, 0};
};

class Firmware {
 public:
  Firmware(Registers& registers, const SelfTestVectors& vectors)
      : registers_(registers), vectors_(vectors) {}

  /// Once, first: loads the image in flash, if there is one, and opens the link.
  void start();

  /// One round: looks after the engine, serves one request of the mailbox, does what it asked for.
  /// False if there was nothing to do: the caller may sleep until the mailbox has a request.
  bool poll();

 private:
  void note(wire::JournalCode code, uint32_t detail);
  // watch.cpp
  bool watch();
  void reset_core();
  [[nodiscard]] bool resident();
  [[nodiscard]] bool event_busy();
  void send_event(uint32_t id, const uint32_t* words, uint32_t count);
  // reports.cpp
  bool serve();
  uint32_t get(uint32_t id);  // bytes of the body; 0: there is no such report
  bool set(uint32_t id, uint32_t length);
  uint32_t get_self_test();
  uint32_t get_boot();
  uint32_t get_journal();
  bool has_window(uint32_t id);
  void body(uint32_t at, uint32_t word);
  // boot.cpp, self_test.cpp
  void boot();
  void run_self_test();

  Registers& registers_;
  SelfTestVectors vectors_;
  Journal journal_;
  SelfTestResult self_test_;
  BootResult boot_;
  uint32_t told_state_ = ~0U;  // DeviceState of the last Status that was sent
  wire::BoardCommand command_ = wire::BoardCommand::kNone;
};

}  // namespace gridrt::firmware
