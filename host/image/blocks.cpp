#include "host/image/blocks.hpp"

#include <algorithm>

namespace gridrt {
namespace {

/// Replaces each value of a row of `count` values, `stride` apart, by the smallest of itself and
/// its neighbours.
void row_minimum(std::vector<std::uint8_t>& values, std::size_t first, std::size_t stride,
                 int count) {
  std::uint8_t before = values[first];
  std::size_t at = first;
  for (int i = 0; i < count; ++i, at += stride) {
    const std::uint8_t here = values[at];
    const std::uint8_t after = i + 1 < count ? values[at + stride] : here;
    values[at] = std::min({before, here, after});
    before = here;
  }
}

/// Offsets of a block array, x fastest.
std::array<std::size_t, 3> strides(const glm::ivec3& blocks) {
  const auto x = static_cast<std::size_t>(blocks.x);
  return {1, x, x * static_cast<std::size_t>(blocks.y)};
}

/// Fills in one direction of the skip field, layer by layer against the direction: with h = 0 for
/// an occupied block and 8 else, J = min(7, smallest of min(h, J of the layer ahead + 1) over the
/// 3x3 neighbourhood), since the cone of a block is its neighbourhood and the cones of the nine
/// blocks ahead.
void fill_direction(const glm::ivec3& blocks, std::span<const std::uint8_t> occupancy,
                    std::size_t direction, std::vector<Jumps>& jumps) {
  const int axis = static_cast<int>(direction / 2);
  const bool forward = direction % 2 == 0;
  const int b = (axis + 1) % 3;
  const int c = (axis + 2) % 3;
  const std::array<std::size_t, 3> stride = strides(blocks);
  const auto stride_of = [&](int a) { return stride[static_cast<std::size_t>(a)]; };
  const auto columns = static_cast<std::size_t>(blocks[b]);
  const auto rows = static_cast<std::size_t>(blocks[c]);
  std::vector<std::uint8_t> layer(columns * rows, kMaxJump);
  for (int step = 0; step < blocks[axis]; ++step) {
    const int slab = forward ? blocks[axis] - 1 - step : step;
    const std::size_t base = static_cast<std::size_t>(slab) * stride_of(axis);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t q = 0; q < columns; ++q) {
        const std::size_t block = base + r * stride_of(c) + q * stride_of(b);
        std::uint8_t& value = layer[r * columns + q];
        value = occupancy[block] != 0 ? 0 : static_cast<std::uint8_t>(value + 1);
      }
      row_minimum(layer, r * columns, 1, blocks[b]);
    }
    for (std::size_t q = 0; q < columns; ++q) row_minimum(layer, q, columns, blocks[c]);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t q = 0; q < columns; ++q) {
        const std::size_t block = base + r * stride_of(c) + q * stride_of(b);
        std::uint8_t& value = layer[r * columns + q];
        value = std::min<std::uint8_t>(value, kMaxJump);
        jumps[block][direction] = value;
      }
    }
  }
}

}  // namespace

glm::ivec3 block_count(const VoxelGrid& grid) { return (grid.count + 1) / 2; }

std::size_t block_total(const VoxelGrid& grid) {
  const glm::ivec3 blocks = block_count(grid);
  return static_cast<std::size_t>(blocks.x) * static_cast<std::size_t>(blocks.y) *
         static_cast<std::size_t>(blocks.z);
}

glm::ivec3 block_voxel(const glm::ivec3& block, int bit) {
  return {2 * block.x + (bit & 1), 2 * block.y + ((bit >> 1) & 1), 2 * block.z + (bit >> 2)};
}

bool in_grid(const VoxelGrid& grid, const glm::ivec3& voxel) {
  return voxel.x < grid.count.x && voxel.y < grid.count.y && voxel.z < grid.count.z;
}

std::vector<std::uint8_t> block_occupancy(const VoxelGrid& grid, const VoxelLists& lists) {
  const std::array<std::size_t, 3> stride = strides(block_count(grid));
  std::vector<std::uint8_t> occupancy(block_total(grid), 0);
  std::size_t cell = 0;
  for (int z = 0; z < grid.count.z; ++z) {
    for (int y = 0; y < grid.count.y; ++y) {
      const std::size_t row =
          static_cast<std::size_t>(y / 2) * stride[1] + static_cast<std::size_t>(z / 2) * stride[2];
      for (int x = 0; x < grid.count.x; ++x, ++cell) {
        if (lists.first[cell + 1] == lists.first[cell]) continue;
        const int bit = (x & 1) + 2 * (y & 1) + 4 * (z & 1);
        occupancy[row + static_cast<std::size_t>(x / 2)] |= static_cast<std::uint8_t>(1U << bit);
      }
    }
  }
  return occupancy;
}

std::vector<Jumps> skip_field(const glm::ivec3& blocks, std::span<const std::uint8_t> occupancy) {
  std::vector<Jumps> jumps(occupancy.size());
  for (std::size_t d = 0; d < 6; ++d) fill_direction(blocks, occupancy, d, jumps);
  return jumps;
}

}  // namespace gridrt
