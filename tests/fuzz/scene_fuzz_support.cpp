#include "scene_fuzz_support.hpp"

#include <cmath>
#include <cstdlib>

namespace gridrt::scene_fuzz {
namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

template <class V>
bool finite(const V& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Written down again here, so that a reader and the library's own last check cannot be wrong alike.
void require_sound(const Scene& scene) {
  const std::size_t count = scene.triangles.size();
  require(!scene.materials.empty());
  require(scene.triangle_materials.size() == count);
  require(scene.triangle_normals.empty() || scene.triangle_normals.size() == count);
  for (const auto& position : scene.positions) {
    require(finite(position));
  }
  for (const auto& n : scene.normals) {
    require(std::abs(std::hypot(n.x, n.y, n.z) - 1.0F) < 1e-4F);
  }
  for (std::size_t i = 0; i < count; ++i) {
    require(scene.triangle_materials[i] < scene.materials.size());
    std::size_t flat = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      require(scene.triangles[i][k] < scene.positions.size());
      const std::uint32_t n =
          scene.triangle_normals.empty() ? kNoIndex : scene.triangle_normals[i][k];
      require(n == kNoIndex || n < scene.normals.size());
      flat += n == kNoIndex ? 1U : 0U;
    }
    require(flat == 0 || flat == 3);
  }
  for (const Material& m : scene.materials) {
    for (const glm::vec3& c : {m.ambient, m.diffuse, m.specular, m.mirror, m.transmission}) {
      for (int i = 0; i < 3; ++i) {
        require(c[i] >= 0.0F && c[i] <= 1.0F);
      }
    }
    require(finite(m.emission) && std::isfinite(m.shininess) && m.shininess >= 0.0F);
    require(std::isfinite(m.ior) && m.ior > 0.0F);
  }
  for (const Light& light : scene.lights) {
    require(finite(light.position) && finite(light.direction) && finite(light.colour));
    require(light.colour.x >= 0 && light.colour.y >= 0 && light.colour.z >= 0);
  }
  if (scene.camera) {
    require(finite(scene.camera->eye) && finite(scene.camera->look) && finite(scene.camera->up));
    require(scene.camera->fov_degrees > 0.0 && scene.camera->fov_degrees < 180.0);
  }
}

void judge(const Result<Scene>& scene) {
  if (scene) {
    require_sound(*scene);
    return;
  }
  require(scene.error().kind != ErrorKind::kInternal);
  require(scene.error().message.find("mesh") != std::string::npos);
  require(scene.error().message.size() < 2000);
}

}  // namespace

void read_with(SceneFormat format, std::string_view bytes, const std::string& name,
               std::string_view side) {
  judge(load_scene_from_memory(format, bytes, "mesh",
                               [&](const std::string& wanted) -> Result<std::string> {
                                 if (wanted == name) {
                                   return std::string(side);
                                 }
                                 return fail(ErrorKind::kFile, "mesh: no such side file");
                               }));
}

void read(SceneFormat format, std::string_view bytes) { read_with(format, bytes, "", ""); }

}  // namespace gridrt::scene_fuzz
