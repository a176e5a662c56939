// Many rays through a layout at once: as many as a vector has lanes, each in a voxel of its own,
// with a new ray wherever one has ended. Answers are those of Engine, bit for bit: single precision
// only rules out what its error bound allows (docs/numerics.md), exact integers decide the rest.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "host/pe/batch_ray.hpp"
#include "host/pe/engine.hpp"
#include "host/pe/ray_layout.hpp"

namespace gridrt {

/// Traces rays[i] to answers[i]; the spans are of one size. An any-hit ray that hits answers {0,
/// 0}.
using TraceStream = void (*)(const RayLayout& layout, std::span<const BatchRay> rays,
                             std::span<PeAnswer> answers, PeCounters& counters);

/// The code for one kind of vectors.
struct StreamKernel {
  std::string_view name;  ///< baseline, sse4, avx2, avx512; elsewhere Highway's name
  std::size_t lanes = 1;
  TraceStream trace = nullptr;
};

/// A layout and the code that it was made for.
struct StreamImage {
  StreamKernel kernel;
  RayLayout layout;
};

/// Those that this build has and this processor can run, the widest first. Never empty.
std::vector<StreamKernel> stream_kernels();

/// The one called `name`, or the widest if it is empty; nothing if there is none of that name.
std::optional<StreamKernel> stream_kernel(std::string_view name);

}  // namespace gridrt
