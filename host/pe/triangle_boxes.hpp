// The triangles of each voxel as boxes of bytes: a glance at few cache lines tells which triangles
// a ray, or a frustum, may meet there, and only their records are read.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "host/pe/engine.hpp"
#include "host/pe/large_pages.hpp"

namespace gridrt {

/// A triangle in single precision (lattice steps, exact but for the normal E1 x E2, which is
/// rounded once), alone in a cache line.
struct alignas(64) TriangleRecord {
  float numbers[12];  ///< V0, E1, E2, N: x y z each
  float reach;        ///< largest absolute component of E1 and E2
  std::uint32_t id;   ///< local
  std::uint32_t unused[2];
};

/// The boxes of a voxel's triangles; each is the part of the triangle's box within the voxel grown
/// by the grid's margin, its bounds rounded away to 255ths of that. In groups of at most as many as
/// a vector has lanes; of a group, which takes n triangles up to a multiple of four, six rows of n
/// bytes (low x, y, z, high x, y, z), then n record numbers of four bytes. Before a voxel's first
/// group stand the number of its triangles and its place among the cells, four bytes each.
class TriangleBoxes {
 public:
  /// For the voxels in `cells` (of the engine's traversal), in their order, and vectors of `lanes`.
  static TriangleBoxes build(const Engine& engine, const std::vector<const Cell*>& cells,
                             const std::vector<glm::ivec3>& voxels, std::size_t lanes, int threads);

  [[nodiscard]] const TriangleRecord& record(std::uint32_t number) const {
    return records_[number];
  }
  [[nodiscard]] const TriangleRecord* records() const { return records_.data(); }

  /// Where a voxel begins, in words of four bytes, by its place among the cells.
  [[nodiscard]] std::uint32_t start(std::size_t cell) const { return starts_[cell]; }

  /// What begins there.
  [[nodiscard]] const std::uint32_t* voxel(std::uint32_t start) const {
    return words_.data() + start;
  }
  static constexpr std::size_t kHead = 2;  ///< words before a voxel's first group

  /// Lattice steps of a byte's unit, and of the margin that lies before zero.
  [[nodiscard]] const glm::vec3& unit() const { return unit_; }
  [[nodiscard]] int margin() const { return margin_; }

  /// Bytes a row of a group of `count` takes.
  static std::size_t row_bytes(std::size_t count) { return (count + 3) / 4 * 4; }

 private:
  void put_cell(const Engine& engine, const Cell& cell, const glm::ivec3& voxel,
                std::uint8_t* group, std::size_t lanes) const;

  LargeVector<TriangleRecord> records_;
  std::vector<std::uint32_t> bases_;  ///< of each PE: the record of its first triangle
  std::vector<std::uint32_t> starts_;
  LargeVector<std::uint32_t> words_;
  glm::vec3 unit_{1.0F};
  glm::ivec3 edge_{1};
  int margin_ = 1;
};

}  // namespace gridrt
