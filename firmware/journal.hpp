// What has happened, until the host fetches it.
#pragma once

#include <stdint.h>

#include "gridrt_firmware_protocol.hpp"

namespace gridrt::firmware {

struct JournalEntry {
  wire::JournalCode code = wire::JournalCode::kNone;
  uint32_t detail = 0;
  uint32_t clocks = 0;
};

/// A queue of kCapacity entries; the oldest one goes if there is no room.
class Journal {
 public:
  static constexpr uint32_t kCapacity = 8;

  void add(const JournalEntry& entry);
  /// Takes the oldest entry out; code kNone if there is none.
  JournalEntry take();
  [[nodiscard]] uint32_t count() const { return count_; }
  /// Whether an entry was ever lost.
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  JournalEntry entries_[kCapacity];
  uint32_t first_ = 0;
  uint32_t count_ = 0;
  bool lost_ = false;
};

}  // namespace gridrt::firmware
