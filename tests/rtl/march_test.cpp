// The march of setup and traversal (march_model.hpp) against exact truth: no hit can be lost,
// little is visited in vain, and the distances by which voxels are cancelled are exact.
#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "host/image/blocks.hpp"
#include "tests/rtl/march_blocks.hpp"
#include "tests/rtl/march_model.hpp"
#include "tests/rtl/march_segments.hpp"

namespace gridrt::march {
namespace {

constexpr std::int64_t kNoLimit = std::int64_t{1} << 40;

struct Visit {
  glm::ivec3 voxel{0};
  std::uint64_t cells = 0;  ///< bit x + 4 y + 16 z
  int enter = 0;
};

glm::ivec3 voxel_of(const Grid& g, int block, int bit) {
  const glm::ivec3 b{block % g.half_blocks.x, block / g.stride.y % g.half_blocks.y,
                     block / g.stride.z};
  return block_voxel(b, bit);
}

/// All voxels met, each once a step, as if every block were occupied.
std::vector<Visit> visits_of(const Grid& g, const Segment& segment) {
  Block full;
  full.occupied = true;
  full.occ = 0xFF;
  std::vector<Visit> visits;
  State s = setup(g, segment.p0, segment.p1);
  const int blocks = g.half_blocks.x * g.half_blocks.y * g.half_blocks.z;
  for (bool done = false; !done;) {
    const Step step = march::step(g, s, kNoLimit, [&](int address) {
      EXPECT_TRUE(address >= 0 && address < blocks) << address;
      return full;
    });
    for (int bit = 0; bit < 8; ++bit) {
      if (((step.cand >> bit) & 1U) == 0) continue;
      const bool front = ((step.front >> bit) & 1U) != 0;
      visits.push_back({voxel_of(g, step.block, bit), step.cells[static_cast<std::size_t>(bit)],
                        front ? step.near_enter : step.far_enter});
    }
    done = step.done;
  }
  return visits;
}

/// The segment, scaled by 2 |d_a|: twice the distance n along the dominant axis names a point.
class Exact {
 public:
  Exact(const Segment& s, int axis)
      : p0_(s.p0), d_(s.p1 - s.p0), axis_(axis), length_(std::abs(d_[axis])) {}
  [[nodiscard]] std::int64_t length() const { return length_; }
  [[nodiscard]] std::int64_t scale() const { return 2 * length_; }
  [[nodiscard]] std::int64_t at(int a, std::int64_t n) const {
    return p0_[a] * scale() + std::int64_t{d_[a]} * n;
  }

