// What an image holds, in numbers and as text.
#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>

#include "host/grid/partition.hpp"
#include "host/image/blocks.hpp"
#include "host/image/image_file.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

/// Whole records of a section; 0 if it is missing.
template <class Codec>
std::size_t records(const Image& image, SectionKind kind, int pe) {
  const ImageSection* section = image.find(kind, pe);
  return section == nullptr ? 0 : section->bytes.size() / Codec(image.header).stride();
}

void count_cells(const Image& image, std::vector<ImageCounts>& counts) {
  const protocol::CellCodec codec(image.header);
  const ImageSection* section = image.find(SectionKind::kCells);
  for (std::size_t i = 0; i < records<protocol::CellCodec>(image, SectionKind::kCells, 0); ++i) {
    const std::uint32_t pe = codec.at(section->bytes, i).pe;
    if (pe + 1 < counts.size()) ++counts[pe].cells;
  }
}

void count_copies(const Image& image, std::vector<ImageCounts>& counts) {
  const protocol::TriangleCodec codec(image.header);
  std::size_t largest = 0;
  for (std::size_t p = 0; p + 1 < counts.size(); ++p) {
    largest += counts[p].triangles;
  }
  std::vector<bool> seen(std::min<std::size_t>(image.header.local_ids, largest), false);
  for (std::size_t p = 0; p + 1 < counts.size(); ++p) {
    const ImageSection* section = image.find(SectionKind::kTriangles, static_cast<int>(p));
    for (std::size_t i = 0; i < counts[p].triangles; ++i) {
      const std::uint32_t id = codec.at(section->bytes, i).id;
      if (id >= seen.size()) continue;
      if (seen[id]) ++counts[p].copies;
      seen[id] = true;
    }
  }
}

std::string size_text(std::size_t bytes) {
  if (bytes < 10240) return fmt::format("{} B", bytes);
  if (bytes < 10 * 1048576) return fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024.0);
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / 1048576.0);
}

double ratio(std::uint64_t a, std::uint64_t b) {
  return b == 0 ? 0.0 : static_cast<double>(a) / static_cast<double>(b);
}

std::string describe_lattice(const Image& image) {
  const Lattice l = image.lattice();
  std::string out = fmt::format("lattice     {} bits\n", l.bits);
  constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};
  for (int a = 0; a < 3; ++a) {
    out +=
        fmt::format("  {}         {} .. {}, scale 2^{}, steps 2 .. {}\n",
                    kAxes[static_cast<std::size_t>(a)], l.lo[a], l.hi[a], l.scale[a], l.max_q[a]);
  }
  return out;
}

std::string describe_mapping(std::uint8_t mapping) {
  const auto known = static_cast<Mapping>(mapping);
  for (const Mapping m :
       {Mapping::kBoxes, Mapping::kContiguous, Mapping::kVoxel, Mapping::kMeasured}) {
    if (m == known) return std::string(mapping_name(m));
  }
  return fmt::format("unknown ({})", mapping);
}

}  // namespace

std::vector<ImageCounts> count_image(const Image& image) {
  std::vector<ImageCounts> counts(std::size_t{image.header.pes} + 1);
  for (std::size_t p = 0; p < image.header.pes; ++p) {
    const int pe = static_cast<int>(p);
    counts[p].triangles = records<protocol::TriangleCodec>(image, SectionKind::kTriangles, pe);
    counts[p].vertices = records<protocol::VertexCodec>(image, SectionKind::kVertices, pe);
    counts[p].references = records<protocol::ReferenceCodec>(image, SectionKind::kReferences, pe);
  }
  count_cells(image, counts);
  count_copies(image, counts);
  ImageCounts& total = counts.back();
  for (std::size_t p = 0; p < image.header.pes; ++p) {
    total.triangles += counts[p].triangles;
    total.copies += counts[p].copies;
    total.vertices += counts[p].vertices;
    total.references += counts[p].references;
    total.cells += counts[p].cells;
  }
  return counts;
}

std::string describe_image(const Image& image) {
  const protocol::ImageHeader& h = image.header;
  const std::vector<ImageCounts> counts = count_image(image);
  const ImageCounts& total = counts.back();
  std::string out;
  out += fmt::format("layout      {}\n", protocol::name(static_cast<protocol::Layout>(h.layout)));
  out += fmt::format("triangles   {}, of which {} degenerate\n", h.triangles, h.degenerate);
  out += describe_lattice(image);
  out += fmt::format("grid        {} x {} x {} voxels of {} x {} x {} steps, margin {}\n",
                     h.grid_count[0], h.grid_count[1], h.grid_count[2], h.grid_edge[0],
                     h.grid_edge[1], h.grid_edge[2], h.margin);
  out +=
      fmt::format("occupied    {} of {} voxels ({:.1f} %), {:.2f} references each\n", total.cells,
                  image.grid().cells(), 100.0 * ratio(total.cells, image.grid().cells()),
                  ratio(total.references, total.cells));
  out += fmt::format("chunk       {} of {}\n", h.chunk + 1, h.chunks);
  out += fmt::format("PEs         {}, voxels dealt by {}, {:.3f} copies of a triangle\n\n", h.pes,
                     describe_mapping(h.mapping), ratio(total.triangles, h.local_ids));

  const protocol::LayoutLimits limits =
      protocol::layout_limits(static_cast<protocol::Layout>(h.layout));
  const bool compact = static_cast<protocol::Layout>(h.layout) == protocol::Layout::kCompact;
  std::uint64_t fullest = 0;
  out += fmt::format("{:>5} {:>10} {:>10} {:>10} {:>10} {:>10} {:>8}{}\n", "PE", "triangles",
                     "copies", "vertices", "references", "voxels", "share",
                     compact ? "   fill (triangles, vertices, references)" : "");
  for (std::size_t p = 0; p < h.pes; ++p) {
    const ImageCounts& c = counts[p];
    fullest = std::max(fullest, c.references);
    out += fmt::format("{:>5} {:>10} {:>10} {:>10} {:>10} {:>10} {:>6.1f} %", p, c.triangles,
                       c.copies, c.vertices, c.references, c.cells,
                       100.0 * ratio(c.references, total.references));
    if (compact) {
      out += fmt::format("   {:.0f} %, {:.0f} %, {:.0f} %",
                         100.0 * ratio(c.triangles, limits.max_triangles),
                         100.0 * ratio(c.vertices, limits.max_vertices),
                         100.0 * ratio(c.references, limits.max_references));
    }
    out += '\n';
  }
  out += fmt::format("{:>5} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "all", total.triangles,
                     total.copies, total.vertices, total.references, total.cells);
  out += fmt::format("balance     fullest PE {:.3f} x the mean (by references)\n\n",
                     ratio(fullest * h.pes, total.references));
  std::size_t bytes = header_section(image).size();
  for (const ImageSection& s : image.sections) {
    bytes += s.bytes.size();
    out += fmt::format("section     {:<10} {:>3}  {:>12}\n", protocol::name(s.kind), s.pe,
                       size_text(s.bytes.size()));
  }
  out += fmt::format("total       {}\n", size_text(bytes));
  return out;
}

}  // namespace gridrt
