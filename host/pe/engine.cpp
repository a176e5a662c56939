#include "host/pe/engine.hpp"

#include <utility>

#include "host/grid/quarters.hpp"

namespace gridrt {

Accepted<Engine> Engine::assemble(TraversalMemory traversal, std::vector<std::optional<Pe>> pes) {
  for (const Cell& cell : traversal.cells()) {
    if (cell.pe >= pes.size()) {
      return refuse(protocol::ErrorCode::kBadSection,
                    section_detail(protocol::SectionKind::kCells));
    }
    const std::optional<Pe>& owner = pes[cell.pe];
    if (owner && std::uint64_t{cell.first} + cell.count > owner->references()) {
      return refuse(protocol::ErrorCode::kBadSection,
                    section_detail(protocol::SectionKind::kReferences, cell.pe));
    }
  }
  Engine engine;
  engine.traversal_ = std::move(traversal);
  engine.pes_ = std::move(pes);
  return engine;
}

PeAnswer Engine::closest_hit(const PeRay& ray, PeCounters& counters,
                             EngineObserver* observer) const {
  HitKey best;
  const VoxelGrid& grid = traversal_.grid();
  counters.steps += traverse(
      grid, ray.p0, ray.p1,
      [&](const glm::ivec3& voxel, int direction) { return traversal_.jump(voxel, direction); },
      [&](const VoxelVisit& visit) {
        // A hit in this voxel or a later one has a quotient of at least that of the entry, so
        // only a strictly greater one rules them out: an equal one may hold a lower id.
        if (best.id != kNoTriangle && visit.enter.quotient() > best.quotient) {
          ++counters.interrupts;
          if (observer != nullptr) observer->on_cancel(visit, best);
          return false;
        }
        const Cell* cell = traversal_.find(visit.voxel);
        if (cell == nullptr || !pes_[cell->pe]) {
          if (observer != nullptr) observer->on_voxel(visit, cell);
          return true;
        }
        const CellSet cells = ray_cells(grid, ray.p0, ray.p1, visit);
        if (observer != nullptr) observer->on_voxel(visit, cell);
        pes_[cell->pe]->test(ray, cell->first, cell->count, cells, best, counters, observer);
        return true;
      });
  ++counters.rays;
  if (best.id == kNoTriangle) return std::nullopt;
  return best;
}

bool Engine::any_hit(const PeRay& ray, PeCounters& counters) const {
  bool hit = false;
  const VoxelGrid& grid = traversal_.grid();
  counters.steps += traverse(
      grid, ray.p0, ray.p1,
      [&](const glm::ivec3& voxel, int direction) { return traversal_.jump(voxel, direction); },
      [&](const VoxelVisit& visit) {
        const Cell* cell = traversal_.find(visit.voxel);
        if (cell == nullptr || !pes_[cell->pe]) return true;
        const CellSet cells = ray_cells(grid, ray.p0, ray.p1, visit);
        hit = pes_[cell->pe]->test_any(ray, cell->first, cell->count, cells, counters);
        if (hit) ++counters.interrupts;
        return !hit;
      });
  ++counters.rays;
  return hit;
}

}  // namespace gridrt
