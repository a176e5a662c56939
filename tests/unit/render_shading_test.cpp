#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "host/render/shading.hpp"
#include "render_support.hpp"

namespace gridrt {
namespace {

// A surface in the plane z = 0, seen from above.
Surface flat(const Material& material) {
  Surface surface;
  surface.geometric = {0.0, 0.0, 1.0};
  surface.normal = {0.0, 0.0, 1.0};
  surface.material = &material;
  return surface;
}

const glm::dvec3 kDown(0.0, 0.0, -1.0);

void expect_colour(const glm::dvec3& colour, double r, double g, double b) {
  EXPECT_NEAR(colour.x, r, 1e-6);
  EXPECT_NEAR(colour.y, g, 1e-6);
  EXPECT_NEAR(colour.z, b, 1e-6);
}

TEST(Shading, UnlitPartIsEmissionAndAmbient) {
  Material material = test::black();
  material.emission = {0.25F, 0.0F, 0.0F};
  material.ambient = {0.5F, 0.5F, 0.0F};
  expect_colour(unlit_part(flat(material), {0.5F, 1.0F, 1.0F}), 0.5, 0.5, 0.0);
}

TEST(Shading, DiffusePartFollowsTheCosine) {
  Material material = test::black();
  material.diffuse = {1.0F, 0.5F, 0.0F};
  const glm::dvec3 to_light(std::sqrt(0.75), 0.0, 0.5);  // 60 degrees from the normal
  expect_colour(lit_part(flat(material), kDown, to_light, {1.0F, 1.0F, 1.0F}), 0.5, 0.25, 0.0);
}

TEST(Shading, HighlightIsAPowerOfTheCosineToTheMirrorImage) {
  Material material = test::black();
  material.specular = glm::vec3(1.0F);
  material.shininess = 4.0F;
  // Seen from straight above, the mirror image is straight above; the light is 60 degrees off.
  const glm::dvec3 to_light(std::sqrt(0.75), 0.0, 0.5);
  expect_colour(lit_part(flat(material), kDown, to_light, glm::vec3(2.0F)), 0.125, 0.125, 0.125);
}

TEST(Shading, LightBehindTheTriangleAsksForNoShadowRay) {
  Material material;
  Light light;
  light.position = {0.0, 0.0, -1.0};
  EXPECT_FALSE(sample_light(flat(material), kDown, light).has_value());
  light.kind = Light::Kind::kDirectional;
  light.direction = {0.0, 0.0, 1.0};
  EXPECT_FALSE(sample_light(flat(material), kDown, light).has_value());
}

TEST(Shading, LightBehindTheTriangleButNotBehindTheShadingNormalAddsNothing) {
  Material material;
  Surface surface = flat(material);
  surface.normal = glm::normalize(glm::dvec3(1.0, 0.0, 0.2));
  Light light;
  light.position = {1.0, 0.0, -0.01};
  EXPECT_FALSE(sample_light(surface, kDown, light).has_value());
}

TEST(Shading, LightOnTheSurfaceOrWithoutEffectAsksForNoShadowRay) {
  Material material;
  Light light;
  light.position = glm::dvec3(0.0);
  EXPECT_FALSE(sample_light(flat(material), kDown, light).has_value());
  light.position = {0.0, 0.0, 1.0};
  light.colour = glm::vec3(0.0F);
  EXPECT_FALSE(sample_light(flat(material), kDown, light).has_value());
  light.colour = glm::vec3(1.0F);
  Material dark = test::black();
  EXPECT_FALSE(sample_light(flat(dark), kDown, light).has_value());
}

TEST(Shading, ShadowRaysEndAtAPointLightAndNeverAtADirectionalOne) {
  Material material;
  Surface surface = flat(material);
  surface.point = {1.0, 2.0, 0.0};
  Light point;
  point.position = {3.0, 2.0, 7.0};
  const auto to_point = sample_light(surface, kDown, point);
  ASSERT_TRUE(to_point.has_value());
  EXPECT_EQ(to_point->shadow.origin + to_point->shadow.direction, point.position);
  EXPECT_EQ(to_point->shadow.tmax, 1.0);
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.direction = {0.0, 0.0, -2.0};
  const auto to_sun = sample_light(surface, kDown, sun);
  ASSERT_TRUE(to_sun.has_value());
  EXPECT_EQ(to_sun->shadow.direction, glm::dvec3(0.0, 0.0, 2.0));
  EXPECT_EQ(to_sun->shadow.tmax, std::numeric_limits<double>::infinity());
  expect_colour(to_sun->radiance, 0.7, 0.7, 0.7);
}

TEST(Bounce, OpaqueAndDullSendsNothing) {
  Material material;
  const Bounces bounces = bounce(flat(material), kDown);
  EXPECT_FALSE(bounces.mirror.has_value());
  EXPECT_FALSE(bounces.glass.has_value());
}

TEST(Bounce, GlassSplitsByFresnel) {
  Material material = test::black();
  material.transmission = {1.0F, 0.5F, 0.0F};
  material.mirror = {0.0F, 0.0F, 0.25F};
  const Bounces bounces = bounce(flat(material), kDown);
  ASSERT_TRUE(bounces.mirror && bounces.glass);
  expect_colour(bounces.glass->weight, 0.96, 0.48, 0.0);
  expect_colour(bounces.mirror->weight, 0.04, 0.02, 0.25);
  EXPECT_EQ(bounces.glass->ray.direction, kDown);
  EXPECT_EQ(bounces.mirror->ray.direction, -kDown);
}

TEST(Bounce, TheSideDecidesBetweenEnteringAndLeaving) {
  Material material = test::black();
  material.transmission = glm::vec3(1.0F);
  const glm::dvec3 slanted(0.5, 0.0, -std::sqrt(0.75));
  Surface surface = flat(material);
  EXPECT_NEAR(bounce(surface, slanted).glass->ray.direction.x, 0.5 / 1.5, 1e-14);
  surface.front = false;
  EXPECT_NEAR(bounce(surface, slanted).glass->ray.direction.x, 0.5 * 1.5, 1e-14);
}

TEST(Bounce, TotalReflectionSendsEverythingBack) {
  Material material = test::black();
  material.transmission = {0.5F, 0.75F, 1.0F};
  Surface surface = flat(material);
  surface.front = false;
  const Bounces bounces = bounce(surface, {std::sqrt(0.75), 0.0, -0.5});
  EXPECT_FALSE(bounces.glass.has_value());
  ASSERT_TRUE(bounces.mirror.has_value());
  expect_colour(bounces.mirror->weight, 0.5, 0.75, 1.0);
}

TEST(Bounce, EqualMediaSendNoMirrorRay) {
  Material material = test::black();
  material.transmission = glm::vec3(1.0F);
  material.ior = 1.0F;
  const Bounces bounces = bounce(flat(material), kDown);
  EXPECT_FALSE(bounces.mirror.has_value());
  EXPECT_TRUE(bounces.glass.has_value());
}

TEST(Bounce, NeverGoesThroughTheTriangleBecauseOfItsShadingNormal) {
  Material material = test::black();
  material.mirror = glm::vec3(1.0F);
  material.transmission = glm::vec3(1.0F);
  Surface surface = flat(material);
  for (int i = 0; i < 100; ++i) {
    const double tilt = 1.5 * i / 100.0;
    surface.normal = {std::sin(tilt), 0.0, std::cos(tilt)};
    for (int k = 1; k < 30; ++k) {
      const double angle = 1.57 * k / 30.0;
      for (const double side : {-1.0, 1.0}) {
        for (const bool front : {true, false}) {
          surface.front = front;
          const glm::dvec3 view(side * std::sin(angle), 0.0, -std::cos(angle));
          const Bounces bounces = bounce(surface, view);
          ASSERT_TRUE(bounces.mirror.has_value());
          EXPECT_GT(bounces.mirror->ray.direction.z, 0.0) << tilt << " " << angle;
          if (bounces.glass) {
            EXPECT_LT(bounces.glass->ray.direction.z, 0.0) << tilt << " " << angle;
          }
        }
      }
    }
  }
}

// One triangle seen from both sides, with vertex normals that point the wrong way or nowhere.
TEST(SurfaceTable, NormalsFaceTheRay) {
  for (const glm::vec3 normal :
       {glm::vec3(0.0F, 0.0F, 1.0F), glm::vec3(0.0F, 0.0F, -1.0F), glm::vec3(0.0F)}) {
    test::SceneMaker maker;
    maker.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
    maker.scene.normals = {normal};
    maker.scene.triangle_normals = {{0, 0, 0}};
    const test::BruteScene setup(maker.scene);
    const auto table = SurfaceTable::create(setup.scene, setup.lattice, setup.triangles).value();
    for (const double side : {1.0, -1.0}) {
      Ray ray;
      ray.origin = {1.0, 1.0, side * 5.0};
      ray.direction = {0.0, 0.0, -side};
      const Segment segment = make_segment(setup.lattice, ray);
      test::BruteDevice device(setup.triangles);
      Hit hit;
      ASSERT_TRUE(device.trace({&segment, 1}, Query::kClosestHit, {&hit, 1}).has_value());
      ASSERT_EQ(hit.id, 0);
      const Surface surface = table.at(ray, segment, hit);
      EXPECT_EQ(surface.front, side > 0.0);
      EXPECT_EQ(surface.geometric, glm::dvec3(0.0, 0.0, side));
      EXPECT_EQ(surface.normal, glm::dvec3(0.0, 0.0, side));
      EXPECT_NEAR(surface.point.z, 0.0, 1e-4);
    }
  }
}

TEST(SurfaceTable, InterpolatesVertexNormals) {
  test::SceneMaker maker;
  maker.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  maker.scene.normals = {{0, 0, 1}, {0.6F, 0, 0.8F}, {0, 0.6F, 0.8F}};
  maker.scene.triangle_normals = {{0, 1, 2}};
  const test::BruteScene setup(maker.scene);
  const auto table = SurfaceTable::create(setup.scene, setup.lattice, setup.triangles).value();
  Ray ray;
  ray.origin = {3.0, 0.5, 5.0};
  ray.direction = {0.0, 0.0, -1.0};
  const Segment segment = make_segment(setup.lattice, ray);
  const Surface surface = table.at(ray, segment, {0, 5.0, 0.75, 0.125});
  // 0.125 (0, 0, 1) + 0.75 (0.6, 0, 0.8) + 0.125 (0, 0.6, 0.8), made a unit vector
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0.45, 0.075, 0.825));
  EXPECT_NEAR(glm::length(surface.normal - expected), 0.0, 1e-6);
}

TEST(SurfaceTable, RefusesIndicesOutOfRange) {
  test::SceneMaker maker;
  maker.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 7);
  const test::BruteScene setup(maker.scene);
  const auto table = SurfaceTable::create(setup.scene, setup.lattice, setup.triangles);
  ASSERT_FALSE(table.has_value());
  EXPECT_EQ(table.error().kind, ErrorKind::kInput);
  EXPECT_NE(table.error().message.find("triangle 0 has material 7 of 1"), std::string::npos);
}

}  // namespace
}  // namespace gridrt
