// What software PEs tell about themselves.
#pragma once

#include "gridrt_protocol.hpp"

namespace gridrt {

/// Everything that the formats can express.
protocol::CapabilitiesReport software_capabilities();

/// What the board can do: compact records, four PEs and its memory sizes, frames of 16 KiB, a
/// clock. A software device that says this is treated as the board would be.
protocol::CapabilitiesReport board_capabilities();

}  // namespace gridrt
