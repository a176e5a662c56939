#include "host/grid/traversal.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace gridrt {
namespace {

std::int64_t floor_div(std::int64_t a, std::int64_t b) {  // b > 0
  const std::int64_t q = a / b;
  return q * b > a ? q - 1 : q;
}

/// Index of the last closed interval [k e, (k + 1) e] that contains x.
std::int64_t upper_index(std::int64_t x, std::int64_t e) { return floor_div(x, e); }

/// Index of the first one.
std::int64_t lower_index(std::int64_t x, std::int64_t e) { return -floor_div(-x, e) - 1; }

int clamp_index(std::int64_t i, int count) {
  return static_cast<int>(std::clamp<std::int64_t>(i, 0, count - 1));
}

}  // namespace

SlabMarch::SlabMarch(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1)
    : grid_(grid), p0_(p0), d_(p1 - p0) {
  // Dominant: the axis along which the segment crosses most voxels, |d| / edge, compared without
  // division. Then a slab sees a drift of at most one voxel on the other axes.
  int a = 0;
  for (int i = 1; i < 3; ++i) {
    const std::int64_t here = std::int64_t{std::abs(d_[i])} * grid.edge[a];
    const std::int64_t best = std::int64_t{std::abs(d_[a])} * grid.edge[i];
    if (here > best) a = i;
  }
  axis_ = {a, (a + 1) % 3, (a + 2) % 3};
  sign_ = d_[a] > 0 ? 1 : -1;
  const int edge = grid.edge[a];
  const int count = grid.count[a];
  const int first = sign_ > 0 ? clamp_index(lower_index(p0[a], edge), count)
                              : clamp_index(upper_index(p0[a], edge), count);
  const int last = sign_ > 0 ? clamp_index(upper_index(p1[a], edge), count)
                             : clamp_index(lower_index(p1[a], edge), count);
  slab_ = first;
  slabs_left_ = (last - first) * sign_ + 1;
}

SlabMarch::Range SlabMarch::lateral_range(int axis, std::int64_t enter, std::int64_t leave) const {
  // Coordinates times |d_a|, so that the positions at enter / |d_a| and leave / |d_a| are integers
  // (below 2^50).
  const std::int64_t scale = std::abs(d_[axis_[0]]);
  const std::int64_t edge = std::int64_t{grid_.edge[axis]} * scale;
  const std::int64_t at_enter = p0_[axis] * scale + d_[axis] * enter;
  const std::int64_t at_leave = p0_[axis] * scale + d_[axis] * leave;
  if (d_[axis] >= 0) {
    return {clamp_index(lower_index(at_enter, edge), grid_.count[axis]),
            clamp_index(upper_index(at_leave, edge), grid_.count[axis])};
  }
  return {clamp_index(upper_index(at_enter, edge), grid_.count[axis]),
          clamp_index(lower_index(at_leave, edge), grid_.count[axis])};
}

VoxelVisit SlabMarch::within(int axis, int voxel, const VoxelVisit& slab) const {
  VoxelVisit v = slab;
  v.voxel[axis] = voxel;
  const std::int64_t d = d_[axis];
  if (d == 0) return v;
  const std::int64_t low = std::int64_t{voxel} * grid_.edge[axis] - p0_[axis];
  const std::int64_t high = low + grid_.edge[axis];
  const Fraction enter = d > 0 ? Fraction{low, d} : Fraction{-high, -d};
  const Fraction leave = d > 0 ? Fraction{high, d} : Fraction{-low, -d};
  if (v.enter < enter) v.enter = enter;
  if (leave < v.leave) v.leave = leave;
  return v;
}

std::span<const VoxelVisit> SlabMarch::voxels() {
  count_ = 0;
  const int a = axis_[0];
  const int edge = grid_.edge[a];
  const std::int64_t length = std::abs(d_[a]);
  const std::int64_t low = std::int64_t{slab_} * edge;
  const std::int64_t enter_face = sign_ > 0 ? low - p0_[a] : p0_[a] - (low + edge);
  const std::int64_t enter = std::clamp<std::int64_t>(enter_face, 0, length);
  const std::int64_t leave = std::clamp<std::int64_t>(enter_face + edge, 0, length);
  VoxelVisit slab;
  slab.voxel[a] = slab_;
  slab.enter = {enter, length};
  slab.leave = {leave, length};

  const int b = axis_[1];
  const int c = axis_[2];
  const Range rb = lateral_range(b, enter, leave);
  const Range rc = lateral_range(c, enter, leave);
  if (rb.first == rb.last && rc.first == rc.last) {
    slab.voxel[b] = rb.first;
    slab.voxel[c] = rc.first;
    visits_[count_++] = slab;
    return {visits_.data(), count_};
  }
  const int step_b = rb.last < rb.first ? -1 : 1;
  const int step_c = rc.last < rc.first ? -1 : 1;
  for (int j = rb.first;; j += step_b) {
    const VoxelVisit row = within(b, j, slab);
    for (int l = rc.first;; l += step_c) {
      const VoxelVisit v = within(c, l, row);
      if (!(v.leave < v.enter)) {
        std::size_t at = count_++;
        for (; at > 0 && v.enter < visits_[at - 1].enter; --at) visits_[at] = visits_[at - 1];
        visits_[at] = v;
      }
      if (l == rc.last) break;
    }
    if (j == rb.last) break;
  }
  return {visits_.data(), count_};
}

void SlabMarch::advance(int slabs) {
  slab_ += sign_ * slabs;
  slabs_left_ -= slabs;
  step_ += slabs;
}

void SlabMarch::skip_blocks(int blocks) {
  const int block = slab_ >> 1;
  const int target = sign_ > 0 ? 2 * (block + blocks) : 2 * (block - blocks) + 1;
  advance(std::abs(target - slab_));
}

}  // namespace gridrt
