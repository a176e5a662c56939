// What ray setup and a traversal unit compute, bit for bit, in plain integers: the reference that
// the RTL is compared with (setup_bench, traverse_bench) and that march_test compares with exact
// truth.
//
// Positions on a lateral axis are in units of 2^-kFraction lattice steps; a quarter of a voxel is
// E = edge 2^(kFraction - 2) of them. Coordinates are mirrored so that every ray travels upwards.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <glm/vec3.hpp>

#include "host/grid/voxel_grid.hpp"

namespace gridrt::march {

inline constexpr int kFraction = 13;
inline constexpr int kPartialBits = 4;  ///< of these in the first partial quarter-slab

/// What the hardware keeps of a grid.
struct Grid {
  glm::ivec3 edge{1};
  glm::ivec3 half_blocks{1};  ///< blocks of 2x2x2 voxels per axis
  glm::ivec3 span{2};         ///< lattice steps that these blocks cover
  glm::ivec3 stride{1};       ///< block address = x + stride.y y + stride.z z
};

inline Grid make_march_grid(const VoxelGrid& g) {
  Grid r;
  r.edge = g.edge;
  r.half_blocks = (g.count + 1) / 2;
  r.span = r.half_blocks * 2 * g.edge;
  r.stride = {1, r.half_blocks.x, r.half_blocks.x * r.half_blocks.y};
  return r;
}

struct Lateral {
  int h = 0;           ///< quarter at the block's entry, from the block's first one: -8 .. 7
  int low = 0;         ///< no sample lies below this quarter (P0's one in the first block), 0 .. 7
  std::int64_t r = 0;  ///< rest of the position, 0 .. E - 1
  std::int64_t m = 0;  ///< increment per quarter-slab, 0 .. E
  int lim = 0;         ///< quarter of P1, from the block's first one

  bool operator==(const Lateral&) const = default;
};

struct State {
  int axis = 0;
  std::array<bool, 3> neg{};
  int block = 0;  ///< address of the block in which the ray enters this block-slab
  int slabs = 0;  ///< block-slabs after this one
  int first = 0;  ///< first quarter-slab of this block that holds a part of the segment
  int last = 0;   ///< last one of the last block
  int enter = 0;  ///< entry face of this block-slab - P0
  std::array<Lateral, 2> lateral{};
  int sub = 0;  ///< block looked at: 0 the entry block, 1 its b-neighbour, 2 its c-neighbour, 3

