// The Scene section: everything comes back, and nothing wrong comes through.
#include <functional>
#include <limits>

#include "host/image/scene_section.hpp"
#include "image_support.hpp"

namespace gridrt {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A scene that uses every field.
Scene full_scene() {
  std::mt19937 random(1);
  Scene s = random_scene(12, 1);
  s.triangle_normals.assign(s.triangles.size(), {kNoIndex, kNoIndex, kNoIndex});
  s.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  s.triangle_normals[5] = {0, 2, 1};
  for (int i = 0; i < 3; ++i) {
    Material m;
    m.name = i == 0 ? "" : std::string(static_cast<std::size_t>(7 * i), 'n');
    for (glm::vec3* v :
         {&m.ambient, &m.diffuse, &m.specular, &m.mirror, &m.transmission, &m.emission}) {
      *v = random_point(random);
    }
    m.shininess = 10.0F * unit(random);
    m.ior = 1.0F + unit(random);
    s.materials.push_back(m);
  }
  s.triangle_materials[3] = 2;
  s.lights.push_back({Light::Kind::kPoint, {1, 2, 3}, {4, 5, 6}, {0.1F, 0.2F, 0.3F}});
  s.lights.push_back({Light::Kind::kDirectional, {7, 8, 9}, {0.1, -1, 1e-300}, {1, 0.5F, 0}});
  s.camera = Camera{{1, 2, 3}, {4, 5, 6}, {0, 1, 0.5}, 33.25};
  s.background = {0.1F, 0.2F, 0.3F};
  s.ambient_light = {0.4F, 0.5F, 0.6F};
  return s;
}

void expect_equal(const Material& a, const Material& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.ambient, b.ambient);
  EXPECT_EQ(a.diffuse, b.diffuse);
  EXPECT_EQ(a.specular, b.specular);
  EXPECT_EQ(a.shininess, b.shininess);
  EXPECT_EQ(a.mirror, b.mirror);
  EXPECT_EQ(a.transmission, b.transmission);
  EXPECT_EQ(a.ior, b.ior);
  EXPECT_EQ(a.emission, b.emission);
}

void expect_equal(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.triangle_normals, b.triangle_normals);
  EXPECT_EQ(a.triangle_materials, b.triangle_materials);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) expect_equal(a.materials[i], b.materials[i]);
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].kind, b.lights[i].kind);
    EXPECT_EQ(a.lights[i].position, b.lights[i].position);
    EXPECT_EQ(a.lights[i].direction, b.lights[i].direction);
    EXPECT_EQ(a.lights[i].colour, b.lights[i].colour);
  }
  ASSERT_EQ(a.camera.has_value(), b.camera.has_value());
  if (a.camera) {
    EXPECT_EQ(a.camera->eye, b.camera->eye);
    EXPECT_EQ(a.camera->look, b.camera->look);
    EXPECT_EQ(a.camera->up, b.camera->up);
    EXPECT_EQ(a.camera->fov_degrees, b.camera->fov_degrees);
  }
  EXPECT_EQ(a.background, b.background);
  EXPECT_EQ(a.ambient_light, b.ambient_light);
}

TEST(SceneSection, EverythingComesBack) {
  Scene scene = full_scene();
  for (int round = 0; round < 2; ++round) {
    const auto bytes = pack_scene(scene);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto again = unpack_scene(*bytes);
    ASSERT_TRUE(again) << again.error().message;
    expect_equal(*again, scene);
    EXPECT_EQ(*pack_scene(*again), *bytes);
    scene.camera.reset();
    scene.triangle_normals.clear();
    scene.lights.clear();
  }
}

TEST(SceneSection, ComesBackThroughAnImage) {
  const Scene scene = full_scene();
  const auto again = decode_scene(must_build(scene));
  ASSERT_TRUE(again) << again.error().message;
  expect_equal(*again, scene);
}

