// How much a device holds.
#pragma once

#include <algorithm>
#include <cstdint>

#include "gridrt_protocol.hpp"

namespace gridrt {

/// Entries that fit a device's memories: triangles, vertices and references per PE, voxels with
/// references (cells) and 2x2x2 blocks of voxels in all.
struct MemorySizes {
  std::uint32_t triangles = 0;
  std::uint32_t vertices = 0;
  std::uint32_t references = 0;
  std::uint32_t cells = 0;
  std::uint32_t blocks = 0;
  friend bool operator==(const MemorySizes&, const MemorySizes&) = default;
};

/// The most that records of a layout can address.
constexpr MemorySizes memory_sizes(protocol::Layout layout) {
  const protocol::LayoutLimits l = protocol::layout_limits(layout);
  return {l.max_triangles, l.max_vertices, l.max_references, l.max_cells, l.max_blocks};
}

/// What a device says of itself.
constexpr MemorySizes memory_sizes(const protocol::CapabilitiesReport& c) {
  return {c.max_triangles, c.max_vertices, c.max_references, c.max_cells, c.max_blocks};
}

/// What fits both.
constexpr MemorySizes smaller_of(const MemorySizes& a, const MemorySizes& b) {
  return {std::min(a.triangles, b.triangles), std::min(a.vertices, b.vertices),
          std::min(a.references, b.references), std::min(a.cells, b.cells),
          std::min(a.blocks, b.blocks)};
}

}  // namespace gridrt
