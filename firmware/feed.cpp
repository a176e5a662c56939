#include "firmware/feed.hpp"

namespace gridrt::firmware {

namespace reg = wire::registers;

namespace {

constexpr uint32_t kWanted = 1U << reg::Feed::kSourceWantedBit;
constexpr uint32_t kGranted = 1U << reg::Feed::kSourceGrantedBit;
constexpr uint32_t kForced = 1U << reg::Feed::kSourceForcedBit;
constexpr uint32_t kValid = 1U << reg::Feed::kAnswerValidBit;

}  // namespace

bool Feed::take() {
  registers_.write(reg::Feed::kSource, kWanted);
  for (uint32_t polls = 0; polls < kGrantPolls; ++polls) {
    if ((registers_.read(reg::Feed::kSource) & kGranted) != 0) {
      for (uint32_t old = 0; old < kAnswerPolls && byte() >= 0; ++old) {
      }
      return true;
    }
  }
  registers_.write(reg::Feed::kSource, 0);
  return false;
}

void Feed::give_back() { registers_.write(reg::Feed::kSource, kForced); }

void Feed::put(uint32_t word) {
  registers_.write(reg::Watch::kAlive, 1);
  registers_.write(reg::Feed::kData, word);
}

int Feed::byte() {
  const uint32_t answer = registers_.read(reg::Feed::kAnswer);
  if ((answer & kValid) == 0) return -1;
  return static_cast<int>(answer & reg::Feed::kAnswerByteMask);
}

}  // namespace gridrt::firmware
