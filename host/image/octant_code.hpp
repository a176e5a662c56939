// The codes by which references name sets of octants.
#pragma once

#include <cstdint>

#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// The code of the smallest set in protocol::kOctantSets that holds all of `octants`, the first
/// one of equals.
std::uint8_t octant_code(OctantSet octants);

/// The set that a code (6 bits) stands for.
OctantSet octants_of_code(std::uint32_t code);

}  // namespace gridrt
