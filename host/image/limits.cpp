#include "host/image/limits.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "host/grid/lattice.hpp"
#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

/// Collects what is too large.
class Excess {
 public:
  void check(std::uint64_t need, std::uint64_t most, std::string_view what,
             std::string_view where) {
    if (need <= most) return;
    text_ +=
        fmt::format("{}{} {}{} (at most {})", text_.empty() ? "" : ", ", need, what, where, most);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

int most_pes(protocol::Layout layout) {
  const std::uint32_t bits = protocol::layout_limits(layout).pe_bits;
  return bits >= 6 ? kMaxPes : static_cast<int>(1U << bits);
}

std::uint64_t most_local_ids(protocol::Layout layout) {
  return (std::uint64_t{1} << protocol::layout_limits(layout).id_bits) - 1;
}

Result<void> check_limits(protocol::Layout layout, const MemorySizes& memory, const ImageUse& use) {
  const protocol::LayoutLimits limits = protocol::layout_limits(layout);
  Excess excess;
  excess.check(use.blocks, memory.blocks, "blocks of 2x2x2 voxels", "");
  excess.check(use.cells, memory.cells, "voxels with triangles", "");
  excess.check(use.longest_list, (std::uint64_t{1} << limits.list_bits) - 1, "triangles",
               " in one voxel");
  for (std::size_t p = 0; p < use.pes.size(); ++p) {
    const std::string where = fmt::format(" in PE {}", p);
    excess.check(use.pes[p].triangles, memory.triangles, "triangles", where);
    excess.check(use.pes[p].vertices, memory.vertices, "vertices", where);
    excess.check(use.pes[p].references, memory.references, "references", where);
  }
  if (excess.text().empty()) return {};
  return fail(ErrorKind::kLimit,
              fmt::format("the scene does not fit the {} layout: {}", protocol::name(layout),
                          excess.text()),
              layout == protocol::Layout::kCompact
                  ? "try another --grid, more --pes (up to 4), fewer triangles, or the wide layout"
                  : "try a coarser --grid or more --pes");
}

Result<void> check_widths(protocol::Layout layout, int bits, int pes) {
  if (layout == protocol::Layout::kCompact && bits > kMaxCompactBits) {
    return fail(ErrorKind::kLimit, fmt::format("{} lattice bits do not fit compact records", bits),
                fmt::format("use at most {} --bits, or the wide layout", kMaxCompactBits));
  }
  if (pes > most_pes(layout)) {
    return fail(ErrorKind::kLimit,
                fmt::format("{} PEs do not fit the {} layout", pes, protocol::name(layout)),
                fmt::format("use at most {} --pes", most_pes(layout)));
  }
  return {};
}

Result<void> check_scene_limits(protocol::Layout layout, const MemorySizes& memory, int pes,
                                std::uint64_t local_ids) {
  const std::uint64_t most =
      std::min(most_local_ids(layout), static_cast<std::uint64_t>(pes) * memory.triangles);
  if (local_ids > most) {
    return fail(ErrorKind::kLimit,
                fmt::format("{} triangles do not fit the {} layout: {} PEs hold {} at most",
                            local_ids, protocol::name(layout), pes, most),
                layout == protocol::Layout::kCompact ? "use the wide layout, or fewer triangles"
                                                     : "use more --pes");
  }
  return {};
}

}  // namespace gridrt
