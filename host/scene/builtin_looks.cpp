#include "host/scene/builtin_looks.hpp"

namespace gridrt::scene_detail {

Material matte(const char* name, const glm::vec3& colour) {
  Material m;
  m.name = name;
  m.ambient = colour * 0.15F;
  m.diffuse = colour;
  return m;
}

Material glossy(const char* name, const glm::vec3& colour, float mirror) {
  Material m = matte(name, colour * (1.0F - mirror));
  m.specular = glm::vec3(0.5F);
  m.shininess = 60.0F;
  m.mirror = glm::vec3(mirror);
  return m;
}

Material mirror_of(const glm::vec3& tint) {
  Material m = matte("mirror", tint * 0.05F);
  m.specular = glm::vec3(0.8F);
  m.shininess = 200.0F;
  m.mirror = tint * 0.9F;
  return m;
}

Material glass_of(float ior) {
  Material m = matte("glass", glm::vec3(0.0F));
  m.specular = glm::vec3(0.8F);
  m.shininess = 200.0F;
  m.transmission = glm::vec3(0.9F, 0.95F, 0.92F);
  m.ior = ior;
  return m;
}

Light lamp(const glm::dvec3& position, float intensity) {
  Light light;
  light.position = position;
  light.colour = glm::vec3(intensity);
  return light;
}

}  // namespace gridrt::scene_detail
