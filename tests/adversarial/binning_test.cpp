// Binning loses nothing: every voxel, and every half of one, whose box grown by the margin meets a
// triangle refers to it. The truth clips the triangle to the box in rationals.
#include <algorithm>
#include <cstdio>
#include <map>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "host/grid/voxel_grid.hpp"
#include "host/image/quarter_code.hpp"
#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/meshes.hpp"

namespace gridrt::adversarial {
namespace {

using truth::Rational;
using Corner = std::array<Rational, 3>;

/// The part of a polygon with sign (x_axis - bound) >= 0, closed (Sutherland and Hodgman).
std::vector<Corner> keep(const std::vector<Corner>& polygon, std::size_t axis,
                         const Rational& bound, int sign) {
  std::vector<Corner> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const Rational in_a = sign * (a[axis] - bound);
    const Rational in_b = sign * (b[axis] - bound);
    if (in_a >= 0) out.push_back(a);
    if ((in_a > 0 && in_b < 0) || (in_a < 0 && in_b > 0)) {
      const Rational t = in_a / (in_a - in_b);
      Corner c;
      for (std::size_t k = 0; k < 3; ++k) c[k] = a[k] + t * (b[k] - a[k]);
      out.push_back(c);
    }
  }
  return out;
}

struct RationalBox {
  Corner lo, hi;
};

bool meets(const LatticeTriangle& t, const RationalBox& box) {
  std::vector<Corner> polygon;
  polygon.reserve(3);
  for (const auto& v : t.v) polygon.push_back({v.x, v.y, v.z});
  for (std::size_t axis = 0; axis < 3 && !polygon.empty(); ++axis) {
    polygon = keep(polygon, axis, box.lo[axis], 1);
    if (!polygon.empty()) polygon = keep(polygon, axis, box.hi[axis], -1);
  }
  return !polygon.empty();
}

constexpr int kWhole = -1;

/// The voxel's box, or the part of it in one quarter of an axis (4 axis + quarter), grown by the
/// margin.
RationalBox box_of(const VoxelGrid& grid, const glm::ivec3& voxel, int slab) {
  RationalBox box;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    box.lo[k] = voxel[i] * grid.edge[i];
    box.hi[k] = box.lo[k] + grid.edge[i];
    if (slab != kWhole && slab / 4 == i) {
      box.lo[k] += Rational(grid.edge[i] * (slab % 4)) / 4;
      box.hi[k] = box.lo[k] + Rational(grid.edge[i]) / 4;
    }
    box.lo[k] -= grid.margin;
    box.hi[k] += grid.margin;
  }
  return box;
}

/// Whether boxes overlap at all, to spare the clipping.
bool near(const LatticeTriangle& t, const VoxelGrid& grid, const glm::ivec3& voxel) {
  for (int i = 0; i < 3; ++i) {
    const int lo = std::min({t.v[0][i], t.v[1][i], t.v[2][i]});
    const int hi = std::max({t.v[0][i], t.v[1][i], t.v[2][i]});
    if (hi < voxel[i] * grid.edge[i] - grid.margin) return false;
    if (lo > (voxel[i] + 1) * grid.edge[i] + grid.margin) return false;
  }
  return true;
}

