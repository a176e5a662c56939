#include "host/pe/ray_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "host/pe/empty_space.hpp"

namespace gridrt {
namespace {

constexpr std::int64_t kMostVoxels = std::int64_t{1} << 30;

/// The border included.
glm::ivec3 padded(const glm::ivec3& count) { return count + 2; }

float to_float(std::int64_t x) { return static_cast<float>(x); }

/// Writes a triangle into lane `lane` of a block (12 rows of `lanes`).
void put_triangle(const EdgeTriangle& t, float* block, std::size_t lanes, std::size_t lane) {
  const glm::i64vec3 a{t.e1};
  const glm::i64vec3 b{t.e2};
  const glm::i64vec3 n{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  for (int i = 0; i < 3; ++i) {
    float* const row = block + static_cast<std::size_t>(i) * lanes + lane;
    row[0] = to_float(t.v0[i]);
    row[3 * lanes] = to_float(t.e1[i]);
    row[6 * lanes] = to_float(t.e2[i]);
    row[9 * lanes] = to_float(n[i]);
  }
}

int reach(const EdgeTriangle& t) {
  const glm::ivec3 m = glm::max(glm::abs(t.e1), glm::abs(t.e2));
  return std::max({m.x, m.y, m.z});
}

}  // namespace

bool RayLayout::fits(const Engine& engine) {
  const VoxelGrid& grid = engine.traversal().grid();
  const glm::i64vec3 size{padded(grid.count)};
  const glm::i64vec3 box = glm::i64vec3{grid.count} * glm::i64vec3{grid.edge};
  // docs/numerics.md, section 7: the march strays by less than 2^-20 of the box's largest
  // coordinate. It must not leave the margin of a triangle, nor the border of the grid.
  const bool exact_enough = std::max({box.x, box.y, box.z}) < (std::int64_t{grid.margin} << 20) &&
                            std::min({grid.edge.x, grid.edge.y, grid.edge.z}) >= grid.margin;
  return exact_enough && size.x * size.y * size.z < kMostVoxels;
}

RayLayout RayLayout::build(const Engine& engine, int bits, std::size_t lanes, int threads) {
  const TraversalMemory& memory = engine.traversal();
  const VoxelGrid& grid = memory.grid();
  RayLayout layout;
  layout.lanes_ = lanes;
  layout.edge_ = grid.edge;
  layout.count_ = grid.count;
  const glm::ivec3 size = padded(grid.count);
  layout.stride_ = {1, size.x, size.x * size.y};
  for (int a = 0; a < 3; ++a) layout.box_ = std::max(layout.box_, grid.count[a] * grid.edge[a]);
  layout.narrow_ = bits <= kMaxCompactBits;
  layout.codes_.assign(
      static_cast<std::size_t>(layout.stride_.z) * static_cast<std::size_t>(size.z), -1);

  // Voxels in their order, so that neighbours along x lie side by side.
  std::vector<const Cell*> sources;
  std::vector<glm::ivec3> voxels;
  std::uint32_t blocks = 0;
  std::size_t at = 0;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x, ++at) {
        const glm::ivec3 voxel{x - 1, y - 1, z - 1};
        const glm::ivec3 inside = glm::clamp(voxel, glm::ivec3{0}, grid.count - 1);
        if (voxel != inside) continue;
        const Cell* cell = memory.find(voxel);
        if (cell == nullptr || engine.pe(cell->pe) == nullptr) continue;
        layout.codes_[at] = static_cast<std::int32_t>(sources.size());
        const auto wanted = static_cast<std::uint32_t>((cell->count + lanes - 1) / lanes);
        layout.cells_.push_back({blocks, wanted, cell->count, 0.0F});
        blocks += wanted;
        sources.push_back(cell);
        voxels.push_back(voxel);
      }
    }
  }
  at = 0;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x, ++at) {
        const glm::ivec3 voxel{x, y, z};
        const glm::ivec3 inside = glm::clamp(voxel, glm::ivec3{1}, grid.count);
        if (voxel == inside) continue;
        const glm::ivec3 beside = inside * layout.stride_;
        const int number = beside.x + beside.y + beside.z;
        layout.codes_[at] = layout.codes_[static_cast<std::size_t>(number)];
      }
    }
  }
  measure_empty_space(size, layout.codes_);
  layout.boxes_ = TriangleBoxes::build(engine, sources, voxels, lanes, threads);
  for (std::int32_t& code : layout.codes_) {
    if (code >= 0) {
      code = static_cast<std::int32_t>(layout.boxes_.start(static_cast<std::size_t>(code)));
    }
  }

  const std::size_t floats = std::size_t{blocks} * kBlockRows * lanes;
  layout.lines_.resize((floats + kMostLanes - 1) / kMostLanes + 1);
  layout.ids_.assign(std::size_t{blocks} * lanes, kNoTriangle);
  float* const first = layout.lines_.data()->x;
  const auto cells = static_cast<std::ptrdiff_t>(sources.size());
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(dynamic, 256)
  for (std::ptrdiff_t c = 0; c < cells; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const Pe& pe = *engine.pe(sources[i]->pe);
    LayoutCell& cell = layout.cells_[i];
    std::size_t slot = std::size_t{cell.first} * lanes;
    int most = 0;
    for (const VoxelReference& reference : pe.list(sources[i]->first, sources[i]->count)) {
      const Pe::Triangle& triangle = pe.triangle(reference);
      float* const block = first + slot / lanes * kBlockRows * lanes;
      put_triangle(triangle.edges, block, lanes, slot % lanes);
      layout.ids_[slot] = triangle.id;
      most = std::max(most, reach(triangle.edges));
      ++slot;
    }
    for (; slot < std::size_t{cell.first + cell.blocks} * lanes; ++slot) {
      float* const block = first + slot / lanes * kBlockRows * lanes;
      block[slot % lanes] = std::numeric_limits<float>::quiet_NaN();
    }
    cell.reach = static_cast<float>(most);
  }
  return layout;
}

}  // namespace gridrt
