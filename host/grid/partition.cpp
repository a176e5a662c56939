#include "host/grid/partition.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include <fmt/format.h>

namespace gridrt {
namespace {

constexpr int kBoxesPerPe = 16;

/// References in the slabs of a box along one axis.
std::vector<std::uint64_t> slab_weights(const VoxelGrid& grid, const VoxelLists& lists,
                                        const VoxelBox& box, int axis) {
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

int longest_axis(const VoxelBox& box) {
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (box.hi[a] - box.lo[a] > box.hi[axis] - box.lo[axis]) axis = a;
  }
  return axis;
}

/// Splits `box` into `parts` boxes of about equal reference counts, along its longest axis first.
/// `parts` halves each time, so the recursion is log2(parts) deep.
void split(const VoxelGrid& grid, const VoxelLists& lists, const VoxelBox& box, int parts,
           std::vector<VoxelBox>& out) {
  const int axis = longest_axis(box);
  if (parts <= 1 || box.hi[axis] - box.lo[axis] <= 1) {
    out.push_back(box);
    return;
  }
  const int left_parts = parts / 2;
  const auto [left, right] = cut_box(grid, lists, box, static_cast<double>(left_parts) / parts);
  split(grid, lists, left, left_parts, out);
  split(grid, lists, right, parts - left_parts, out);
}

}  // namespace

std::pair<VoxelBox, VoxelBox> cut_box(const VoxelGrid& grid, const VoxelLists& lists,
                                      const VoxelBox& box, double share) {
  const int axis = longest_axis(box);
  const std::vector<std::uint64_t> weights = slab_weights(grid, lists, box, axis);
  std::uint64_t total = 0;
  for (const std::uint64_t w : weights) total += w;
  const double wanted = static_cast<double>(total) * share;
  double best = std::numeric_limits<double>::infinity();
  int cut = 1;
  std::uint64_t sum = 0;
  for (int i = 1; i < box.hi[axis] - box.lo[axis]; ++i) {
    sum += weights[static_cast<std::size_t>(i - 1)];
    const double miss = std::abs(static_cast<double>(sum) - wanted);
    if (miss < best) {
      best = miss;
      cut = i;
    }
  }
  std::pair<VoxelBox, VoxelBox> halves{box, box};
  halves.first.hi[axis] = box.lo[axis] + cut;
  halves.second.lo[axis] = halves.first.hi[axis];
  return halves;
}

std::vector<VoxelBox> balanced_boxes(const VoxelGrid& grid, const VoxelLists& lists, int parts) {
  std::vector<VoxelBox> boxes;
  split(grid, lists, {glm::ivec3{0}, grid.count}, parts, boxes);
  return boxes;
}

void give_box(const VoxelGrid& grid, const VoxelBox& box, std::uint8_t pe,
              std::vector<std::uint8_t>& owners) {
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      const std::size_t row = grid.index({box.lo.x, y, z});
      std::fill_n(owners.begin() + static_cast<std::ptrdiff_t>(row), box.hi.x - box.lo.x, pe);
    }
  }
}

Result<Mapping> parse_mapping(std::string_view name) {
  for (const Mapping m :
       {Mapping::kBoxes, Mapping::kContiguous, Mapping::kVoxel, Mapping::kMeasured}) {
    if (mapping_name(m) == name) return m;
  }
  return fail(ErrorKind::kUsage, fmt::format("mapping '{}' is not known", name),
              "choose measured, boxes, contiguous or voxel");
}

std::string_view mapping_name(Mapping mapping) {
  switch (mapping) {
    case Mapping::kBoxes:
      return "boxes";
    case Mapping::kContiguous:
      return "contiguous";
    case Mapping::kVoxel:
      return "voxel";
    case Mapping::kMeasured:
      return "measured";
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
  if (grid.cells() <= static_cast<std::size_t>(pes)) {
    std::iota(owner.begin(), owner.end(), std::uint8_t{0});
    return owner;
  }
  if (mapping != Mapping::kVoxel) {
    const int parts = mapping == Mapping::kContiguous ? pes : kBoxesPerPe * pes;
    const std::vector<VoxelBox> boxes = balanced_boxes(grid, lists, parts);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      give_box(grid, boxes[i], static_cast<std::uint8_t>(i % static_cast<std::size_t>(pes)), owner);
    }
  } else {
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
