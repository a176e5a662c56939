// Loading the image in flash: its frames go through the loader that checks a host's.
#include "firmware/answers.hpp"
#include "firmware/crc32c.hpp"
#include "firmware/feed.hpp"
#include "firmware/firmware.hpp"

namespace gridrt::firmware {

namespace reg = wire::registers;
using wire::BootError;
using wire::BootState;

namespace {

constexpr uint32_t kFlashPolls = 1U << 12U;  ///< reads of a register until a word has come
constexpr uint32_t kHeaderWords = wire::FlashHeader::kBytes / 4;

/// Waits for the flash's next word; false if it does not come.
bool next_word(Registers& registers, uint32_t& word) {
  for (uint32_t polls = 0; polls < kFlashPolls; ++polls) {
    if (((registers.read(reg::Flash::kStatus) >> reg::Flash::kStatusReadyBit) & 1U) != 0) {
      word = registers.read(reg::Flash::kData);
      return true;
    }
  }
  return false;
}

/// Takes a byte of what the shell has said: one for each look at something else, so that a shell
/// that never stops does not keep firmware here.
void listen(Feed& feed, Answers& answers) {
  const int byte = feed.byte();
  if (byte >= 0) answers.add(static_cast<uint8_t>(byte));
}

BootError fail(BootResult& result, BootError error, uint32_t detail) {
  result.detail = detail;
  return error;
}

/// Reads and checks the header: state kAbsent without an error if there is no flash image.
BootError read_header(Registers& registers, BootResult& result, uint32_t& commit) {
  uint32_t header[kHeaderWords];
  registers.write(reg::Flash::kAddress, wire::kFlashAddress);
  for (uint32_t w = 0; w < kHeaderWords; ++w) {
    if (!next_word(registers, header[w])) {
      return fail(result, BootError::kFlashSilent, wire::kFlashAddress + 4 * w);
    }
  }
  if (header[wire::FlashHeader::kMagicAt / 4] != wire::kFlashMagic) {
    result.state = BootState::kAbsent;
    return BootError::kNone;
  }
  const uint32_t crc = crc32c(header, kHeaderWords - 1);
  if (header[wire::FlashHeader::kHeaderCrcAt / 4] != crc) {
    return fail(result, BootError::kBadHeader, crc);
  }
  const uint32_t version = header[wire::FlashHeader::kVersionAt / 4] & 0xFFFFU;
  if (version != wire::kFlashVersion) return fail(result, BootError::kBadVersion, version);
  result.bytes = header[wire::FlashHeader::kBytesAt / 4];
  if (result.bytes == 0 || result.bytes % 4 != 0 || result.bytes > wire::kFlashMaxBytes) {
    return fail(result, BootError::kBadLength, result.bytes);
  }
  for (uint32_t w = 0; w < 4; ++w) {
    result.fingerprint[w] = header[wire::FlashHeader::kFingerprintAt / 4 + w];
  }
  commit = header[wire::FlashHeader::kCommitAt / 4];
  return BootError::kNone;
}

/// Feeds all frames, then waits for Commit's answer.
BootError load_frames(Registers& registers, Feed& feed, Answers& answers, BootResult& result) {
  for (uint32_t fed = 0; fed < result.bytes; fed += 4) {
    uint32_t word = 0;
    if (!next_word(registers, word)) {
      return fail(result, BootError::kFlashSilent,
                  wire::kFlashAddress + wire::FlashHeader::kBytes + fed);
    }
    uint32_t polls = 0;
    while (!feed.has_room()) {
      listen(feed, answers);
      if (++polls > kRoomPolls) return fail(result, BootError::kShellSilent, fed);
    }
    feed.put(word);
    if (answers.refused()) break;
  }
  for (uint32_t polls = 0; polls < kAnswerPolls; ++polls) {
    listen(feed, answers);
    if (answers.refused() || answers.committed()) break;
  }
  if (answers.refused()) {
    result.refusal = answers.code();
    return fail(result, BootError::kRefused, answers.detail());
  }
  if (!answers.committed()) return fail(result, BootError::kShellSilent, result.bytes);
  const uint32_t state = registers.read(wire::kStatusWindow) & 0xFFU;
  if (state != static_cast<uint32_t>(wire::DeviceState::kReady)) {
    return fail(result, BootError::kNotCommitted, state);
  }
  return BootError::kNone;
}

}  // namespace

void Firmware::boot() {
  boot_ = {};
  uint32_t commit = 0;
  boot_.error = read_header(registers_, boot_, commit);
  if (boot_.state == BootState::kAbsent) return;
  if (boot_.error == BootError::kNone) {
    Feed feed(registers_);
    if (feed.take()) {
      Answers answers(commit);
      boot_.error = load_frames(registers_, feed, answers, boot_);
      // Half an image or half a frame is of no use to anybody.
      if (boot_.error != BootError::kNone) reset_core();
      feed.give_back();
    } else {
      boot_.error = BootError::kLinkBusy;
    }
  }
  if (boot_.error == BootError::kNone) {
    boot_.state = BootState::kBooted;
    registers_.write(reg::Watch::kImage, 1);
    note(wire::JournalCode::kBooted, boot_.bytes);
  } else {
    boot_.state = BootState::kFailed;
    note(wire::JournalCode::kBootFailed, static_cast<uint32_t>(boot_.error));
  }
}

}  // namespace gridrt::firmware
