// What firmware does of itself: start, look after the engine, tell the host what has happened.
#include "firmware/feed.hpp"
#include "firmware/firmware.hpp"

namespace gridrt::firmware {

namespace reg = wire::registers;
using wire::JournalCode;

namespace {

constexpr uint32_t kBodyWords = 16;

}  // namespace

void Firmware::start() {
  const uint32_t cause = registers_.read(reg::Watch::kCause);
  note(JournalCode::kStarted, cause);
  // A core that firmware left in the middle of something has to begin anew as well.
  if (cause != static_cast<uint32_t>(wire::StartCause::kPowerUp)) reset_core();
  boot();
  Feed(registers_).give_back();
}

bool Firmware::poll() {
  registers_.write(reg::Watch::kAlive, 1);
  bool busy = watch();
  busy = serve() || busy;
  const wire::BoardCommand command = command_;
  command_ = wire::BoardCommand::kNone;
  if (command == wire::BoardCommand::kSelfTest) run_self_test();
  if (command == wire::BoardCommand::kBoot) boot();
  return busy || command != wire::BoardCommand::kNone;
}

bool Firmware::watch() {
  const bool was_resident = resident();
  const uint32_t bus = registers_.read(reg::Watch::kBus);
  const uint32_t stuck = registers_.read(reg::Watch::kStuck);
  const bool hung = stuck >= registers_.read(reg::Watch::kLimit);
  if (bus != 0 || hung) {
    reset_core();
    if (bus != 0) note(JournalCode::kBusTimeout, bus - 1);
    if (hung) note(JournalCode::kEngineHung, stuck);
    if (was_resident) boot();
    return true;
  }
  // The input report Status goes out when the state has changed.
  const uint32_t state = registers_.read(wire::kStatusWindow) & 0xFFU;
  if (state == told_state_ || event_busy()) return false;
  uint32_t words[wire::StatusReport::kBytes / 4];
  for (uint32_t w = 0; w < wire::StatusReport::kBytes / 4; ++w) {
    words[w] = registers_.read(wire::kStatusWindow + 4 * w);
  }
  if (registers_.read(reg::Watch::kBus) != 0) return true;  // what was read is nothing
  told_state_ = state;
  send_event(wire::StatusReport::kId, words, wire::StatusReport::kBytes / 4);
  return true;
}

void Firmware::reset_core() {
  registers_.write(reg::Watch::kReset, wire::kCoreResetKey);
  registers_.write(reg::Watch::kBus, 0);
}

bool Firmware::resident() {
  return boot_.state == wire::BootState::kBooted && (registers_.read(reg::Watch::kImage) & 1U) == 0;
}

bool Firmware::event_busy() {
  return ((registers_.read(reg::Mailbox::kEvent) >> reg::Mailbox::kEventBusyBit) & 1U) != 0;
}

void Firmware::send_event(uint32_t id, const uint32_t* words, uint32_t count) {
  for (uint32_t w = 0; w < kBodyWords; ++w) {
    registers_.write(reg::EventBody::kWords + 4 * w, w < count ? words[w] : 0);
  }
  registers_.write(reg::Mailbox::kEvent, id << reg::Mailbox::kEventIdBit);
}

void Firmware::note(JournalCode code, uint32_t detail) {
  const uint32_t clocks = registers_.read(reg::Watch::kClocks);
  journal_.add({code, detail, clocks});
  if (event_busy()) return;
  const uint32_t state = registers_.read(wire::kStatusWindow) & 0xFFU;
  const uint32_t words[wire::EventReport::kBytes / 4] = {
      static_cast<uint32_t>(code) | state << (8 * wire::EventReport::kStateAt), detail, clocks};
  send_event(wire::EventReport::kId, words, wire::EventReport::kBytes / 4);
}

}  // namespace gridrt::firmware
