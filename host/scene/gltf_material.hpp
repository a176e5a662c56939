// glTF's materials and lights in terms of Phong and Whitted.
#pragma once

#include <glm/mat4x4.hpp>

#include "host/scene/gltf_document.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::scene_detail {

/// The Phong material nearest to a glTF material's factors (textures are not read). With base
/// colour c, metalness m, roughness r and transmission t: diffuse c (1 - m)(1 - t), specular a
/// blend of 0.5 (1 - r) and c by m, exponent 2 / r^4 - 2 in [1, 10^4], mirror c m (1 - r)^2 below
/// r = 0.5, transmission c t (1 - m). Alpha below 1 in a blended material lets 1 - alpha through
/// unbent.
Material gltf_material(const JsonNode& node);

/// True if any member of the material refers to a texture.
bool gltf_has_texture(const JsonNode& material);

/// A punctual light under the transform of its node; its colour still has glTF's units (candela or
/// lux). A spot light becomes a point light.
Light gltf_light(const JsonNode& node, const glm::dmat4& transform);

/// Scales all lights by one factor so that the brightest gives 1 at `centre` (glTF's intensities
/// fall off with distance, a Light's do not).
void normalise_gltf_lights(std::vector<Light>& lights, const glm::dvec3& centre);

}  // namespace gridrt::scene_detail
