#include "host/pe/triangle_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/common.hpp>

namespace gridrt {
namespace {

constexpr std::size_t kRows = 6;
constexpr std::size_t kOverread = 64;  // a row is read as a whole vector

TriangleRecord record_of(const Pe::Triangle& triangle) {
  const EdgeTriangle& t = triangle.edges;
  const glm::i64vec3 a{t.e1};
  const glm::i64vec3 b{t.e2};
  const glm::i64vec3 n{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  TriangleRecord record{};
  int reach = 0;
  for (int i = 0; i < 3; ++i) {
    record.numbers[i] = static_cast<float>(t.v0[i]);
    record.numbers[3 + i] = static_cast<float>(t.e1[i]);
    record.numbers[6 + i] = static_cast<float>(t.e2[i]);
    record.numbers[9 + i] = static_cast<float>(n[i]);
    reach = std::max({reach, std::abs(t.e1[i]), std::abs(t.e2[i])});
  }
  record.reach = static_cast<float>(reach);
  record.id = triangle.id;
  return record;
}

/// Words that a cell takes.
std::size_t words_of(std::size_t count, std::size_t lanes) {
  const std::size_t rows =
      count / lanes * TriangleBoxes::row_bytes(lanes) + TriangleBoxes::row_bytes(count % lanes);
  return TriangleBoxes::kHead + rows / 4 * (kRows + 4);
}

}  // namespace

TriangleBoxes TriangleBoxes::build(const Engine& engine, const std::vector<const Cell*>& cells,
                                   const std::vector<glm::ivec3>& voxels, std::size_t lanes,
                                   int threads) {
  const VoxelGrid& grid = engine.traversal().grid();
  TriangleBoxes boxes;
  boxes.edge_ = grid.edge;
  boxes.margin_ = grid.margin;
  boxes.unit_ = glm::vec3{grid.edge + 2 * grid.margin} / 255.0F;
  for (std::size_t number = 0; number < engine.pes(); ++number) {
    boxes.bases_.push_back(static_cast<std::uint32_t>(boxes.records_.size()));
    const Pe* const pe = engine.pe(number);
    if (pe == nullptr) continue;
    for (const Pe::Triangle& t : pe->triangles()) boxes.records_.push_back(record_of(t));
  }
  boxes.starts_.reserve(cells.size());
  std::uint64_t end = 0;
  for (const Cell* cell : cells) {
    boxes.starts_.push_back(static_cast<std::uint32_t>(end));
    end += words_of(cell->count, lanes);
  }
  boxes.words_.resize(end + kOverread / 4);
  const auto n = static_cast<std::ptrdiff_t>(cells.size());
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(dynamic, 256)
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto c = static_cast<std::size_t>(i);
    std::uint32_t* const head = boxes.words_.data() + boxes.starts_[c];
    head[0] = cells[c]->count;
    head[1] = static_cast<std::uint32_t>(c);
    boxes.put_cell(engine, *cells[c], voxels[c], reinterpret_cast<std::uint8_t*>(head + kHead),
                   lanes);
  }
  return boxes;
}

void TriangleBoxes::put_cell(const Engine& engine, const Cell& cell, const glm::ivec3& voxel,
                             std::uint8_t* group, std::size_t lanes) const {
  const auto references = engine.pe(cell.pe)->list(cell.first, cell.count);
  const glm::ivec3 base = voxel * edge_ - margin_;
  const glm::ivec3 size = edge_ + 2 * margin_;
  for (std::size_t first = 0; first < references.size(); first += lanes) {
    const std::size_t count = std::min(lanes, references.size() - first);
    const std::size_t row = row_bytes(count);
    for (std::size_t i = 0; i < count; ++i) {
      const VoxelReference& reference = references[first + i];
      const EdgeTriangle& t = engine.pe(cell.pe)->triangle(reference).edges;
      for (int a = 0; a < 3; ++a) {
        const int lo = t.v0[a] + std::min({0, t.e1[a], t.e2[a]}) - base[a];
        const int hi = t.v0[a] + std::max({0, t.e1[a], t.e2[a]}) - base[a];
        const auto byte = [&](std::int64_t x) {
          return static_cast<std::uint8_t>(std::clamp<std::int64_t>(x, 0, 255));
        };
        const auto at = static_cast<std::size_t>(a);
        group[at * row + i] = byte(std::int64_t{std::max(lo, 0)} * 255 / size[a]);
        group[(at + 3) * row + i] =
            byte((std::int64_t{std::max(hi, 0)} * 255 + size[a] - 1) / size[a]);
      }
      const std::uint32_t number = bases_[cell.pe] + reference.triangle;
      std::memcpy(group + kRows * row + i * sizeof number, &number, sizeof number);
    }
    group += row * (kRows + sizeof(std::uint32_t));
  }
}

}  // namespace gridrt
