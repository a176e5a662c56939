// Materials and lamps of the built-in scenes.
#pragma once

#include <glm/vec3.hpp>

#include "host/scene/scene.hpp"

namespace gridrt::scene_detail {

/// A surface without gloss.
Material matte(const char* name, const glm::vec3& colour);
/// A surface with a highlight that mirrors a share of what is around it.
Material glossy(const char* name, const glm::vec3& colour, float mirror);
/// A mirror that tints what it shows.
Material mirror_of(const glm::vec3& tint);
/// Clear glass.
Material glass_of(float ior);
/// A white point light.
Light lamp(const glm::dvec3& position, float intensity);

}  // namespace gridrt::scene_detail
