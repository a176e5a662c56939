// The records of one PE, checked and decoded.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/image/image.hpp"

namespace gridrt {

/// Triangles of one PE by its own index.
struct PeTriangles {
  std::vector<LatticeTriangle> triangles;
  std::vector<std::uint32_t> ids;  ///< local ids, ascending
};

/// "section Triangles of PE 2" or "section Blocks".
std::string section_name(protocol::SectionKind kind, int pe);

/// The section, if it is there and its size is a multiple of `stride`. Errors: kInput.
Result<const ImageSection*> find_records(const Image& image, protocol::SectionKind kind, int pe,
                                         std::size_t stride);

/// Decodes the triangles and vertices of a PE. Errors: kInput for an index, coordinate or id out
/// of range, ids that do not ascend, and widths that are not valid.
Result<PeTriangles> decode_pe_triangles(const Image& image, int pe);

/// The Ids section. Errors: kInput unless it holds header.local_ids ids, ascending, below
/// header.triangles.
Result<std::vector<std::uint32_t>> decode_ids(const Image& image);

}  // namespace gridrt
