// The last check of every reader finds whatever a reader might let through.
#include <limits>

#include "host/scene/assemble.hpp"
#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

using scene_detail::check_scene;

void expect_found(const Scene& scene, const std::string& part) {
  const auto checked = check_scene(scene, "mesh");
  ASSERT_FALSE(checked.has_value()) << part;
  EXPECT_NE(checked.error().message.find("mesh: "), std::string::npos);
  EXPECT_NE(checked.error().message.find(part), std::string::npos) << checked.error().message;
}

// A sound scene with one thing changed.
template <class Change>
void expect_found(Change change, const std::string& part) {
  Scene scene = builtin("whitted?subdivisions=0");
  ASSERT_TRUE(check_scene(scene, "mesh").has_value());
  change(scene);
  expect_found(scene, part);
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(SceneCheck, FindsBadGeometry) {
  expect_found([](Scene& s) { s.positions[5].y = kNan; }, "vertex 5");
  expect_found([](Scene& s) { s.normals[2] = glm::vec3(0); }, "normal 2");
  expect_found([](Scene& s) { s.normals[2] = glm::vec3(0, kNan, 1); }, "normal 2");
  expect_found([](Scene& s) { s.normals[2] = glm::vec3(0, 1.01F, 0); }, "normal 2");
  expect_found([](Scene& s) { s.triangles[7][1] = 1'000'000; }, "triangle 7 uses vertex 1000000");
  expect_found([](Scene& s) { s.triangle_normals.back()[2] = 1'000'000; }, "uses normal 1000000");
  expect_found([](Scene& s) { s.triangle_normals.pop_back(); }, "do not match");
  expect_found([](Scene& s) { s.triangle_materials.pop_back(); }, "do not match");
  expect_found([](Scene& s) { s.triangle_materials[3] = 4; }, "triangle 3 uses material 4 of 4");
}

TEST(SceneCheck, FindsBadMaterials) {
  expect_found([](Scene& s) { s.materials[1].diffuse.x = 1.5F; }, "material 'red'");
  expect_found([](Scene& s) { s.materials[1].mirror.z = -0.5F; }, "material 'red'");
  expect_found([](Scene& s) { s.materials[1].emission.z = kNan; }, "material 'red'");
  expect_found([](Scene& s) { s.materials[1].ior = 0.0F; }, "material 'red'");
  expect_found([](Scene& s) { s.materials[1].shininess = -1.0F; }, "material 'red'");
  Scene bare;
  expect_found(bare, "no material");
}

TEST(SceneCheck, FindsBadLightsAndCameras) {
  expect_found([](Scene& s) { s.lights[0].position.x = kInf; }, "light 0");
  expect_found([](Scene& s) { s.lights[0].colour.x = -1.0F; }, "light 0");
  expect_found(
      [](Scene& s) {
        s.lights[0].kind = Light::Kind::kDirectional;
        s.lights[0].direction = glm::dvec3(0);
      },
      "light 0");
  expect_found([](Scene& s) { s.background.y = kNan; }, "background");
  expect_found([](Scene& s) { s.ambient_light.y = -1.0F; }, "ambient");
  expect_found([](Scene& s) { s.camera->eye.y = kInf; }, "camera");
  expect_found([](Scene& s) { s.camera->fov_degrees = 180.0; }, "180");
  expect_found([](Scene& s) { s.camera->look = s.camera->eye; }, "own eye");
}

}  // namespace
}  // namespace gridrt::scene_test
