// gridrt_ray_cells against what its inputs mean, for every axis and voxel.
#include <array>
#include <cstdint>
#include <random>

#include <Vgridrt_ray_cells.h>
#include <gtest/gtest.h>

#include "tests/rtl/ports.hpp"

namespace gridrt::rtl {
namespace {

TEST(RayCells, ThoseOfEachVoxelForEveryAxis) {
  VerilatedContext context;
  Vgridrt_ray_cells rtl(&context);
  std::mt19937_64 random(7);
  for (int round = 0; round < 20000; ++round) {
    const auto axis = static_cast<unsigned>(round % 3);
    const auto holds = static_cast<unsigned>(random() % 256);
    // Quarters of the block, 0 to 7, or outside, at the faces of quarter-slabs.
    std::array<std::array<unsigned, 9>, 2> sample{};
    for (auto& row : sample) {
      unsigned at = static_cast<unsigned>(random() % 16);
      for (unsigned& s : row) s = at = (at + static_cast<unsigned>(random() % 2)) % 16;
    }
    for (int k = 0; k < 9; ++k) {
      put_bits(rtl.way_i, 4 * k, 4, sample[0][static_cast<std::size_t>(k)]);
      put_bits(rtl.way_i, 36 + 4 * k, 4, sample[1][static_cast<std::size_t>(k)]);
    }
    put_bits(rtl.way_i, 72, 8, holds);
    put_bits(rtl.way_i, 80, 2, axis);
    for (unsigned voxel = 0; voxel < 8; ++voxel) {
      rtl.voxel_i = static_cast<std::uint8_t>(voxel);
      rtl.eval();
      const auto half_of = [&](unsigned a) { return (voxel >> (a % 3)) & 1U; };
      std::uint64_t expected = std::uint64_t{axis} << 32U;
      for (unsigned slab = 0; slab < 4; ++slab) {
        const unsigned face = 4 * half_of(axis) + slab;
        for (unsigned n = 0; n < 2; ++n) {
          for (const unsigned s : {sample[n][face], sample[n][face + 1]}) {
            if (s / 4 != half_of(axis + 1 + n)) continue;
            if (n == 0 && ((holds >> face) & 1U) == 0) continue;
            expected |= std::uint64_t{1} << ((n == 0 ? 16U : 0U) + 4 * slab + s % 4);
          }
        }
      }
      ASSERT_EQ(rtl.cells_o, expected) << "axis " << axis << ", voxel " << voxel;
    }
  }
}

}  // namespace
}  // namespace gridrt::rtl
