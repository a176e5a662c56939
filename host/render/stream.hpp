// Tracing rays that come one after the other, without shading.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "hal/error.hpp"
#include "host/driver/device.hpp"
#include "host/grid/lattice.hpp"
#include "host/render/camera.hpp"
#include "host/render/waves.hpp"

namespace gridrt {

/// Fills in valid rays number `first` to first + rays.size() - 1; called in ascending order.
using RaySource = std::function<Result<void>(std::uint64_t first, std::span<Ray> rays)>;

struct StreamOptions {
  Query query = Query::kClosestHit;
  int threads = 0;                            ///< that cut rays to segments; 0: one a core
  std::size_t chunk = std::size_t{1} << 17U;  ///< rays in memory at a time, >= 1
};

/// Traces `total` rays and hands rays, segments and hits to `sink` in their order. Counts them as
/// primary rays. Errors: those of source, device and sink.
Result<void> trace_stream(const Lattice& lattice, Device& device, std::uint64_t total,
                          const RaySource& source, const PrimarySink& sink,
                          const StreamOptions& options, RenderReport& report,
                          const ProgressSink& progress = {});

/// The primary rays of a picture: row-major, a pixel's samples adjacent. `camera` outlives it.
RaySource primary_rays(const PinholeCamera& camera, int width, int samples, int threads);

}  // namespace gridrt
