// Case 24: the voxels visited are those that the segment meets, by exact arithmetic of another
// kind (separating axes), and their order and parameters are right (clipping in rationals).
#include <algorithm>
#include <cstdio>
#include <set>

#include <gtest/gtest.h>

#include "host/grid/quarters.hpp"
#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"
#include "tests/adversarial/voxel_truth.hpp"

namespace gridrt::adversarial {
namespace {

using truth::Rational;

constexpr int kWhole = -1;

/// The part of [0, 1] within the voxel's closed box, or within a cell of it (two bits an axis: the
/// quarter), by clipping in rationals; empty: first > last.
struct Part {
  Rational first = 0;
  Rational last = 1;
};
Part clip(const VoxelGrid& grid, const glm::ivec3& voxel, const Segment& s, int cell = kWhole) {
  Part part;
  for (int i = 0; i < 3; ++i) {
    Rational low = voxel[i] * grid.edge[i] - s.p0[i];
    Rational high = low + grid.edge[i];
    if (cell != kWhole) {
      low += Rational(grid.edge[i] * ((cell >> (2 * i)) & 3)) / 4;
      high = low + Rational(grid.edge[i]) / 4;
    }
    const Rational d = s.p1[i] - s.p0[i];
    if (d == 0) {
      if (low > 0 || high < 0) return {1, 0};
      continue;
    }
    const Rational a = low / d;
    const Rational b = high / d;
    part.first = std::max(part.first, std::min(a, b));
    part.last = std::min(part.last, std::max(a, b));
  }
  return part;
}

/// A segment with end points on faces, edges and corners of cells, along axes and diagonals.
Segment special_segment(const VoxelGrid& grid, const glm::ivec3& box, Random& random) {
  Segment s;
  for (int i = 0; i < 3; ++i) {
    const auto place = [&] {
      const int on_face = random.between(0, grid.count[i]) * grid.edge[i];
      return std::min(box[i], random.chance(0.6) ? on_face : random.between(0, box[i]));
    };
    s.p0[i] = place();
    s.p1[i] = random.chance(0.2) ? s.p0[i] : place();
  }
  if (random.chance(0.3)) {  // a diagonal of the cells
    int cells = 1 << 20;
    glm::ivec3 way;
    for (int i = 0; i < 3; ++i) {
      way[i] = random.between(-1, 1) * grid.edge[i];
      if (way[i] > 0) cells = std::min(cells, (box[i] - s.p0[i]) / way[i]);
      if (way[i] < 0) cells = std::min(cells, s.p0[i] / -way[i]);
    }
    if (way != glm::ivec3{0}) s.p1 = s.p0 + way * random.between(0, cells);
  }
  return s;
}

Segment random_segment(const VoxelGrid& grid, const glm::ivec3& box, Random& random) {
  if (random.chance(0.5)) return special_segment(grid, box, random);
  Segment s;
  for (int i = 0; i < 3; ++i) {
    s.p0[i] = random.between(0, box[i]);
    s.p1[i] = random.between(0, box[i]);
  }
  if (random.chance(0.3)) {  // short: inside one cell or nearly
    for (int i = 0; i < 3; ++i) {
      s.p1[i] = std::clamp(s.p0[i] + random.between(-grid.edge[i], grid.edge[i]), 0, box[i]);
    }
  }
  return s;
}

struct Frame {
  Lattice lattice;
  VoxelGrid grid;
};

Frame random_frame(Random& random) {
  Frame f;
  f.lattice.bits = random.between(5, 24);
  const int top = (1 << f.lattice.bits) - 3;
  for (int i = 0; i < 3; ++i) {
    f.lattice.max_q[i] = random.chance(0.1) ? 2 : random.between(top / 2, top);
  }
  glm::ivec3 count;
  for (int i = 0; i < 3; ++i) {
    count[i] = std::clamp(random.between(1, 7), 1, std::max(1, f.lattice.box()[i] / 4));
  }
  f.grid = make_grid(f.lattice, 1, count).value();
  return f;
}

template <class Visit>
void each_voxel(const VoxelGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.count.z; ++z) {
    for (int y = 0; y < grid.count.y; ++y) {
      for (int x = 0; x < grid.count.x; ++x) visit(glm::ivec3{x, y, z});
    }
  }
}

const auto kNoSkip = [](const glm::ivec3&, int) { return 0; };

TEST(Case24, VisitedVoxelsAreExactlyThoseMet) {
  Random random(24);
  std::size_t rays = 0;
  std::size_t voxels = 0;
  while (rays < 1000000) {
    const Frame f = random_frame(random);
    std::vector<std::size_t> seen(f.grid.cells(), 0);
    for (int i = 0; i < 2000; ++i) {
      const Segment s = random_segment(f.grid, f.lattice.box(), random);
      if (s.is_miss()) continue;
      ++rays;
      std::size_t visits = 0;
      truth::Wide last_num = 0;
      truth::Wide last_den = 1;
      bool ordered = true;
      traverse(f.grid, s.p0, s.p1, kNoSkip, [&](const VoxelVisit& v) {
        seen[f.grid.index(v.voxel)] = rays;
        ++visits;
        ordered = ordered && last_num * v.enter.den <= v.enter.num * last_den;
        last_num = v.enter.num;
        last_den = v.enter.den;
        return true;
      });
      ASSERT_TRUE(ordered);
      std::size_t expected = 0;
      each_voxel(f.grid, [&](const glm::ivec3& voxel) {
        const bool met = meets(f.grid, voxel, s);
        expected += met ? 1 : 0;
        ASSERT_EQ(met, seen[f.grid.index(voxel)] == rays)
            << "voxel " << voxel.x << " " << voxel.y << " " << voxel.z << " of " << f.grid.count.x
            << "x" << f.grid.count.y << "x" << f.grid.count.z << ", edge " << f.grid.edge.x << " "
            << f.grid.edge.y << " " << f.grid.edge.z << ", from " << s.p0.x << " " << s.p0.y << " "
            << s.p0.z << " to " << s.p1.x << " " << s.p1.y << " " << s.p1.z;
      });
      ASSERT_EQ(visits, expected);  // each once
      voxels += visits;
      if (HasFatalFailure()) return;
    }
  }
  std::printf("case 24: %zu rays, %zu voxels visited, exactly those met\n", rays, voxels);
}

TEST(Case24, ParametersAndCellsAreThoseOfRationalClipping) {
  Random random(25);
  std::size_t rays = 0;
  for (int round = 0; round < 60; ++round) {
    const Frame f = random_frame(random);
    for (int i = 0; i < 200; ++i) {
      const Segment s = random_segment(f.grid, f.lattice.box(), random);
      if (s.is_miss()) continue;
      ++rays;
      std::size_t visits = 0;
      traverse(f.grid, s.p0, s.p1, kNoSkip, [&](const VoxelVisit& v) {
        ++visits;
        const Part part = clip(f.grid, v.voxel, s);
        EXPECT_LE(part.first, part.last);
        EXPECT_EQ(Rational(v.enter.num) / v.enter.den, part.first);
        EXPECT_EQ(Rational(v.leave.num) / v.leave.den, part.last);
        EXPECT_EQ(v.enter.quotient(),
                  truth::floor_of(truth::power_of_two(24) * part.first).get_ui());
        const CellSet cells = ray_cells(f.grid, s.p0, s.p1, v);
        for (int cell = 0; cell < 64; ++cell) {
          const Part in = clip(f.grid, v.voxel, s, cell);
          EXPECT_EQ(((cells >> cell) & 1U) != 0, in.first <= in.last);
        }
        return true;
      });
      std::size_t expected = 0;
      each_voxel(f.grid, [&](const glm::ivec3& voxel) {
        const Part part = clip(f.grid, voxel, s);
        const bool met = part.first <= part.last;
        expected += met ? 1 : 0;
        ASSERT_EQ(met, meets(f.grid, voxel, s));  // the two truths agree
      });
      ASSERT_EQ(visits, expected);
      if (HasFailure()) return;
    }
  }
  std::printf("case 24: %zu rays, parameters and cells equal rational clipping\n", rays);
}

}  // namespace
}  // namespace gridrt::adversarial
