#include "firmware/journal.hpp"

namespace gridrt::firmware {

void Journal::add(const JournalEntry& entry) {
  if (count_ == kCapacity) {
    take();
    lost_ = true;
  }
  entries_[(first_ + count_) % kCapacity] = entry;
  ++count_;
}

JournalEntry Journal::take() {
  if (count_ == 0) return {};
  const JournalEntry entry = entries_[first_];
  first_ = (first_ + 1) % kCapacity;
  --count_;
  return entry;
}

}  // namespace gridrt::firmware
