// Blocks for the march: random voxels and the skip field that belongs to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/image/blocks.hpp"
#include "tests/rtl/march_model.hpp"
#include "tests/rtl/march_segments.hpp"

namespace gridrt::march {

/// A record for each block of the grid; a part `density` of them (0 to 1) is occupied.
inline std::vector<Block> random_blocks(Random& random, const Grid& g, double density) {
  const std::size_t total =
      static_cast<std::size_t>(g.stride.z) * static_cast<std::size_t>(g.half_blocks.z);
  std::vector<std::uint8_t> occupancy(total, 0);
  for (std::uint8_t& o : occupancy) {
    if (random.chance(density)) o = static_cast<std::uint8_t>(random.between(1, 255));
  }
  const std::vector<Jumps> jumps = skip_field(g.half_blocks, occupancy);
  std::vector<Block> blocks(total);
  for (std::size_t i = 0; i < total; ++i) {
    blocks[i].occupied = occupancy[i] != 0;
    blocks[i].occ = occupancy[i];
    blocks[i].base = static_cast<int>(i % 8192);
    for (std::size_t d = 0; d < 6; ++d) blocks[i].jump[d] = jumps[i][d];
  }
  return blocks;
}

}  // namespace gridrt::march
