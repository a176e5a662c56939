// Whitted's ray tracing (T. Whitted, "An Improved Illumination Model for Shaded Display", 1980) as
// waves: batches of independent rays, depth by depth.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "hal/error.hpp"
#include "host/driver/device.hpp"
#include "host/grid/lattice.hpp"
#include "host/image/image.hpp"
#include "host/render/camera.hpp"
#include "host/render/film.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

inline constexpr int kMaxDepth = 1000;     ///< generations of secondary rays
inline constexpr int kMaxSamples = 65536;  ///< per pixel

struct RenderOptions {
  int width = 640;   ///< pixels, in [1, kMaxPictureSide]
  int height = 480;  ///< pixels
  int samples = 1;   ///< per pixel, in [1, kMaxSamples]
  int depth = 6;     ///< longest chain of mirror and glass rays after a primary ray; 0: none
  int threads = 0;   ///< that shade; 0: one a core
  /// Rays of a wave: bounds memory to some 500 bytes times this times the depth that is reached.
  std::size_t wave_rays = std::size_t{1} << 17U;
  /// Most rays that one pixel sample may need at one depth.
  std::size_t sample_rays = std::size_t{1} << 22U;
};

/// Rays by kind, and the time that they took.
struct RenderReport {
  std::uint64_t primary = 0;
  std::uint64_t shadow = 0;
  std::uint64_t mirror = 0;
  std::uint64_t refraction = 0;
  std::uint64_t outside = 0;   ///< of all these, rays that never meet the lattice box
  int deepest = 0;             ///< generations of secondary rays that were needed
  double trace_seconds = 0.0;  ///< within Device::trace
  double shade_seconds = 0.0;  ///< everything else

  [[nodiscard]] std::uint64_t total() const { return primary + shadow + mirror + refraction; }
};

/// Hears about primary rays, in the order of the picture: row-major, a pixel's samples adjacent.
using PrimarySink = std::function<Result<void>(std::span<const Ray>, std::span<const Segment>,
                                               std::span<const Hit>)>;
/// Hears how many of all primary rays are done.
using ProgressSink = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// Everything a picture is made of; the references outlive the call.
struct RenderInput {
  const Scene& scene;
  const Lattice& lattice;
  const ImageTriangles& triangles;  ///< of the image that `device` has loaded
  const PinholeCamera& camera;      ///< made for the options' width and height
};

/// Renders. The film depends on the input, and of the options on size, samples and
/// depth; no device, thread or wave size changes a bit of it. Errors: kUsage for options out
/// of range, kLimit where one pixel sample needs more than `sample_rays`, those of the
/// device, kDevice for answers that name no triangle, and those of the sink.
Result<Film> render(const RenderInput& input, const RenderOptions& options, Device& device,
                    RenderReport& report, const PrimarySink& primary_sink = {},
                    const ProgressSink& progress = {});

}  // namespace gridrt
