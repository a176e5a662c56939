// A scene, its image and rays for the tests of PEs and driver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/grid/segment.hpp"
#include "host/image/image.hpp"
#include "host/scene/load.hpp"

namespace gridrt::fixture {

/// splitmix64 (Steele, Lea, Flood 2014), so that every machine draws the same rays.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  /// In [0, bound).
  int below(int bound) { return static_cast<int>(next() % static_cast<std::uint64_t>(bound)); }

 private:
  std::uint64_t state_;
};

inline Image make_image(const std::string& scene, const ImageOptions& options = {}) {
  const Result<Scene> loaded = load_scene(scene);
  if (!loaded) throw std::runtime_error(loaded.error().message);
  Result<Image> image = build_image(*loaded, options);
  if (!image) throw std::runtime_error(image.error().message);
  return std::move(*image);
}

/// Segments between random lattice points of the box; every eighth ignores a triangle.
inline std::vector<Segment> random_segments(const Image& image, std::size_t count,
                                            std::uint64_t seed) {
  Random random(seed);
  const glm::ivec3 box = image.lattice().box();
  std::vector<Segment> segments(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) {
      segments[i].p0[a] = random.below(box[a] + 1);
      segments[i].p1[a] = random.below(box[a] + 1);
    }
    segments[i].t1 = 1.0;
    if (i % 8 == 0 && image.header.triangles > 0) {
      segments[i].ignore =
          static_cast<std::uint32_t>(random.below(static_cast<int>(image.header.triangles)));
    }
  }
  return segments;
}

}  // namespace gridrt::fixture
