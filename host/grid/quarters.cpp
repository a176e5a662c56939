#include "host/grid/quarters.hpp"

#include <array>

namespace gridrt {
namespace {

/// One axis of a ray's way through a voxel, quarter by quarter.
struct AxisWay {
  std::int64_t p0 = 0;    ///< quarter steps, from the voxel's low face
  std::int64_t d = 0;     ///< quarter steps
  std::int64_t edge = 0;  ///< of the voxel, lattice steps: of a quarter, quarter steps
  int quarter = 0;        ///< where it is
  unsigned mask = 0;      ///< of the quarters that it touches now

  [[nodiscard]] bool has_next() const { return d > 0 ? quarter < 3 : d < 0 && quarter > 0; }
  /// Where along the segment it comes to the next quarter.
  [[nodiscard]] Fraction next() const {
    const std::int64_t way = (d > 0 ? quarter + 1 : quarter) * edge - p0;
    return d > 0 ? Fraction{way, d} : Fraction{-way, -d};
  }
  void advance() { quarter += d > 0 ? 1 : -1; }
  [[nodiscard]] unsigned bit() const { return 1U << static_cast<unsigned>(quarter); }

  void start(const Fraction& enter) {
    if (d == 0) {  // on the plane between two quarters for good, or within one
      for (int q = 0; q < 4; ++q) {
        if (q * edge <= p0 && p0 <= (q + 1) * edge) mask |= 1U << static_cast<unsigned>(q);
      }
      return;
    }
    quarter = d > 0 ? 0 : 3;
    while (has_next() && next() < enter) advance();
    mask = bit();
  }
};

CellSet cells_at(const std::array<AxisWay, 3>& ways) {
  return cells_of(
      static_cast<QuarterMasks>(ways[0].mask | ways[1].mask << 4U | ways[2].mask << 8U));
}

}  // namespace

QuarterMasks triangle_quarters(const TriangleBoxTest& triangle, const VoxelGrid& grid,
                               const glm::ivec3& voxel) {
  const glm::ivec3 lo = voxel * grid.edge;
  const glm::ivec3 hi = lo + grid.edge;
  const EighthBox whole = eighth_box(lo, hi, grid.margin);
  bool inside = true;
  for (int a = 0; a < 3; ++a) {
    inside = inside && triangle.low(a) >= whole.centre[a] - whole.half[a] &&
             triangle.high(a) <= whole.centre[a] + whole.half[a];
  }
  unsigned masks = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto slab = [&](int quarter) {
      return eighth_slab_box(lo, hi, grid.margin, axis, quarter);
    };
    const auto bounds_meet = [&](int quarter) {
      const EighthBox box = slab(quarter);
      return triangle.low(axis) <= box.centre[axis] + box.half[axis] &&
             triangle.high(axis) >= box.centre[axis] - box.half[axis];
    };
    // What is not cut off by the voxel's faces touches what its bounds touch. All others touch an
    // interval too, whose ends are looked for.
    const auto touches = [&](int quarter) { return inside || triangle.meets(slab(quarter)); };
    int first = 0;
    int last = 3;
    while (first < last && !(bounds_meet(first) && touches(first))) ++first;
    while (last > first && !(bounds_meet(last) && touches(last))) --last;
    for (int quarter = first; quarter <= last; ++quarter) {
      masks |= 1U << static_cast<unsigned>(4 * axis + quarter);
    }
  }
  return static_cast<QuarterMasks>(masks);
}

CellSet ray_cells(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1,
                  const VoxelVisit& visit) {
  std::array<AxisWay, 3> ways;
  for (int a = 0; a < 3; ++a) {
    AxisWay& way = ways[static_cast<std::size_t>(a)];
    way.edge = grid.edge[a];
    way.p0 = 4 * (std::int64_t{p0[a]} - std::int64_t{visit.voxel[a]} * grid.edge[a]);
    way.d = 4 * (std::int64_t{p1[a]} - p0[a]);
    way.start(visit.enter);
  }
  CellSet cells = cells_at(ways);
  for (;;) {
    const AxisWay* first = nullptr;
    Fraction when;
    for (const AxisWay& way : ways) {
      if (!way.has_next()) continue;
      const Fraction next = way.next();
      if (first != nullptr && !(next < when)) continue;
      first = &way;
      when = next;
    }
    if (first == nullptr || visit.leave < when) return cells;
    // In an edge or a corner of cells it touches all that meet there.
    std::array<bool, 3> passes{};
    for (std::size_t a = 0; a < 3; ++a) {
      passes[a] = ways[a].has_next() && !(when < ways[a].next());
      if (!passes[a]) continue;
      ways[a].advance();
      ways[a].mask |= ways[a].bit();
    }
    cells |= cells_at(ways);
    for (std::size_t a = 0; a < 3; ++a) {
      if (passes[a]) ways[a].mask = ways[a].bit();
    }
  }
}

}  // namespace gridrt