void check_scene(const Scene& scene, int bits, const glm::ivec3& wanted, std::size_t& references,
                 std::size_t& extra) {
  const truth::SnappedScene snapped = truth::snap_scene(scene, bits);
  const auto lattice = make_lattice(scene.positions, scene.triangles, bits);
  ASSERT_TRUE(lattice);
  const VoxelGrid grid =
      make_grid(*lattice, scene.triangles.size(),
                glm::clamp(wanted, glm::ivec3{1}, glm::max(lattice->box() / 4, glm::ivec3{1})))
          .value();
  std::vector<LatticeTriangle> triangles;
  triangles.reserve(snapped.triangles.size());
  for (const auto& t : snapped.triangles) triangles.push_back(to_engine(t));
  const VoxelLists lists = bin_triangles(grid, triangles);
  ASSERT_EQ(lists.first.size(), grid.cells() + 1);
  ASSERT_EQ(lists.first.back(), lists.references.size());

  for (int z = 0; z < grid.count.z; ++z) {
    for (int y = 0; y < grid.count.y; ++y) {
      for (int x = 0; x < grid.count.x; ++x) {
        const glm::ivec3 voxel{x, y, z};
        const std::size_t cell = grid.index(voxel);
        std::map<std::uint32_t, QuarterMasks> found;
        for (auto i = lists.first[cell]; i < lists.first[cell + 1]; ++i) {
          const VoxelReference& r = lists.references[i];
          ASSERT_TRUE(i == lists.first[cell] || lists.references[i - 1].triangle < r.triangle);
          found[r.triangle] = quarters_of_code(quarter_code(r.quarters));
          ++references;
        }
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
          const bool met =
              near(triangles[t], grid, voxel) && meets(triangles[t], box_of(grid, voxel, kWhole));
          const auto it = found.find(t);
          if (it != found.end() && !met) ++extra;
          if (!met || truth::normal_of(snapped.triangles[t]) == std::array<truth::Wide, 3>{}) {
            continue;
          }
          ASSERT_NE(it, found.end()) << "triangle " << t << " lost in a voxel";
          for (int slab = 0; slab < 12; ++slab) {
            ASSERT_EQ((it->second >> slab) & 1,
                      meets(triangles[t], box_of(grid, voxel, slab)) ? 1 : 0)
                << "quarter " << slab % 4 << " of axis " << slab / 4;
          }
        }
      }
    }
  }
}

TEST(Binning, LosesNoVoxelAndNoQuarter) {
  Random random(50);
  std::size_t references = 0;
  std::size_t extra = 0;
  for (int round = 0; round < 150 && !HasFatalFailure(); ++round) {
    const int bits = random.between(5, 24);
    const int x = random.between(1, 7);
    const int y = random.between(1, 7);
    check_scene(any_scene(random, 30).scene, bits, {x, y, random.between(1, 7)}, references, extra);
  }
  EXPECT_GT(references, 10000U);
  std::printf("binning: %zu references, %zu beyond need, none lost\n", references, extra);
}

TEST(Binning, TrianglesInFacesAreFoundFromBothSides) {
  Random random(51);
  std::size_t references = 0;
  std::size_t extra = 0;
  for (int round = 0; round < 20 && !HasFatalFailure(); ++round) {
    // Extent 16 at 7 bits: s = 2, 64 steps, box 68; four voxels of 17 or two of 34, and so on.
    check_scene(lattice_soup(20, 16, random), 7, glm::ivec3{random.between(1, 5)}, references,
                extra);
  }
  std::printf("binning on faces: %zu references, %zu beyond need\n", references, extra);
}

TEST(Binning, ListsDoNotDependOnTheNumberOfThreads) {
  Random random(52);
  for (const Scene& scene :
       {soup(9000, 6.0, random), sheet(50, 0.3, random), soup(3, 1.0, random)}) {
    const Lattice lattice = make_lattice(scene.positions, scene.triangles, kDefaultBits).value();
    std::vector<LatticeTriangle> triangles;
    for (const auto& t : scene.triangles) {
      LatticeTriangle& q = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) q.v[k] = snap(lattice, scene.positions[t[k]]);
    }
    const VoxelGrid grid = make_grid(lattice, triangles.size(), {}).value();
    const VoxelLists one = bin_triangles(grid, triangles, 1);
    for (const int threads : {0, 2, 3, 8}) {
      const VoxelLists many = bin_triangles(grid, triangles, threads);
      EXPECT_EQ(many.first, one.first);
      EXPECT_TRUE(std::ranges::equal(many.references, one.references,
                                     [](const VoxelReference& a, const VoxelReference& b) {
                                       return a.triangle == b.triangle && a.quarters == b.quarters;
                                     }));
    }
    for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
      EXPECT_TRUE(
          std::is_sorted(one.references.begin() + static_cast<std::ptrdiff_t>(one.first[cell]),
                         one.references.begin() + static_cast<std::ptrdiff_t>(one.first[cell + 1]),
                         [](const auto& a, const auto& b) { return a.triangle < b.triangle; }));
    }
  }
}

}  // namespace
}  // namespace gridrt::adversarial
