// Codes of quarters, and the cells that they stand for.
#include <array>
#include <set>

#include <gtest/gtest.h>

#include "gridrt_protocol.hpp"
#include "host/grid/quarters.hpp"
#include "host/image/quarter_code.hpp"

namespace gridrt {
namespace {

TEST(Quarters, EveryIntervalHasACodeOfItsOwn) {
  std::set<std::uint32_t> codes;
  for (const unsigned x : protocol::kQuarterIntervals) {
    for (const unsigned y : protocol::kQuarterIntervals) {
      for (const unsigned z : protocol::kQuarterIntervals) {
        const auto quarters = static_cast<QuarterMasks>(x | y << 4U | z << 8U);
        const std::uint32_t code = quarter_code(quarters);
        EXPECT_LT(code, 1024U);
        EXPECT_TRUE(codes.insert(code).second);
        EXPECT_EQ(quarters_of_code(code), quarters);
      }
    }
  }
}

TEST(Quarters, CodesAreDenselyPackedDecimal) {
  // Examples of the encoding's definition: 005, 009, 055, 079, 080, 099, 555, 999.
  struct Example {
    unsigned z, y, x;
    std::uint32_t code;
  };
  constexpr std::array<Example, 8> kExamples{{{0, 0, 5, 0b0000000101},
                                              {0, 0, 9, 0b0000001001},
                                              {0, 5, 5, 0b0001010101},
                                              {0, 7, 9, 0b0001111001},
                                              {0, 8, 0, 0b0000001010},
                                              {0, 9, 9, 0b0001011111},
                                              {5, 5, 5, 0b1011010101},
                                              {9, 9, 9, 0b0011111111}}};
  for (const Example& e : kExamples) {
    const auto& intervals = protocol::kQuarterIntervals;
    const auto quarters =
        static_cast<QuarterMasks>(intervals[e.x] | intervals[e.y] << 4 | intervals[e.z] << 8);
    EXPECT_EQ(quarter_code(quarters), e.code) << e.z << e.y << e.x;
  }
  // Codes that none of these has mean something too: those of 888 with its spare bits set.
  EXPECT_EQ(quarters_of_code(0b1101101110), quarters_of_code(0b0001101110));
}

TEST(Quarters, CellsAreProductsOfQuarters) {
  for (unsigned masks = 0; masks < 4096; ++masks) {
    CellSet expected = 0;
    for (unsigned cell = 0; cell < 64; ++cell) {
      const bool here = ((masks >> (cell & 3U)) & (masks >> (4 + ((cell >> 2U) & 3U))) &
                         (masks >> (8 + (cell >> 4U))) & 1U) != 0;
      if (here) expected |= CellSet{1} << cell;
    }
    ASSERT_EQ(cells_of(static_cast<QuarterMasks>(masks)), expected) << masks;
  }
}

}  // namespace
}  // namespace gridrt
