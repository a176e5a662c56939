// A small image, rays and the answers that an honest device gives.
#pragma once

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>
#include <vector>

#include "hal/loopback.hpp"
#include "host/driver/session.hpp"
#include "host/pe/software_device.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace gridrt::fuzz {

inline DeviceOptions options() {
  DeviceOptions options;
  options.threads = 1;
  options.rays_per_frame = 7;
  options.frames_in_flight = 3;
  options.timeout_ms = 1000;
  return options;
}

/// Triangles in layers, so that a ray may meet several.
inline Scene small_scene() {
  Scene scene;
  scene.materials.emplace_back();
  for (std::uint32_t i = 0; i < 24; ++i) {
    const float x = static_cast<float>(i % 4) * 0.25F;
    const float y = static_cast<float>(i / 4 % 2) * 0.5F;
    const float z = static_cast<float>(i / 8) * 0.4F;
    const auto base = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.emplace_back(x, y, z);
    scene.positions.emplace_back(x + 0.4F, y + 0.1F, z + 0.1F);
    scene.positions.emplace_back(x, y + 0.6F, z + 0.05F);
    scene.triangles.push_back({base, base + 1, base + 2});
    scene.triangle_materials.push_back(0);
  }
  return scene;
}

inline std::unique_ptr<Endpoint> honest_device(bool board = false) {
  SoftwareDeviceOptions software;
  software.capabilities = board_capabilities();
  if (!board) software.capabilities.layouts = 0xFF;
  return std::make_unique<SoftwareDevice>(software);
}

struct Case {
  Image image;
  ImageTriangles triangles;
  std::vector<Segment> segments;
  std::vector<Hit> closest;
  std::vector<Hit> any;
};

inline std::vector<Segment> make_segments(const Image& image) {
  std::uint64_t state = 5;
  const auto below = [&](int bound) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<int>((state >> 33U) % static_cast<std::uint64_t>(bound));
  };
  std::vector<Segment> segments(24);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const glm::ivec3 box = image.lattice().box();
    for (int a = 0; a < 3; ++a) {
      segments[i].p0[a] = below(box[a] + 1);
      segments[i].p1[a] = below(box[a] + 1);
    }
    segments[i].p0.z = 0;
    segments[i].p1.z = box.z;
    segments[i].t1 = 1.0;
    if (i % 8 == 0) segments[i].ignore = static_cast<std::uint32_t>(below(24));
  }
  segments[3].p1 = segments[3].p0;  // a miss that is not sent
  return segments;
}

inline Case make_case(protocol::Layout layout) {
  ImageOptions image_options;
  image_options.layout = layout;
  image_options.bits = 12;
  image_options.pes = 2;
  image_options.grid = glm::ivec3{4, 3, 3};
  auto image = build_image(small_scene(), image_options);
  require(image.has_value());
  auto triangles = decode_triangles(*image);
  require(triangles.has_value());
  Case made{std::move(*image), std::move(*triangles), {}, {}, {}};
  made.segments = make_segments(made.image);
  auto session = Session::open(std::make_unique<LoopbackTransport>(honest_device()), options());
  require(session.has_value() && (*session)->load(made.image).has_value());
  made.closest.resize(made.segments.size());
  made.any.resize(made.segments.size());
  require((*session)->trace(made.segments, Query::kClosestHit, made.closest).has_value());
  require((*session)->trace(made.segments, Query::kAnyHit, made.any).has_value());
  require(std::ranges::count_if(made.closest, [](const Hit& hit) { return hit.id >= 0; }) > 8);
  return made;
}

inline bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

}  // namespace gridrt::fuzz
