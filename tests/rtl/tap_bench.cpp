// What gridrt_tap tells of a task: its fields, and the octants that hold one of its cells.
#include <Vgridrt_tap.h>
#include <gtest/gtest.h>

#include "tests/rtl/cell_set.hpp"
#include "tests/rtl/ports.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kTaskBits = 82;  ///< TASK_W

TEST(Tap, TellsTheOctantsOfATasksCells) {
  VerilatedContext context;
  Vgridrt_tap rtl(&context);
  std::mt19937_64 random(13);
  for (int round = 0; round < 50000; ++round) {
    // One of the two expanders has a task; what the other one offers counts for nothing.
    const auto who = static_cast<int>(round % 2);
    for (int at = 0; at < 2 * kTaskBits; at += 41) put_bits(rtl.task_i, at, 41, random());
    const std::uint64_t cells = random_cells(random);
    put_bits(rtl.task_i, who * kTaskBits + 18, 34, cells);
    rtl.task_valid_i = static_cast<std::uint8_t>(1U << static_cast<unsigned>(who));
    rtl.task_pe_i = static_cast<std::uint8_t>(random() % 16);
    rtl.eval();

    const CellSet set = cell_set(cells);
    unsigned octants = 0;
    for (unsigned cell = 0; cell < 64; ++cell) {
      if ((set >> cell & 1U) == 0) continue;
      octants |= 1U << ((cell >> 1 & 1U) | (cell >> 3 & 1U) << 1U | (cell >> 5 & 1U) << 2U);
    }
    const auto task = [&](int at, int width) {
      return get_bits(rtl.task_i, who * kTaskBits + at, width);
    };
    ASSERT_EQ(get_bits(rtl.tap_o, 170, 8), octants) << "cells " << cells;
    ASSERT_EQ(get_bits(rtl.tap_o, 152, 18), task(0, 18));   // entry
    ASSERT_EQ(get_bits(rtl.tap_o, 178, 10), task(52, 10));  // count
    ASSERT_EQ(get_bits(rtl.tap_o, 188, 14), task(62, 14));  // first
    ASSERT_EQ(get_bits(rtl.tap_o, 202, 2), (unsigned{rtl.task_pe_i} >> (2 * who)) & 3U);
    ASSERT_EQ(get_bits(rtl.tap_o, 204, 1), 1U);
  }
}

}  // namespace
}  // namespace gridrt::rtl
