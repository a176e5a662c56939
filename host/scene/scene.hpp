// A scene as the rest of the project sees it: triangles in file order, materials, lights, camera.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace gridrt {

/// Marks an absent index.
inline constexpr std::uint32_t kNoIndex = 0xFFFFFFFFU;

/// Phong material with Whitted's global terms. Colours are linear RGB, each part in [0, 1].
struct Material {
  std::string name = "default";
  glm::vec3 ambient{0.1F};       ///< times the ambient light
  glm::vec3 diffuse{0.7F};       ///< Lambert part, per light
  glm::vec3 specular{0.0F};      ///< Phong highlight, per light
  float shininess = 32.0F;       ///< Phong exponent, >= 0
  glm::vec3 mirror{0.0F};        ///< weight of the reflected ray; all zero: no such ray
  glm::vec3 transmission{0.0F};  ///< weight of the refracted ray; all zero: opaque
  float ior = 1.5F;              ///< index of refraction inside, > 0
  glm::vec3 emission{0.0F};      ///< added as it is
};

/// A point light at `position`, or a directional one shining along `direction`.
struct Light {
  enum class Kind { kPoint, kDirectional };
  Kind kind = Kind::kPoint;
  glm::dvec3 position{0.0};              ///< of a point light, scene units
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< of a directional light: the way the light travels
  glm::vec3 colour{1.0F};                ///< linear RGB intensity, >= 0, no fall-off with distance
};

/// A pinhole camera; `fov_degrees` is vertical, in (0, 180).
struct Camera {
  glm::dvec3 eye{0.0, 0.0, 5.0};
  glm::dvec3 look{0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double fov_degrees = 45.0;
};

/// True for an angle that a Camera may have; not for NaN.
constexpr bool is_field_of_view(double degrees) { return degrees > 0.0 && degrees < 180.0; }

/// Triangles with everything that shading needs. A triangle's index is its id: file order after
/// splitting polygons into fans, degenerate ones included.
struct Scene {
  std::vector<glm::vec3> positions = {};  ///< finite float32, the nearest to the file's text
  std::vector<std::array<std::uint32_t, 3>> triangles = {};  ///< indices into positions
  std::vector<glm::vec3> normals = {};                       ///< unit length, for smooth shading
  /// Indices into normals, one triple a triangle, or empty where no triangle is smooth; a triple
  /// of kNoIndex marks a flat triangle.
  std::vector<std::array<std::uint32_t, 3>> triangle_normals = {};
  std::vector<std::uint32_t> triangle_materials = {};  ///< index into materials, one a triangle
  std::vector<Material> materials = {};                ///< at least one
  std::vector<Light> lights = {};
  std::optional<Camera> camera = std::nullopt;  ///< none: the renderer frames the bounding box
  glm::vec3 background{0.0F};                   ///< colour of rays that leave the scene
  glm::vec3 ambient_light{1.0F};                ///< times Material::ambient
  std::vector<std::string> warnings = {};  ///< what a loader left out (textures, lines, points)
};

}  // namespace gridrt
