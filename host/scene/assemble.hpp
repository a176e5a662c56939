// Putting scenes together: vertices rounded once, placed copies, smooth normals, final checks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::scene_detail {

/// Most triangles that a scene may have: ids are int32 in results, and -1 means none.
inline constexpr std::uint64_t kMaxTriangles = 0x7FFFFFFEU;

using Corners = std::array<std::uint32_t, 3>;
inline constexpr Corners kFlat{kNoIndex, kNoIndex, kNoIndex};

/// Adds a vertex rounded to float32 and returns its index.
std::uint32_t add_vertex(Scene& scene, const glm::dvec3& position);

/// Adds a normal scaled to unit length and returns its index; kNoIndex if it has no direction.
std::uint32_t add_normal(Scene& scene, const glm::dvec3& normal);

/// Adds a triangle; `normals` is kFlat for flat shading.
void add_triangle(Scene& scene, const Corners& corners, std::uint32_t material = 0,
                  const Corners& normals = kFlat);

/// Adds a material and returns its index.
std::uint32_t add_material(Scene& scene, Material material);

/// How append_scene() places what it adds.
struct Placement {
  glm::dmat4 matrix{1.0};  ///< affine: the last row is 0 0 0 1
  std::optional<std::uint32_t> material =
      std::nullopt;                  ///< of all added triangles; none: those of `from`
  std::uint32_t first_material = 0;  ///< otherwise: where the materials of `from` stand
};

/// Adds the triangles of `from` under a placement: positions are transformed in double and rounded
/// once; a mirroring matrix also swaps two corners, so that outsides stay outside. Materials are
/// not copied. Errors name `where`: a position beyond float32, too many triangles.
Result<void> append_scene(Scene& into, const Scene& from, const Placement& placement,
                          const std::string& where);

/// Gives triangles without normals smooth ones: at a vertex, the sum of the normals of its
/// triangles weighted by their angles there (Thuermer and Wuethrich 1998). Vertices at one position
/// are taken as one. `groups`: one number a triangle; only triangles of one group share normals,
/// and those of group 0 stay as they are; empty: all triangles are one group.
void make_smooth(Scene& scene, std::span<const std::uint32_t> groups = {});

/// Removes normals and triangle_normals: every triangle is flat.
void make_flat(Scene& scene);

/// Adds the default lights (one high on the left in front, a weaker one from the right).
void add_default_lights(Scene& scene);

/// The last check of every reader: sizes agree, indices are in range, everything is finite, within
/// its valid range, and the triangles can be numbered. Errors name `name` and the element.
Result<void> check_scene(const Scene& scene, const std::string& name);

}  // namespace gridrt::scene_detail