  bool operator==(const State&) const = default;
};

/// Setup: p0 != p1, both within the grid.
inline State setup(const Grid& g, const glm::ivec3& p0, const glm::ivec3& p1) {
  State s;
  glm::ivec3 length{0};
  glm::ivec3 start{0};
  glm::ivec3 end{0};
  for (int i = 0; i < 3; ++i) {
    const bool neg = p1[i] < p0[i];
    s.neg[static_cast<std::size_t>(i)] = neg;
    length[i] = std::abs(p1[i] - p0[i]);
    start[i] = neg ? g.span[i] - p0[i] : p0[i];
    end[i] = neg ? g.span[i] - p1[i] : p1[i];
  }
  int a = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::int64_t{length[i]} * g.edge[a] > std::int64_t{length[a]} * g.edge[i]) a = i;
  }
  s.axis = a;
  // Quarter of P0 on each axis (the last one if P0 lies on the far face) and rest, quarter steps.
  glm::ivec3 quarter{0};
  std::array<std::int64_t, 3> rest{};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    quarter[i] = 4 * start[i] / g.edge[i];
    rest[k] = std::int64_t{4 * start[i] % g.edge[i]} << (kFraction - 2);
    if (quarter[i] == 8 * g.half_blocks[i]) {
      quarter[i] -= 1;
      rest[k] = (std::int64_t{g.edge[i]} << (kFraction - 2)) - 1;
    }
    const int block = quarter[i] / 8;
    s.block += g.stride[i] * (s.neg[k] ? g.half_blocks[i] - 1 - block : block);
  }
  const int end_quarter = (4 * end[a] - 1) / g.edge[a];
  s.slabs = end_quarter / 8 - quarter[a] / 8;
  s.first = quarter[a] % 8;
  s.last = end_quarter % 8;
  s.enter = quarter[a] / 8 * 2 * g.edge[a] - start[a];
  for (int n = 0; n < 2; ++n) {
    const int i = (a + 1 + n) % 3;
    Lateral& l = s.lateral[static_cast<std::size_t>(n)];
    const std::int64_t unit = std::int64_t{g.edge[i]} << (kFraction - 2);
    const std::int64_t slope = std::int64_t{length[i]};
    l.m = ((slope * g.edge[a]) << (kFraction - 2)) / length[a];
    // To the next quarter-face of the dominant axis, with fewer bits behind the point.
    const std::int64_t ahead =
        std::int64_t{(quarter[a] + 1)} * g.edge[a] - 4 * std::int64_t{start[a]};
    const std::int64_t partial = (((slope * ahead) << (kPartialBits - 2)) / length[a])
                                 << (kFraction - kPartialBits);
    const std::int64_t here = (quarter[i] % 8) * unit + rest[static_cast<std::size_t>(i)];
    // Back from there to the block's entry face.
    const std::int64_t at = here + partial - (s.first + 1) * l.m + 8 * unit;
    l.h = static_cast<int>(at / unit) - 8;
    l.r = at % unit;
    l.low = quarter[i] % 8;
    const int end_lateral = std::min(4 * end[i] / g.edge[i], 8 * g.half_blocks[i] - 1);
    l.lim = end_lateral - quarter[i] / 8 * 8;
  }
  return s;
}

/// A record of the block memory.
struct Block {
  bool occupied = false;
  int base = 0;
  unsigned occ = 0;
  std::array<int, 6> jump{};

  [[nodiscard]] std::uint32_t bits() const {
    if (occupied) return (1U << 21) | (static_cast<unsigned>(base) << 8) | occ;
    std::uint32_t r = 0;
    for (std::size_t i = 0; i < 6; ++i) r |= static_cast<unsigned>(jump[i]) << (3 * i);
    return r;
  }
};

/// What a step finds: all voxels of the block that the ray meets, and those that are occupied.
struct Step {
  int block = 0;                         ///< address of the block looked at
  unsigned met = 0;                      ///< bits x + 2 y + 4 z, not mirrored
  unsigned cand = 0;                     ///< met and occupied
  unsigned front = 0;                    ///< those in the slab entered first
  std::array<std::uint64_t, 8> cells{};  ///< bits x + 4 y + 16 z, not mirrored, of those met
  int base = 0;
  unsigned occ = 0;
  int near_enter = 0;
  int far_enter = 0;
  int jump = 0;       ///< blocks skipped (0: none)
  bool done = false;  ///< the ray needs no further step
};

inline constexpr int kFaces = 9;  ///< of the quarter-slabs of a block

/// Quarters met in interval i (bits) by the two samples around it.
inline unsigned quarters_of(const std::array<int, kFaces>& sample, int i, int block) {
  unsigned bits = 0;
  for (int k = i; k <= i + 1; ++k) {
    const int q = sample[static_cast<std::size_t>(k)];
    if (q / 8 == block) bits |= 1U << (q % 8);
  }
  return bits;
}

/// The lateral quarters at the faces of the block's eight quarter-slabs, clipped to the segment.
inline std::array<int, kFaces> samples(const Lateral& l, std::int64_t unit) {
  std::array<int, kFaces> r{};
  for (int k = 0; k < kFaces; ++k) {
    const std::int64_t at = (l.h + 8) * unit + l.r + k * l.m;
    r[static_cast<std::size_t>(k)] =
        std::min(std::max(static_cast<int>(at / unit) - 8, l.low), l.lim);
  }
  return r;
}

