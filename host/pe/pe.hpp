// A processing element: the triangles of its voxels in a memory of its own, and the exact test.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/grid/intersect.hpp"
#include "host/grid/intersect_narrow.hpp"
#include "host/grid/quarters.hpp"
#include "host/grid/voxel_grid.hpp"
#include "host/pe/counters.hpp"
#include "host/pe/refusal.hpp"

namespace gridrt {

/// A ray as a PE receives it.
struct PeRay {
  glm::ivec3 p0{0};
  glm::ivec3 p1{0};
  std::uint32_t ignore = kNoTriangle;  ///< local id that is never hit
};

/// Told of each reference that a PE looks at (for --explain); `hit` is empty on a miss.
class PeObserver {
 public:
  virtual ~PeObserver() = default;
  virtual void on_masked(std::uint32_t local_id) = 0;
  virtual void on_test(std::uint32_t local_id, const std::optional<HitKey>& hit) = 0;
};

/// Sees the three sections of its own image and nothing else.
class Pe {
 public:
  struct Triangle {
    EdgeTriangle edges;
    std::uint32_t id = 0;
  };

  /// Decodes a PE's sections and checks every index. `number` only names the PE in refusals.
  static Accepted<Pe> decode(const protocol::ImageHeader& header, std::uint8_t number,
                             std::span<const std::byte> references,
                             std::span<const std::byte> triangles,
                             std::span<const std::byte> vertices);

  /// References in this PE's memory.
  [[nodiscard]] std::size_t references() const { return references_.size(); }

  /// The references [first, first + count), within references(), and a triangle that one names.
  [[nodiscard]] std::span<const VoxelReference> list(std::uint32_t first,
                                                     std::uint32_t count) const {
    return std::span(references_).subspan(first, count);
  }
  [[nodiscard]] const Triangle& triangle(const VoxelReference& reference) const {
    return triangles_[reference.triangle];
  }

  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }

  /// Tests the references [first, first + count) that touch one of `cells` and lowers
  /// `best` to the smallest key found. The range lies within references().
  void test(const PeRay& ray, std::uint32_t first, std::uint32_t count, CellSet cells, HitKey& best,
            PeCounters& counters, PeObserver* observer = nullptr) const;

  /// The same, but stops at the first hit; true if there is one.
  bool test_any(const PeRay& ray, std::uint32_t first, std::uint32_t count, CellSet cells,
                PeCounters& counters) const;

 private:
  [[nodiscard]] std::optional<ExactHit> intersect(const PeRay& ray, const glm::ivec3& d,
                                                  const Triangle& triangle) const;

  bool narrow_ = true;  ///< 64 bits hold every product
  std::vector<VoxelReference> references_;
  std::vector<Triangle> triangles_;
};

}  // namespace gridrt
