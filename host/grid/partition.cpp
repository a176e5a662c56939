#include "host/grid/partition.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>

namespace gridrt {
namespace {

constexpr int kBoxesPerPe = 16;

struct Box {
  glm::ivec3 lo{0};  ///< first voxel
  glm::ivec3 hi{0};  ///< one past the last
};

/// References in the slabs of a box along one axis.
std::vector<std::uint64_t> slab_weights(const VoxelGrid& grid, const VoxelLists& lists,
                                        const Box& box, int axis) {
  std::vector<std::uint64_t> weights(static_cast<std::size_t>(box.hi[axis] - box.lo[axis]), 0);
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const glm::ivec3 cell{x, y, z};
        const std::size_t i = grid.index(cell);
        weights[static_cast<std::size_t>(cell[axis] - box.lo[axis])] +=
            lists.first[i + 1] - lists.first[i];
      }
    }
  }
  return weights;
}

/// Splits `box` into `parts` boxes of about equal reference counts, along its longest axis first.
/// `parts` halves each time, so the recursion is log2(parts) deep.
void split(const VoxelGrid& grid, const VoxelLists& lists, const Box& box, int parts,
           std::vector<Box>& out) {
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (box.hi[a] - box.lo[a] > box.hi[axis] - box.lo[axis]) axis = a;
  }
  const int length = box.hi[axis] - box.lo[axis];
  if (parts <= 1 || length <= 1) {
    out.push_back(box);
    return;
  }
  const std::vector<std::uint64_t> weights = slab_weights(grid, lists, box, axis);
  std::uint64_t total = 0;
  for (const std::uint64_t w : weights) total += w;
  const int left_parts = parts / 2;
  // The cut after which the left side holds nearest to its share.
  const double share = static_cast<double>(total) * left_parts / parts;
  double best = std::numeric_limits<double>::infinity();
  int cut = 1;
  std::uint64_t sum = 0;
  for (int i = 1; i < length; ++i) {
    sum += weights[static_cast<std::size_t>(i - 1)];
    const double miss = std::abs(static_cast<double>(sum) - share);
    if (miss < best) {
      best = miss;
      cut = i;
    }
  }
  Box left = box;
  Box right = box;
  left.hi[axis] = box.lo[axis] + cut;
  right.lo[axis] = left.hi[axis];
  split(grid, lists, left, left_parts, out);
  split(grid, lists, right, parts - left_parts, out);
}

}  // namespace

Result<Mapping> parse_mapping(std::string_view name) {
  for (const Mapping m : {Mapping::kBoxes, Mapping::kContiguous, Mapping::kVoxel}) {
    if (mapping_name(m) == name) return m;
  }
  return fail(ErrorKind::kUsage, fmt::format("mapping '{}' is not known", name),
              "choose boxes, contiguous or voxel");
}

std::string_view mapping_name(Mapping mapping) {
  switch (mapping) {
    case Mapping::kBoxes:
      return "boxes";
    case Mapping::kContiguous:
      return "contiguous";
    case Mapping::kVoxel:
      return "voxel";
  }
  return "?";
}

Result<std::vector<std::uint8_t>> deal_voxels(const VoxelGrid& grid, const VoxelLists& lists,
                                              Mapping mapping, int pes) {
  if (pes < 1 || pes > kMaxPes) {
    return fail(ErrorKind::kUsage, fmt::format("{} PEs asked for", pes),
                fmt::format("choose between 1 and {}", kMaxPes));
  }
  std::vector<std::uint8_t> owner(grid.cells(), 0);
  std::vector<Box> boxes;
  if (mapping != Mapping::kVoxel) {
    split(grid, lists, {glm::ivec3{0}, grid.count},
          mapping == Mapping::kBoxes ? kBoxesPerPe * pes : pes, boxes);
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto pe = static_cast<std::uint8_t>(i % static_cast<std::size_t>(pes));
    for (int z = boxes[i].lo.z; z < boxes[i].hi.z; ++z) {
      for (int y = boxes[i].lo.y; y < boxes[i].hi.y; ++y) {
        const std::size_t row = grid.index({boxes[i].lo.x, y, z});
        std::fill_n(owner.begin() + static_cast<std::ptrdiff_t>(row), boxes[i].hi.x - boxes[i].lo.x,
                    pe);
      }
    }
  }
  if (mapping == Mapping::kVoxel) {
    for (int z = 0; z < grid.count.z; ++z) {
      for (int y = 0; y < grid.count.y; ++y) {
        for (int x = 0; x < grid.count.x; ++x) {
          owner[grid.index({x, y, z})] = static_cast<std::uint8_t>((x + y + z) % pes);
        }
      }
    }
  }
  return owner;
}

}  // namespace gridrt
