// Evens out a dealing of voxels to PEs within their memories, by simulated annealing (Kirkpatrick,
// Gelatt and Vecchi, "Optimization by Simulated Annealing", 1983).
#pragma once

#include <cstdint>
#include <vector>

#include "host/image/dealing.hpp"

namespace gridrt {

/// Gives single voxels to PEs of neighbours, or at times to any PE, until the shares of the PEs are
/// about as even as references, triangles and vertices that fit their memories allow; if they do
/// not fit in the end, moves go on that make them fit, which may fail. The same dealing for the
/// same input. `owners` are in [0, cut.pes), at most 4 PEs.
void even_out(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
              std::vector<std::uint8_t>& owners);

}  // namespace gridrt
