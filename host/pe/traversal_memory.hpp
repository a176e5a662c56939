// The traversal section as a device holds it: which voxels have references, who owns them, and
// how far empty space reaches.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/grid/voxel_grid.hpp"
#include "host/pe/refusal.hpp"

namespace gridrt {

/// A voxel's list of references in its owner's memory.
struct Cell {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t pe = 0;
};

class TraversalMemory {
 public:
  /// Decodes blocks and cells and checks them against the header's grid.
  static Accepted<TraversalMemory> decode(const protocol::ImageHeader& header,
                                          std::span<const std::byte> blocks,
                                          std::span<const std::byte> cells);

  [[nodiscard]] const VoxelGrid& grid() const { return grid_; }
  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }

  /// The voxel's cell, or nullptr if it has no references.
  [[nodiscard]] const Cell* find(const glm::ivec3& voxel) const {
    const Block& block = blocks_[block_index(voxel)];
    const unsigned bit =
        static_cast<unsigned>((voxel.x & 1) | ((voxel.y & 1) << 1) | ((voxel.z & 1) << 2));
    if (((block.occupancy >> bit) & 1U) == 0) return nullptr;
    const unsigned before = block.occupancy & ((1U << bit) - 1U);
    return &cells_[block.base + static_cast<unsigned>(std::popcount(before))];
  }

  /// Blocks that a ray with dominant direction 0 to 5 (+x -x +y -y +z -z) may leave out.
  [[nodiscard]] int jump(const glm::ivec3& voxel, int direction) const {
    return blocks_[block_index(voxel)].jump[static_cast<std::size_t>(direction)];
  }

 private:
  struct Block {
    std::uint32_t base = 0;
    std::uint8_t occupancy = 0;
    std::array<std::uint8_t, 6> jump{};
  };
  [[nodiscard]] std::size_t block_index(const glm::ivec3& v) const {
    return (static_cast<std::size_t>(v.z >> 1) * static_cast<std::size_t>(block_count_.y) +
            static_cast<std::size_t>(v.y >> 1)) *
               static_cast<std::size_t>(block_count_.x) +
           static_cast<std::size_t>(v.x >> 1);
  }

  VoxelGrid grid_;
  glm::ivec3 block_count_{1};
  std::vector<Block> blocks_;
  std::vector<Cell> cells_;
};

}  // namespace gridrt
