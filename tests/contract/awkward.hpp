// A scene with all that is awkward, rays of all kinds for it, and the answers of seq.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/driver/device.hpp"
#include "host/grid/segment.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::contract {

/// A few hundred triangles: closed, sliver, coplanar, duplicate and degenerate ones.
Scene awkward_scene(std::uint64_t seed);

/// Segments of every kind on the scene's lattice; some ignore a triangle, some are misses by
/// definition. GRIDRT_CONTRACT_RAYS (default 1500) is how many, for devices that are slow.
std::vector<Segment> awkward_segments(const Scene& scene, int bits, std::uint64_t seed);

/// Traces all segments; a failure fails the test.
std::vector<Hit> trace(Device& device, std::span<const Segment> segments, Query query);

/// The answers of seq with one PE, default grid and batch.
std::vector<Hit> reference(const Scene& scene, int bits, std::span<const Segment> segments,
                           Query query);

}  // namespace gridrt::contract
