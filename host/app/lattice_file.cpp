#include "host/app/lattice_file.hpp"

#include <array>

#include "host/app/npz.hpp"

namespace gridrt {

void LatticeRecorder::add(std::span<const Ray> rays, std::span<const Segment> segments) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    rays_.insert(rays_.end(), {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
                               ray.direction.y, ray.direction.z, ray.tmin, ray.tmax});
    const bool miss = segments[i].is_miss();
    const glm::ivec3 p0 = miss ? glm::ivec3(-1) : segments[i].p0;
    const glm::ivec3 p1 = miss ? glm::ivec3(-1) : segments[i].p1;
    p0_.insert(p0_.end(), {p0.x, p0.y, p0.z});
    p1_.insert(p1_.end(), {p1.x, p1.y, p1.z});
  }
}

Result<std::vector<std::byte>> LatticeRecorder::pack(const PreparedScene& prepared) const {
  const Scene& scene = prepared.scene;
  const Lattice& lattice = prepared.lattice;
  const std::uint64_t count = scene.triangles.size();
  std::vector<std::int32_t> q;
  std::vector<float> vertices;
  q.reserve(9 * count);
  vertices.reserve(9 * count);
  // Degenerate triangles are in no PE, so they come from the scene.
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t index : triangle) {
      const glm::vec3& v = scene.positions[index];
      const glm::ivec3 snapped = snap(lattice, v);
      q.insert(q.end(), {snapped.x, snapped.y, snapped.z});
      vertices.insert(vertices.end(), {v.x, v.y, v.z});
    }
  }
  // The others are what the device was given.
  const ImageTriangles& triangles = prepared.images->triangles;
  for (std::size_t i = 0; i < triangles.global_ids.size(); ++i) {
    const std::size_t at = 9 * static_cast<std::size_t>(triangles.global_ids[i]);
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        q[at + static_cast<std::size_t>((3 * corner) + axis)] =
            triangles.triangles[i].v[static_cast<std::size_t>(corner)][axis];
      }
    }
  }
  const std::uint64_t rays = p0_.size() / 3;
  const std::array<std::uint64_t, 3> triangle_shape = {count, 3, 3};
  const std::array<std::uint64_t, 2> ray_shape = {rays, 8};
  const std::array<std::uint64_t, 2> point_shape = {rays, 3};
  const std::array<std::uint64_t, 1> vector_shape = {3};
  const glm::ivec3 far_corner = lattice.box();
  const std::array<std::int32_t, 3> scale = {lattice.scale.x, lattice.scale.y, lattice.scale.z};
  const std::array<std::int32_t, 3> box = {far_corner.x, far_corner.y, far_corner.z};
  const std::array<float, 3> lo = {lattice.lo.x, lattice.lo.y, lattice.lo.z};
  const std::array<std::int32_t, 1> bits = {lattice.bits};
  NpzWriter writer;
  writer.add("q", "<i4", triangle_shape, q);
  writer.add("s", "<i4", vector_shape, scale);
  writer.add("lo", "<f4", vector_shape, lo);
  writer.add("P0", "<i4", point_shape, p0_);
  writer.add("P1", "<i4", point_shape, p1_);
  writer.add("bits", "<i4", {}, bits);
  writer.add("box", "<i4", vector_shape, box);
  writer.add("rays", "<f8", ray_shape, rays_);
  writer.add("vertices", "<f4", triangle_shape, vertices);
  return writer.pack();
}

}  // namespace gridrt
