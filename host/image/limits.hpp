// Whether a scene, cut and dealt, fits the memories of a record layout.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"
#include "host/image/memory_sizes.hpp"

namespace gridrt {

/// Entries that one PE needs.
struct PeUse {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::uint64_t references = 0;
};

/// Entries that an image needs.
struct ImageUse {
  std::uint64_t local_ids = 0;
  std::uint64_t blocks = 0;
  std::uint64_t cells = 0;
  std::uint64_t longest_list = 0;  ///< references of the fullest voxel
  std::vector<PeUse> pes;
};

/// Most PEs that a layout can name.
int most_pes(protocol::Layout layout);

/// Most local ids that a layout can name (all ones means none).
std::uint64_t most_local_ids(protocol::Layout layout);

/// kLimit with every size that is too large for `memory`, or for the layout's fields, and what
/// would help; or nothing.
Result<void> check_limits(protocol::Layout layout, const MemorySizes& memory, const ImageUse& use);

/// Refuses PEs and lattice bits that records of the layout cannot express. Errors: kLimit.
Result<void> check_widths(protocol::Layout layout, int bits, int pes);

/// Refuses, before any work on the grid, what can fit in no grid: more triangles than ids, or than
/// all PEs together hold. Errors: kLimit.
Result<void> check_scene_limits(protocol::Layout layout, const MemorySizes& memory, int pes,
                                std::uint64_t local_ids);

}  // namespace gridrt
