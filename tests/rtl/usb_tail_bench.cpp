// gridrt_usb_tail: bytes stay in order, and the last one before a pause is marked, no other.
#include <cstdint>
#include <deque>
#include <random>
#include <utility>

#include <Vgridrt_usb_tail.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"

namespace gridrt::rtl {
namespace {

TEST(UsbTail, MarksTheLastByteBeforeAPauseAndNoOther) {
  Clocked<Vgridrt_usb_tail> tail;
  std::mt19937 random(4);
  tail->in_valid_i = 0;
  tail->out_ready_i = 0;
  tail.reset();
  std::deque<std::pair<std::uint8_t, bool>> expected;  // a byte, and whether a pause follows it
  int pause = 0;
  int left = 0;
  int blocked = 0;
  int marked = 0;
  long bytes = 0;
  for (int clock = 0; clock < 200'000; ++clock) {
    if (pause > 0) {
      --pause;
    } else if (left == 0) {
      left = 1 + static_cast<int>(random() % 40);
    }
    tail->in_valid_i = pause == 0 && left > 0 ? 1 : 0;
    tail->in_data_i = static_cast<std::uint8_t>(clock);
    if (blocked > 0) --blocked;
    if (random() % 200 == 0) blocked = 80;  // a mark stays while it waits, whatever comes behind
    tail->out_ready_i = blocked == 0 && random() % 4 != 0 ? 1 : 0;
    tail.settle();
    if (tail->in_valid_i != 0 && tail->in_ready_o != 0) {
      --left;
      // The pause is long, or so short that it is none.
      if (left == 0) {
        pause = random() % 2 == 0 ? GRIDRT_RTL_PAUSE + 20 : static_cast<int>(random() % 8);
      }
      expected.emplace_back(static_cast<std::uint8_t>(clock), left == 0 && pause > 8);
      ++bytes;
    }
    if (tail->out_valid_o != 0 && tail->out_ready_i != 0) {
      ASSERT_FALSE(expected.empty());
      ASSERT_EQ(tail->out_data_o, expected.front().first) << clock;
      ASSERT_EQ(tail->out_last_o != 0, expected.front().second) << clock;
      marked += tail->out_last_o;
      expected.pop_front();
    }
    tail.tick();
  }
  EXPECT_LE(expected.size(), 2U);
  EXPECT_GT(bytes, 10'000);
  EXPECT_GT(marked, 500);
}

}  // namespace
}  // namespace gridrt::rtl
