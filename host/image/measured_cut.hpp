// Grid and dealing for devices whose memories are small: those on which sample rays cost least.
#pragma once

#include "host/image/lattice_scene.hpp"

namespace gridrt {

/// One image on the grid, and with the dealing, that sample rays find cheapest of those that fit.
/// Errors: kLimit if none of them fits.
Result<Image> pack_measured(const LatticeScene& scene);

}  // namespace gridrt