/// One step: looks at one block and goes on to the next. `memory(address)` gives its record.
template <class Memory>
Step step(const Grid& g, State& s, std::int64_t limit, Memory&& memory) {
  Step out;
  const int a = s.axis;
  const std::array<int, 2> axes{(a + 1) % 3, (a + 2) % 3};
  const auto signed_stride = [&](int i) {
    return s.neg[static_cast<std::size_t>(i)] ? -g.stride[i] : g.stride[i];
  };
  const int cb = s.sub & 1;
  const int cc = s.sub >> 1;
  out.block = s.block + cb * signed_stride(axes[0]) + cc * signed_stride(axes[1]);
  const Block record = memory(out.block);
  std::array<std::int64_t, 2> unit{};
  std::array<std::array<int, kFaces>, 2> h{};
  for (std::size_t n = 0; n < 2; ++n) {
    unit[n] = std::int64_t{g.edge[axes[n]]} << (kFraction - 2);
    h[n] = samples(s.lateral[n], unit[n]);
  }
  const int last = s.slabs == 0 ? s.last : 7;
  // The part of the segment in this block, mirrored, and which neighbours it touches.
  unsigned touched = 0;
  for (int i = s.first; i <= last; ++i) {
    for (int sub = 0; sub < 4; ++sub) {
      if (quarters_of(h[0], i, sub & 1) != 0 && quarters_of(h[1], i, sub >> 1) != 0)
        touched |= 1U << sub;
    }
    const unsigned b = quarters_of(h[0], i, cb);
    const unsigned c = quarters_of(h[1], i, cc);
    for (int qb = 0; qb < 8; ++qb) {
      for (int qc = 0; qc < 8; ++qc) {
        if (((b >> qb) & 1U) == 0 || ((c >> qc) & 1U) == 0) continue;
        glm::ivec3 quarter{0};
        quarter[a] = i;
        quarter[axes[0]] = qb;
        quarter[axes[1]] = qc;
        unsigned cell = 0;
        unsigned bit = 0;
        for (int k = 0; k < 3; ++k) {
          const int actual = s.neg[static_cast<std::size_t>(k)] ? 7 - quarter[k] : quarter[k];
          cell |= static_cast<unsigned>(actual & 3) << (2 * k);
          bit |= static_cast<unsigned>(actual >> 2) << k;
        }
        out.met |= 1U << bit;
        out.cells[bit] |= std::uint64_t{1} << cell;
        if (i < 4) out.front |= 1U << bit;
      }
    }
  }
  const int edge = g.edge[a];
  out.near_enter = std::max(s.enter, 0);
  out.far_enter = std::max(s.enter + edge, 0);
  if (record.occupied) {
    out.cand = out.met & record.occ;
    out.base = record.base;
    out.occ = record.occ;
  }
  const bool killed = s.enter > limit;
  if (killed) out.cand = 0;
  int ahead = 1;
  if (!record.occupied && s.sub == 0) {
    const int direction = 2 * a + (s.neg[static_cast<std::size_t>(a)] ? 1 : 0);
    out.jump = record.jump[static_cast<std::size_t>(direction)];
  }
  if (out.jump > 0) {
    ahead = out.jump;
  } else {
    for (int sub = s.sub + 1; sub < 4; ++sub) {
      if (((touched >> sub) & 1U) == 0) continue;
      s.sub = sub;
      out.done = killed;
      return out;
    }
  }
  // On by `ahead` block-slabs.
  out.done = killed || ahead > s.slabs || s.enter + 2 * ahead * edge > limit;
  if (out.done) return out;
  s.slabs -= ahead;
  s.enter += 2 * ahead * edge;
  s.first = 0;
  s.sub = 0;
  s.block += ahead * signed_stride(a);
  for (std::size_t n = 0; n < 2; ++n) {
    Lateral& l = s.lateral[n];
    const std::int64_t at = (l.h + 8) * unit[n] + l.r + 8 * ahead * l.m;
    const int h_at = static_cast<int>(at / unit[n]) - 8;
    l.r = at % unit[n];
    l.h = h_at % 8;
    l.low = 0;
    l.lim -= h_at / 8 * 8;
    s.block += h_at / 8 * signed_stride(axes[n]);
  }
  return out;
}

}  // namespace gridrt::march
