// The life of a ray as a board's event log tells it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/pe/explain.hpp"

namespace gridrt {

/// Translates the words of the event log (rtl/shell/gridrt_log.sv) while `segment` alone was traced
/// through the loaded `image`. What the log says by index and memory address becomes voxels and
/// global ids; the entry and exit of a voxel, which it does not say, are computed. `lost`: the log
/// was too small. Errors: kProtocol for a word that says something impossible, and those of
/// decoding the image.
Result<std::vector<ExplainEvent>> read_ray_log(const Image& image, const Segment& segment,
                                               std::span<const std::uint32_t> words, bool lost);

}  // namespace gridrt
