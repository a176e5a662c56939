// gridrt_fifo against a queue of the library, with random stalls on both sides.
#include <cstdint>
#include <deque>
#include <random>

#include <Vgridrt_fifo.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"

namespace gridrt::rtl {
namespace {

class Fifo : public testing::TestWithParam<std::pair<int, int>> {};

// What goes in comes out, in order; ready and valid tell exactly whether there is room or content.
TEST_P(Fifo, KeepsOrderUnderRandomStalls) {
  const auto [offer, take] = GetParam();  // percent of clocks
  Clocked<Vgridrt_fifo> fifo;
  std::mt19937 random(7);
  std::deque<std::uint16_t> expected;
  bool full = false;
  bool empty = false;
  fifo->in_valid_i = 0;
  fifo->out_ready_i = 0;
  fifo.reset();
  for (int clock = 0; clock < 20'000; ++clock) {
    fifo->in_valid_i = static_cast<int>(random() % 100) < offer;
    fifo->in_data_i = static_cast<std::uint16_t>(random());
    fifo->out_ready_i = static_cast<int>(random() % 100) < take;
    fifo.settle();
    ASSERT_EQ(fifo->count_o, expected.size());
    ASSERT_EQ(fifo->in_ready_o, expected.size() < GRIDRT_RTL_DEPTH);
    ASSERT_EQ(fifo->out_valid_o, !expected.empty());
    if (!expected.empty()) {
      ASSERT_EQ(fifo->out_data_o, expected.front());
    }
    full = full || expected.size() == GRIDRT_RTL_DEPTH;
    empty = empty || (clock > 100 && expected.empty());
    const bool push = fifo->in_valid_i && fifo->in_ready_o;
    const bool pop = fifo->out_valid_o && fifo->out_ready_i;
    if (pop) expected.pop_front();
    if (push) expected.push_back(fifo->in_data_i);
    fifo.tick();
  }
  EXPECT_TRUE(full || offer < take) << "this test has never filled the queue";
  EXPECT_TRUE(empty || take < offer) << "this test has never emptied the queue";
}

INSTANTIATE_TEST_SUITE_P(Stalls, Fifo,
                         testing::Values(std::pair{50, 50}, std::pair{90, 30}, std::pair{20, 80},
                                         std::pair{100, 99}));

}  // namespace
}  // namespace gridrt::rtl
