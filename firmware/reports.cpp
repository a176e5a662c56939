// Control reports: a request in the mailbox becomes words of a window, or of what firmware knows.
#include "firmware/firmware.hpp"

namespace gridrt::firmware {

namespace reg = wire::registers;

namespace {

constexpr uint32_t kSerialWords = 4;
constexpr uint32_t kJournalEntries = 4;

uint32_t field(uint32_t word, uint32_t bit, uint32_t mask) { return (word >> bit) & mask; }

}  // namespace

bool Firmware::serve() {
  const uint32_t request = registers_.read(reg::Mailbox::kRequest);
  if (((request >> reg::Mailbox::kRequestValidBit) & 1U) == 0) return false;
  const uint32_t id = field(request, reg::Mailbox::kRequestIdBit, reg::Mailbox::kRequestIdMask);
  const uint32_t kind =
      field(request, reg::Mailbox::kRequestKindBit, reg::Mailbox::kRequestKindMask);
  const uint32_t tag = field(request, reg::Mailbox::kRequestTagBit, reg::Mailbox::kRequestTagMask);
  uint32_t length =
      field(request, reg::Mailbox::kRequestLengthBit, reg::Mailbox::kRequestLengthMask);
  bool good = false;
  if (kind == static_cast<uint32_t>(wire::MailboxKind::kGet)) {
    length = get(id);
    good = length != 0;
  } else if (kind == static_cast<uint32_t>(wire::MailboxKind::kSet)) {
    good = set(id, length);
    length = 0;
  }
  // What a register that was not served has left is no answer.
  if (registers_.read(reg::Watch::kBus) != 0) good = false;
  registers_.write(reg::Mailbox::kAnswer, length << reg::Mailbox::kAnswerLengthBit |
                                              tag << reg::Mailbox::kAnswerTagBit |
                                              (good ? 1U : 0U) << reg::Mailbox::kAnswerGoodBit);
  return true;
}

void Firmware::body(uint32_t at, uint32_t word) {
  registers_.write(reg::MailboxBody::kWords + at, word);
}

uint32_t Firmware::get(uint32_t id) {
  if (id == wire::SelfTestReport::kId) return get_self_test();
  if (id == wire::BootReport::kId) return get_boot();
  if (id == wire::JournalReport::kId) return get_journal();
  for (const wire::Window& window : wire::kWindows) {
    if (window.report != id || !window.readable || !has_window(id)) continue;
    for (uint32_t at = 0; at < 4U * window.words; at += 4) {
      body(at, registers_.read(window.base + at));
    }
    if (id == wire::IdentityReport::kId) {
      for (uint32_t w = 0; w < kSerialWords; ++w) {
        body(wire::IdentityReport::kSerialAt + 4 * w, registers_.read(reg::Watch::kSerial + 4 * w));
      }
    }
    return 4U * window.words;
  }
  return 0;
}

/// Software PEs behind the same registers lack some of a board's reports.
bool Firmware::has_window(uint32_t id) {
  return ((registers_.read(reg::Watch::kReports) >> id) & 1U) != 0;
}

uint32_t Firmware::get_self_test() {
  body(wire::SelfTestReport::kStateAt, static_cast<uint32_t>(self_test_.state));
  body(wire::SelfTestReport::kRunsAt, self_test_.runs);
  body(wire::SelfTestReport::kRaysAt, vectors_.rays);
  body(wire::SelfTestReport::kRightAt, self_test_.bytes);
  body(wire::SelfTestReport::kTotalAt, vectors_.answer_bytes);
  return wire::SelfTestReport::kBytes;
}

uint32_t Firmware::get_boot() {
  body(wire::BootReport::kStateAt, static_cast<uint32_t>(boot_.state) |
                                       static_cast<uint32_t>(boot_.error) << 8U |
                                       static_cast<uint32_t>(boot_.refusal) << 16U);
  body(wire::BootReport::kDetailAt, boot_.detail);
  body(wire::BootReport::kLengthAt, boot_.bytes);
  body(wire::BootReport::kResidentAt, resident() ? 1U : 0U);
  for (uint32_t w = 0; w < 4; ++w) {
    body(wire::BootReport::kFingerprintAt + 4 * w, boot_.fingerprint[w]);
  }
  return wire::BootReport::kBytes;
}

uint32_t Firmware::get_journal() {
  const uint32_t count = journal_.count() < kJournalEntries ? journal_.count() : kJournalEntries;
  body(wire::JournalReport::kCountAt, count | (journal_.lost() ? 1U : 0U) << 8U);
  for (uint32_t i = 0; i < kJournalEntries; ++i) {
    const JournalEntry entry = journal_.take();  // zeros once there is none
    body(wire::JournalReport::kCodesAt + 4 * i, static_cast<uint32_t>(entry.code));
    body(wire::JournalReport::kDetailsAt + 4 * i, entry.detail);
    body(wire::JournalReport::kClocksAt + 4 * i, entry.clocks);
  }
  return wire::JournalReport::kBytes;
}

bool Firmware::set(uint32_t id, uint32_t length) {
  const uint32_t first = registers_.read(reg::MailboxBody::kWords);
  if (id == wire::ResetReport::kId) {
    if (length < wire::ResetReport::kBytes || first != wire::kResetKey) return false;
    registers_.write(wire::kResetWindow, first);
    note(wire::JournalCode::kHostReset, 0);
    // A shell that could not be reset from within is reset from outside.
    if (registers_.read(reg::Watch::kBus) != 0) reset_core();
    return true;
  }
  if (id == wire::ControlReport::kId) {
    if (length < wire::ControlReport::kBytes || first == 0 || !has_window(id)) return false;
    registers_.write(wire::kControlWindow, first);
    registers_.write(wire::kControlWindow + wire::ControlReport::kLogAt,
                     registers_.read(reg::MailboxBody::kWords + wire::ControlReport::kLogAt));
    return true;
  }
  if (id == wire::CommandReport::kId) {
    const auto command = static_cast<wire::BoardCommand>(first & 0xFFU);
    if (length < 1 ||
        (command != wire::BoardCommand::kSelfTest && command != wire::BoardCommand::kBoot)) {
      return false;
    }
    command_ = command;
    return true;
  }
  return false;
}

}  // namespace gridrt::firmware
