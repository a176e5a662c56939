#include "host/pe/capabilities.hpp"

#include "host/grid/lattice.hpp"
#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

using protocol::Layout;

constexpr std::uint8_t layout_bit(Layout layout) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(layout));
}

protocol::CapabilitiesReport with_sizes(const protocol::LayoutLimits& limits) {
  protocol::CapabilitiesReport report;
  report.max_triangles = limits.max_triangles;
  report.max_vertices = limits.max_vertices;
  report.max_references = limits.max_references;
  report.max_cells = limits.max_cells;
  report.max_blocks = limits.max_blocks;
  return report;
}

}  // namespace

protocol::CapabilitiesReport software_capabilities() {
  protocol::CapabilitiesReport report = with_sizes(protocol::kWideLimits);
  report.layouts = layout_bit(Layout::kCompact) | layout_bit(Layout::kWide);
  report.max_bits = kMaxBits;
  report.pes = kMaxPes;
  report.max_payload = protocol::kMaxPayload;
  return report;
}

protocol::CapabilitiesReport board_capabilities() {
  protocol::CapabilitiesReport report = with_sizes(protocol::kCompactLimits);
  report.layouts = layout_bit(Layout::kCompact);
  report.max_bits = kMaxCompactBits;
  report.pes = 4;
  report.max_payload = 16384;
  report.clock_hz = 60'000'000;
  return report;
}

}  // namespace gridrt