TEST(SceneSection, AnImageWithoutOneGivesTheLatticesTriangles) {
  const Scene scene = random_scene(30, 3);
  ImageOptions options;
  options.with_scene = false;
  const Image image = must_build(scene, options);
  EXPECT_EQ(image.find(protocol::SectionKind::kScene), nullptr);
  const auto again = decode_scene(image);
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_EQ(again->triangles.size(), scene.triangles.size());
  ASSERT_EQ(again->materials.size(), 1U);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (i % 7 == 3) continue;  // degenerate
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec3 a = scene.positions[scene.triangles[i][c]];
      const glm::vec3 b = again->positions[again->triangles[i][c]];
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 0x1p-16F) << i;
    }
  }
  EXPECT_TRUE(pack_scene(*again));
}

TEST(SceneSection, EveryTruncationIsFound) {
  const std::vector<std::byte> bytes = *pack_scene(full_scene());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto scene = unpack_scene(std::span(bytes).first(size));
    ASSERT_FALSE(scene) << size;
    EXPECT_EQ(scene.error().kind, ErrorKind::kInput);
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(unpack_scene(longer));
}

TEST(SceneSection, AnyBytesGiveAValidSceneOrAnError) {
  std::vector<std::byte> bytes = *pack_scene(full_scene());
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1U << (bit % 8));
    bytes[bit / 8] ^= mask;
    const auto scene = unpack_scene(bytes);
    if (!scene) ++refused;
    if (scene) {
      ASSERT_EQ(*pack_scene(*scene), bytes) << "bit " << bit << " is read, but not kept";
    }
    bytes[bit / 8] ^= mask;
  }
  EXPECT_GT(refused, 1000U);
}

TEST(SceneSection, WrongScenesAreRefusedBothWays) {
  const std::vector<std::pair<std::function<void(Scene&)>, std::string>> wrong{
      {[](Scene& s) { s.positions[4].x = kNan; }, "vertex 4"},
      {[](Scene& s) { s.normals[1].z = kNan; }, "normal 1"},
      {[](Scene& s) { s.triangles[6][2] = 36; }, "triangle 6: vertex 36 of 36"},
      {[](Scene& s) { s.triangle_materials[2] = 4; }, "triangle 2: material 4 of 4"},
      {[](Scene& s) { s.triangle_materials.pop_back(); }, "12 triangles, but 11"},
      {[](Scene& s) { s.triangle_normals.pop_back(); }, "12 triangles, but 11"},
      {[](Scene& s) { s.triangle_normals[5][1] = 3; }, "triangle 5: normals 0, 3, 1 of 3"},
      {[](Scene& s) { s.triangle_normals[5][1] = kNoIndex; }, "triangle 5: normals"},
      {[](Scene& s) { s.materials.clear(); }, "no material"},
      {[](Scene& s) { s.materials[1].mirror.y = kNan; }, "material 1: a colour"},
      {[](Scene& s) { s.materials[2].ior = 0.0F; }, "material 2: index of refraction 0"},
      {[](Scene& s) { s.materials[2].ior = kNan; }, "material 2: index of refraction"},
      {[](Scene& s) { s.materials[3].shininess = -1.0F; }, "material 3: shininess -1"},
      {[](Scene& s) { s.lights[1].colour.x = kNan; }, "light 1"},
      {[](Scene& s) { s.camera->fov_degrees = 180.0; }, "camera: field of view 180"},
      {[](Scene& s) { s.camera->eye.x = kNan; }, "camera: a number"},
      {[](Scene& s) { s.background.x = kNan; }, "background"},
  };
  for (const auto& [change, message] : wrong) {
    Scene scene = full_scene();
    change(scene);
    const auto packed = pack_scene(scene);
    ASSERT_FALSE(packed) << message;
    EXPECT_EQ(packed.error().kind, ErrorKind::kInput);
    EXPECT_NE(packed.error().message.find(message), std::string::npos) << packed.error().message;
  }
}

TEST(SceneSection, OtherVersionIsNamed) {
  std::vector<std::byte> bytes = *pack_scene(full_scene());
  bytes[0] = std::byte{2};
  const auto scene = unpack_scene(bytes);
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("version 2, not 1"), std::string::npos);
}

}  // namespace
}  // namespace gridrt
