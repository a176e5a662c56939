// Grids and segments that are hard for a march through voxels.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

#include "host/grid/voxel_grid.hpp"
#include "tests/adversarial/random.hpp"

namespace gridrt::march {

using adversarial::Random;

struct Segment {
  glm::ivec3 p0{0};
  glm::ivec3 p1{0};
};

/// A grid of `count` voxels over a lattice box whose largest coordinates are `box`.
inline VoxelGrid grid_over(const glm::ivec3& box, const glm::ivec3& count) {
  VoxelGrid g;
  g.count = count;
  for (int a = 0; a < 3; ++a) g.edge[a] = std::max(1, (box[a] + count[a] - 1) / count[a]);
  return g;
}

struct Case {
  VoxelGrid grid;
  glm::ivec3 box{1};
};

/// Grids with odd counts, single voxels, many thin voxels, for lattices of 12, 14 or 17 bits.
inline std::vector<Case> hard_grids(int bits) {
  const int top = (1 << bits) - 1;
  const std::vector<glm::ivec3> counts{{7, 2, 12},  {1, 1, 1},  {44, 21, 27}, {512, 2, 2},
                                       {2, 512, 3}, {1, 3, 5},  {33, 1, 9},   {16, 16, 16},
                                       {5, 64, 1},  {1, 1, 511}};
  std::vector<Case> cases;
  for (const glm::ivec3& count : counts) {
    for (int shape = 0; shape < 3; ++shape) {
      glm::ivec3 box{top};
      if (shape == 1) box = {top - 3, (3 * top) / 4, (2 * top) / 3 + 1};
      if (shape == 2) box = glm::max(count * 4, glm::ivec3{top / 2, top / 3, 5});
      if (shape == 2) box = glm::min(box, glm::ivec3{top});
      cases.push_back({grid_over(box, count), box});
    }
  }
  return cases;
}

/// A coordinate on an axis: anywhere, on a face or next to one, at either end of the box.
inline int hard_coordinate(Random& random, int edge, int box) {
  switch (random.below(6)) {
    case 0:
      return 0;
    case 1:
      return box;
    case 2:
    case 3: {
      const int face =
          static_cast<int>(random.below(static_cast<std::uint64_t>(box / edge + 1))) * edge;
      return std::clamp(face + random.between(-1, 1), 0, box);
    }
    default:
      return random.between(0, box);
  }
}

/// Segments: free, along an axis, in a face, along diagonals of voxels, short, through corners.
inline Segment hard_segment(Random& random, const Case& c) {
  Segment s;
  const glm::ivec3& edge = c.grid.edge;
  const auto point = [&] {
    glm::ivec3 p{0};
    for (int a = 0; a < 3; ++a) p[a] = hard_coordinate(random, edge[a], c.box[a]);
    return p;
  };
  do {
    s.p0 = point();
    s.p1 = point();
    switch (random.below(8)) {
      case 0: {  // along one axis
        const int a = random.between(0, 2);
        const int keep = s.p1[a];
        s.p1 = s.p0;
        s.p1[a] = keep;
        break;
      }
      case 1: {  // within a plane
        const int a = random.between(0, 2);
        s.p1[a] = s.p0[a];
        break;
      }
      case 2: {  // along a diagonal of the voxels, through corners if it starts at one
        int k = random.between(1, 40);
        glm::ivec3 d{0};
        for (int a = 0; a < 3; ++a) d[a] = random.between(-1, 1);
        for (int a = 0; a < 3; ++a) s.p0[a] = s.p0[a] / edge[a] * edge[a];
        const auto outside = [&](const glm::ivec3& p) {
          for (int a = 0; a < 3; ++a) {
            if (p[a] < 0 || p[a] > c.box[a]) return true;
          }
          return false;
        };
        while (k > 0 && outside(s.p0 + k * d * edge)) --k;
        s.p1 = s.p0 + k * d * edge;
        break;
      }
      case 3:  // short
        for (int a = 0; a < 3; ++a) {
          s.p1[a] = std::clamp(s.p0[a] + random.between(-3, 3), 0, c.box[a]);
        }
        break;
      default:
        break;
    }
  } while (s.p0 == s.p1);
  return s;
}

}  // namespace gridrt::march
