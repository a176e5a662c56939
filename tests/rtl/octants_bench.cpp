// gridrt_octants against what its inputs mean, for every axis and voxel.
#include <array>
#include <cstdint>
#include <random>

#include <Vgridrt_octants.h>
#include <gtest/gtest.h>

namespace gridrt::rtl {
namespace {

TEST(Octants, ThoseOfEachVoxelForEveryAxis) {
  VerilatedContext context;
  Vgridrt_octants rtl(&context);
  std::mt19937_64 random(7);
  for (int round = 0; round < 20000; ++round) {
    const auto axis = static_cast<unsigned>(round % 3);
    const std::uint64_t holds = random() % 16;
    const std::uint64_t b = random() & random() & 0xFFFF;
    const std::uint64_t c = random() & random() & 0xFFFF;
    rtl.way_i = std::uint64_t{axis} << 36U | holds << 32U | c << 16U | b;
    for (unsigned voxel = 0; voxel < 8; ++voxel) {
      rtl.voxel_i = static_cast<std::uint8_t>(voxel);
      rtl.eval();
      unsigned expected = 0;
      for (unsigned octant = 0; octant < 8; ++octant) {
        // In halves of the block, by axis.
        std::array<unsigned, 3> half{};
        for (unsigned a = 0; a < 3; ++a) {
          half[a] = 2 * ((voxel >> a) & 1U) + ((octant >> a) & 1U);
        }
        const unsigned slab = half[axis];
        const bool in_b = ((b >> (4 * slab + half[(axis + 1) % 3])) & 1U) != 0;
        const bool in_c = ((c >> (4 * slab + half[(axis + 2) % 3])) & 1U) != 0;
        if (((holds >> slab) & 1U) != 0 && in_b && in_c) expected |= 1U << octant;
      }
      ASSERT_EQ(rtl.octants_o, expected) << "axis " << axis << ", voxel " << voxel;
    }
  }
}

}  // namespace
}  // namespace gridrt::rtl
