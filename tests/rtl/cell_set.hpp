/// The cells of a voxel that a task's `cells` stand for.
#pragma once

#include <cstdint>
#include <random>

#include "host/grid/quarters.hpp"

namespace gridrt::rtl {

/// All that the field of task_t (34 bits, dominant axis 0 to 2) says, cell by cell: bit x + 4 y +
/// 16 z.
inline CellSet cell_set(std::uint64_t cells) {
  const auto axis = static_cast<unsigned>(cells >> 32U);
  CellSet set = 0;
  for (unsigned cell = 0; cell < 64; ++cell) {
    const auto quarter = [&](unsigned a) { return (cell >> (2 * (a % 3))) & 3U; };
    const unsigned slab = 4 * quarter(axis);
    const bool on_b = (cells >> (16 + slab + quarter(axis + 1)) & 1U) != 0;
    const bool on_c = (cells >> (slab + quarter(axis + 2)) & 1U) != 0;
    if (on_b && on_c) set |= CellSet{1} << cell;
  }
  return set;
}

/// Any value of the field: from all cells to none, mostly few.
inline std::uint64_t random_cells(std::mt19937_64& random) {
  std::uint64_t cells = random() & 0xFFFFFFFFU;
  for (auto n = random() % 4; n > 0; --n) cells &= random();
  return (random() % 3) << 32U | cells;
}

}  // namespace gridrt::rtl
