#include "host/pe/traversal_memory.hpp"

#include "host/grid/lattice.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::SectionKind;

/// The grid of a header, if it is one that make_grid could have made.
Accepted<VoxelGrid> decode_grid(const protocol::ImageHeader& header) {
  VoxelGrid grid;
  std::uint64_t cells = 1;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const std::int64_t count = header.grid_count[i];
    const std::int64_t edge = header.grid_edge[i];
    const std::int64_t box = std::int64_t{header.max_q[i]} + 2;
    if (header.max_q[i] < 2 || box > (std::int64_t{1} << kMaxBits)) {
      return refuse(ErrorCode::kBadHeader, static_cast<std::uint32_t>(52 + 4 * a));
    }
    if (count < 1 || count > box) {
      return refuse(ErrorCode::kBadHeader, static_cast<std::uint32_t>(64 + 4 * a));
    }
    if (edge < 1 || edge > box || count * edge < box) {
      return refuse(ErrorCode::kBadHeader, static_cast<std::uint32_t>(76 + 4 * a));
    }
    cells *= static_cast<std::uint64_t>(count);
    if (cells > (std::uint64_t{1} << 28)) return refuse(ErrorCode::kBadHeader, 64);
    grid.count[a] = static_cast<int>(count);
    grid.edge[a] = static_cast<int>(edge);
  }
  if (header.margin > 1024) return refuse(ErrorCode::kBadHeader, 88);
  grid.margin = static_cast<int>(header.margin);
  return grid;
}

}  // namespace

Accepted<TraversalMemory> TraversalMemory::decode(const protocol::ImageHeader& header,
                                                  std::span<const std::byte> blocks,
                                                  std::span<const std::byte> cells) {
  TraversalMemory memory;
  const Accepted<VoxelGrid> grid = decode_grid(header);
  if (!grid) return std::unexpected(grid.error());
  memory.grid_ = *grid;
  memory.block_count_ = (memory.grid_.count + 1) / 2;
  const protocol::BlockCodec block_codec(header);
  const protocol::CellCodec cell_codec(header);
  if (!block_codec.valid() || !cell_codec.valid()) return refuse(ErrorCode::kBadHeader, 108);

  const std::size_t block_count = static_cast<std::size_t>(memory.block_count_.x) *
                                  static_cast<std::size_t>(memory.block_count_.y) *
                                  static_cast<std::size_t>(memory.block_count_.z);
  const auto bad = [](SectionKind kind) {
    return refuse(ErrorCode::kBadSection, section_detail(kind));
  };
  if (blocks.size() != block_count * block_codec.stride()) return bad(SectionKind::kBlocks);
  if (cells.size() != std::size_t{header.occupied_cells} * cell_codec.stride()) {
    return bad(SectionKind::kCells);
  }
  memory.cells_.resize(header.occupied_cells);
  for (std::size_t i = 0; i < memory.cells_.size(); ++i) {
    const protocol::CellRecord record = cell_codec.at(cells, i);
    if (record.pe >= header.pes || record.count == 0) return bad(SectionKind::kCells);
    memory.cells_[i] = {record.first, record.count, record.pe};
  }
  memory.blocks_.resize(block_count);
  for (std::size_t i = 0; i < block_count; ++i) {
    const protocol::BlockRecord record = block_codec.at(blocks, i);
    Block& block = memory.blocks_[i];
    block.base = record.base;
    block.occupancy = static_cast<std::uint8_t>(record.occupancy);
    const auto occupied = static_cast<std::uint64_t>(std::popcount(record.occupancy));
    if (occupied != 0 && record.base + occupied > memory.cells_.size()) {
      return bad(SectionKind::kBlocks);
    }
    for (std::size_t d = 0; d < 6; ++d) {
      // A jump out of an occupied block would lose its voxels.
      if (occupied != 0 && record.jump[d] != 0) return bad(SectionKind::kBlocks);
      block.jump[d] = static_cast<std::uint8_t>(record.jump[d]);
    }
  }
  return memory;
}

}  // namespace gridrt
