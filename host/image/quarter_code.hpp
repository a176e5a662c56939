// The codes by which references name the quarters of a voxel that they touch: densely packed
// decimal (Cowlishaw, "Densely packed decimal encoding", 2002) of one digit an axis.
#pragma once

#include <cstdint>

#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// The code (10 bits) of quarters that form an interval on each axis.
std::uint32_t quarter_code(QuarterMasks quarters);

/// The quarters that a code stands for; its bits above the tenth do not count.
QuarterMasks quarters_of_code(std::uint32_t code);

}  // namespace gridrt
