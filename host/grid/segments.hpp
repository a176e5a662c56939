// Many rays to segments at once.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "host/grid/segment.hpp"

namespace gridrt {

/// segments[i] = make_segment(lattice, rays[i]), bit for bit, for spans of one size and valid rays;
/// with the widest vectors that this processor has.
void make_segments(const Lattice& lattice, std::span<const Ray> rays, std::span<Segment> segments);

/// The code for one kind of vectors.
struct SegmentKernel {
  std::string_view name;  ///< baseline, sse4, avx2, avx512; elsewhere Highway's name
  void (*make)(const Lattice& lattice, std::span<const Ray> rays, std::span<Segment> segments);
};

/// Those that this build has and this processor can run, the widest first. Never empty.
std::vector<SegmentKernel> segment_kernels();

}  // namespace gridrt