 private:
  glm::ivec3 p0_;
  glm::ivec3 d_;
  int axis_;
  std::int64_t length_;
};

/// A cell of the visit on an axis, in the scale of 4 exact.at().
struct Quarter {
  std::int64_t lo = 0;
  std::int64_t hi = 0;
};
Quarter quarter_of(const Grid& g, const Visit& v, const Exact& exact, int a, unsigned cell) {
  const int quarter = static_cast<int>((cell >> (2 * a)) & 3U);
  const std::int64_t lo = std::int64_t{4 * v.voxel[a] + quarter} * g.edge[a] * exact.scale();
  return {lo, lo + g.edge[a] * exact.scale()};
}

/// True if some cell of the visit, grown by one lattice step sideways, holds the point.
bool holds(const Grid& g, const Visit& v, const Exact& exact, int axis, std::int64_t n) {
  for (unsigned cell = 0; cell < 64; ++cell) {
    bool here = ((v.cells >> cell) & 1U) != 0;
    for (int a = 0; a < 3 && here; ++a) {
      const std::int64_t margin = a == axis ? 0 : 4 * exact.scale();
      const Quarter quarter = quarter_of(g, v, exact, a, cell);
      const std::int64_t x = 4 * exact.at(a, n);
      here = x >= quarter.lo - margin && x <= quarter.hi + margin;
    }
    if (here) return true;
  }
  return false;
}

/// True if on each axis every cell of the visit, grown by a 128th of a voxel or one step, is met by
/// the part of the segment that lies in the cell's quarter-slab.
bool tight(const Grid& g, const Visit& v, const Segment& s, const Exact& exact, int axis) {
  const bool up = s.p1[axis] > s.p0[axis];
  for (unsigned cell = 0; cell < 64; ++cell) {
    if (((v.cells >> cell) & 1U) == 0) continue;
    // In quarter steps times two, as exact.at() takes half of it.
    const int slab = 4 * v.voxel[axis] + static_cast<int>((cell >> (2 * axis)) & 3U);
    const std::int64_t low = std::int64_t{slab} * g.edge[axis];
    const std::int64_t high = low + g.edge[axis];
    const std::int64_t p = 4 * std::int64_t{s.p0[axis]};
    // Twice the distance, rounded outwards to the scale of exact.at().
    const std::int64_t from = std::max<std::int64_t>((up ? low - p : p - high) >> 1, 0);
    const std::int64_t to = std::min(((up ? high - p : p - low) + 1) >> 1, 2 * exact.length());
    if (from > to) return false;
    for (int a = 0; a < 3; ++a) {
      if (a == axis) continue;
      const std::int64_t x0 = exact.at(a, from);
      const std::int64_t x1 = exact.at(a, to);
      const std::int64_t grow =
          std::max(128 * exact.scale(), 2 * g.edge[a] * exact.scale());  // 1/128
      const Quarter quarter = quarter_of(g, v, exact, a, cell);
      if (128 * std::max(x0, x1) < 32 * quarter.lo - grow) return false;
      if (128 * std::min(x0, x1) > 32 * quarter.hi + grow) return false;
    }
  }
  return v.cells != 0;
}

void check(const Case& c, const Segment& s, Random& random) {
  const Grid g = make_march_grid(c.grid);
  const State start = setup(g, s.p0, s.p1);
  const int axis = start.axis;
  const Exact exact(s, axis);
  const std::vector<Visit> visits = visits_of(g, s);
  std::map<int, std::vector<Visit>> slabs;
  for (const Visit& v : visits) {
    slabs[v.voxel[axis]].push_back(v);
    EXPECT_TRUE(tight(g, v, s, exact, axis)) << "visited in vain";
    const int low = v.voxel[axis] * g.edge[axis];
    const int face = s.p1[axis] > s.p0[axis] ? low - s.p0[axis] : s.p0[axis] - low - g.edge[axis];
    EXPECT_EQ(v.enter, std::max(face, 0));
    EXPECT_LE(v.enter, exact.length());
  }
  // Points of the segment: both ends, at faces of quarter-slabs (to half a step), and anywhere.
  std::vector<std::int64_t> points{0, 2 * exact.length()};
  for (int i = 0; i < 24; ++i) {
    points.push_back(random.between(0, 2 * static_cast<int>(exact.length())));
    const std::int64_t face =
        random.between(0, 8 * g.half_blocks[axis]) * std::int64_t{g.edge[axis]} / 2;
    const std::int64_t n = std::abs(face - 2 * std::int64_t{s.p0[axis]});
    if (n <= 2 * exact.length()) points.push_back(n);
  }
  for (const std::int64_t n : points) {
    // Scaled like holds(): the slab is floor(x / edge), or the one before at a face.
    const std::int64_t x = exact.at(axis, n);
    const int slab = static_cast<int>(x / (g.edge[axis] * exact.scale()));
    bool found = false;
    for (int k = slab - 1; k <= slab && !found; ++k) {
      const auto at = slabs.find(k);
      if (at == slabs.end()) continue;
      found = std::ranges::any_of(at->second,
                                  [&](const Visit& v) { return holds(g, v, exact, axis, n); });
    }
    EXPECT_TRUE(found) << "point " << n << " of " << 2 * exact.length() << " lost";
  }
}

class March : public testing::TestWithParam<int> {};

TEST_P(March, EveryPointOfTheSegmentIsVisitedAndLittleElse) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  for (const Case& c : hard_grids(GetParam())) {
    for (int i = 0; i < 400; ++i) {
      const Segment s = hard_segment(random, c);
      check(c, s, random);
      ASSERT_FALSE(HasFailure()) << "grid " << c.grid.count.x << "x" << c.grid.count.y << "x"
                                 << c.grid.count.z << " edge " << c.grid.edge.x << " "
                                 << c.grid.edge.y << " " << c.grid.edge.z << " from " << s.p0.x
                                 << " " << s.p0.y << " " << s.p0.z << " to " << s.p1.x << " "
                                 << s.p1.y << " " << s.p1.z;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, March, testing::Values(12, 14, 17));

using Found = std::multimap<std::tuple<int, int>, std::tuple<std::uint64_t, int>>;

/// Voxels dispatched, with their cells and entries; `plain`: without jumps.
Found dispatched(const Grid& g, const Segment& s, const std::vector<Block>& blocks, bool plain,
                 int& steps) {
  Found found;
  State state = setup(g, s.p0, s.p1);
  for (bool done = false; !done; ++steps) {
    const Step step = march::step(g, state, kNoLimit, [&](int address) {
      Block b = blocks.at(static_cast<std::size_t>(address));
      if (plain) b.jump = {};
      return b;
    });
    for (int bit = 0; bit < 8; ++bit) {
      if (((step.cand >> bit) & 1U) == 0) continue;
      const bool front = ((step.front >> bit) & 1U) != 0;
      found.insert(
          {{step.block, bit},
           {step.cells[static_cast<std::size_t>(bit)], front ? step.near_enter : step.far_enter}});
    }
    done = step.done;
  }
  return found;
}

TEST_P(March, JumpsLeaveOutNothing) {
  Random random(static_cast<std::uint64_t>(GetParam()) + 100);
  int plain_steps = 0;
  int steps = 0;
  for (const Case& c : hard_grids(GetParam())) {
    const Grid g = make_march_grid(c.grid);
    for (const double density : {0.001, 0.01, 0.1, 0.5}) {
      const std::vector<Block> blocks = random_blocks(random, g, density);
      for (int i = 0; i < 100; ++i) {
        const Segment s = hard_segment(random, c);
        ASSERT_EQ(dispatched(g, s, blocks, true, plain_steps),
                  dispatched(g, s, blocks, false, steps));
      }
    }
  }
  EXPECT_LT(steps, plain_steps / 2);
}

}  // namespace
}  // namespace gridrt::march
