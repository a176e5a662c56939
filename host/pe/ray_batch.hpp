// The rays of one Trace frame, unpacked, and their answers, packed as hits.
#pragma once

#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/pe/batch_ray.hpp"
#include "host/pe/engine.hpp"
#include "host/pe/image_store.hpp"

namespace gridrt {

/// Unpacks whole ray records in the image's layout, on `threads` threads (>= 1). Refuses rays with
/// a coordinate outside the box (detail: the index of the first).
Accepted<std::vector<BatchRay>> unpack_rays(const protocol::ImageHeader& header,
                                            std::span<const std::byte> records, int threads);

/// Writes the hit record of ray `index` of a batch. An any-hit ray that hits has id 0, whatever
/// the answer's id.
void pack_answer(protocol::Layout layout, const BatchRay& ray, const PeAnswer& answer,
                 std::size_t index, std::span<std::byte> hits);

}  // namespace gridrt
