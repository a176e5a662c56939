// gridrt_match against the cells that a reference's code and a task's cells stand for.
#include <Vgridrt_match.h>
#include <gtest/gtest.h>

#include "host/image/quarter_code.hpp"
#include "tests/rtl/cell_set.hpp"

namespace gridrt::rtl {
namespace {

TEST(Match, PassesWhatSharesACell) {
  VerilatedContext context;
  Vgridrt_match rtl(&context);
  std::mt19937_64 random(11);
  int passed = 0;
  constexpr int kRounds = 200000;
  for (int round = 0; round < kRounds; ++round) {
    const auto code = static_cast<unsigned>(round % 1024);
    const std::uint64_t cells = random_cells(random);
    const auto axis = static_cast<unsigned>(cells >> 32U);
    const unsigned quarters = quarters_of_code(code);
    unsigned masks = 0;  // from the dominant axis on
    for (unsigned i = 0; i < 3; ++i) {
      masks |= ((quarters >> (4 * ((axis + i) % 3))) & 15U) << (4 * i);
    }
    rtl.masks_i = static_cast<std::uint16_t>(masks);
    rtl.cells_i = static_cast<std::uint32_t>(cells);
    rtl.eval();
    const bool shares = (cells_of(static_cast<QuarterMasks>(quarters)) & cell_set(cells)) != 0;
    ASSERT_EQ(rtl.match_o != 0, shares) << "code " << code << ", cells " << cells;
    passed += shares ? 1 : 0;
  }
  EXPECT_GT(passed, kRounds / 10);
  EXPECT_LT(passed, kRounds * 9 / 10);
}

}  // namespace
}  // namespace gridrt::rtl
