#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "host/render/waves.hpp"
#include "render_support.hpp"

namespace gridrt {
namespace {

using test::BruteScene;
using test::SceneMaker;

RenderOptions picture(int width, int height, int depth = 0) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.depth = depth;
  options.threads = 2;
  return options;
}

// A unit sphere of quads with exact vertex normals.
Scene sphere(int around, int along, const Material& material) {
  SceneMaker maker;
  maker.scene.materials[0] = material;
  const auto point = [&](int i, int k) {
    const double phi = 2.0 * std::numbers::pi * (i % around) / around;
    const double theta = std::numbers::pi * k / along;
    return glm::vec3(glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                std::cos(theta)));
  };
  for (int k = 0; k < along; ++k) {
    for (int i = 0; i < around; ++i) {
      if (k > 0) maker.triangle(point(i, k), point(i, k + 1), point(i + 1, k));
      if (k + 1 < along) maker.triangle(point(i + 1, k), point(i, k + 1), point(i + 1, k + 1));
    }
  }
  maker.scene.normals = maker.scene.positions;
  for (std::uint32_t i = 0; i < maker.scene.triangles.size(); ++i) {
    maker.scene.triangle_normals.push_back(maker.scene.triangles[i]);
  }
  return maker.scene;
}

TEST(Waves, ADiffuseSphereIsAsBrightAsItsCosine) {
  Material material = test::black();
  material.diffuse = glm::vec3(1.0F);
  BruteScene setup(sphere(64, 32, material));
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.direction = {0.0, 0.0, -1.0};
  setup.scene.lights = {sun};
  Camera camera;
  camera.eye = {0.0, 0.0, 4.0};
  camera.fov_degrees = 30.0;
  const int side = 40;
  const Film film = setup.render_film(camera, picture(side, side));
  const PinholeCamera pinhole = PinholeCamera::create(camera, side, side).value();
  int compared = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Ray ray = pinhole.ray(x, y, {0.5, 0.5});
      const double b = glm::dot(ray.origin, ray.direction);
      const double under = (b * b) - glm::dot(ray.origin, ray.origin) + 1.0;
      if (under < 0.02) continue;  // beside the sphere, or where its outline is a polygon
      const double z = (ray.origin + (ray.direction * (-b - std::sqrt(under)))).z;
      if (z < 0.1) continue;  // shadows of a polygonal sphere begin before those of a round one
      ++compared;
      EXPECT_NEAR(film.at(x, y).x, z, 0.01) << x << "," << y;
    }
  }
  EXPECT_GT(compared, 500);
}

// A floor at z = 0 and a roof at z = 1 over x < 0; the light stands at (1, 0, 2), so the roof's
// shadow ends at x = -1.
TEST(Waves, AShadowEndsWhereTheLightPassesTheEdge) {
  SceneMaker maker;
  maker.scene.materials[0] = test::black();
  maker.scene.materials[0].diffuse = glm::vec3(1.0F);
  maker.quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0});
  maker.quad({-8, -8, 1}, {0, -8, 1}, {0, 8, 1}, {-8, 8, 1});
  Light lamp;
  lamp.position = {1.0, 0.0, 2.0};
  maker.scene.lights = {lamp};
  BruteScene setup(maker.scene);
  Camera camera;
  camera.eye = {-1.0, 0.0, 0.9};
  camera.look = {-1.0, 0.0, 0.0};
  camera.fov_degrees = 90.0;
  const Film film = setup.render_film(camera, picture(64, 64));
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      EXPECT_EQ(film.at(x, y).x > 0.0F, x >= 32) << x << "," << y;
    }
  }
  EXPECT_EQ(setup.report.primary, 4096U);
  EXPECT_EQ(setup.report.shadow, 4096U);
}

TEST(Waves, AShadowRayEndsAtItsLight) {
  SceneMaker maker;
  maker.scene.materials[0] = test::black();
  maker.scene.materials[0].diffuse = glm::vec3(1.0F);
  maker.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  maker.quad({-9, -9, 3}, {9, -9, 3}, {9, 9, 3}, {-9, 9, 3});  // above the light
  Light lamp;
  lamp.position = {0.0, 0.0, 2.0};
  maker.scene.lights = {lamp};
  BruteScene setup(maker.scene);
  Camera camera;
  camera.eye = {0.0, 0.0, 1.0};
  camera.fov_degrees = 60.0;
  const Film film = setup.render_film(camera, picture(8, 8));
  for (const glm::vec3& pixel : film.pixels) EXPECT_GT(pixel.x, 0.5F);
}

TEST(Waves, ASealedMirroredBoxIsLeftByNoRay) {
  SceneMaker maker;
  maker.scene.materials[0] = test::black();
  maker.scene.materials[0].mirror = glm::vec3(1.0F);
  maker.scene.materials[0].emission = glm::vec3(0.125F);
  maker.scene.background = glm::vec3(1000.0F);
  maker.box({-1.1F, -0.9F, -1.3F}, {1.0F, 1.2F, 0.7F});
  BruteScene setup(maker.scene);
  Camera camera;
  camera.eye = {0.1, 0.2, 0.3};
  camera.look = {-0.5, -0.3, -0.7};
  const int depth = 32;
  const Film film = setup.render_film(camera, picture(24, 24, depth));
  for (const glm::vec3& pixel : film.pixels) EXPECT_EQ(pixel.x, 0.125F * (depth + 1));
  EXPECT_EQ(setup.report.primary, 576U);
  EXPECT_EQ(setup.report.mirror, 576U * depth);
  EXPECT_EQ(setup.report.refraction, 0U);
  EXPECT_EQ(setup.report.shadow, 0U);
  EXPECT_EQ(setup.report.outside, 0U);
  EXPECT_EQ(setup.report.deepest, depth);
}

// A red mirror faces a green one: nothing that comes back by way of both can be seen.
TEST(Waves, NoRayIsSentThatCannotBeSeen) {
  SceneMaker maker;
  maker.scene.materials[0] = test::black();
  maker.scene.materials.push_back(test::black());
  maker.scene.materials[0].mirror = {1.0F, 0.0F, 0.0F};
  maker.scene.materials[1].mirror = {0.0F, 1.0F, 0.0F};
  maker.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}, 0);
  maker.quad({-9, -9, 3}, {9, -9, 3}, {9, 9, 3}, {-9, 9, 3}, 1);
  BruteScene setup(maker.scene);
  Camera camera;
  camera.eye = {0.0, 0.0, 2.0};
  setup.render_film(camera, picture(4, 4, 9));
  EXPECT_EQ(setup.report.primary, 16U);
  EXPECT_EQ(setup.report.mirror, 16U);
}

TEST(Waves, SecondaryRaysIgnoreTheTriangleThatTheyLeave) {
  SceneMaker maker;
  maker.scene.materials[0].mirror = glm::vec3(0.5F);
  maker.triangle({-9, -9, 0}, {9, -9, 0}, {0, 9, 0});
  Light lamp;
  lamp.position = {0.0, 0.0, 4.0};
  maker.scene.lights = {lamp};
  const BruteScene setup(maker.scene);
  const PinholeCamera camera = PinholeCamera::create({}, 1, 1).value();
  test::BruteDevice device(setup.triangles);
  RenderReport report;
  ASSERT_TRUE(render({setup.scene, setup.lattice, setup.triangles, camera}, picture(1, 1, 1),
                     device, report)
                  .has_value());
  ASSERT_EQ(device.asked.size(), 3U);  // primary, shadow, mirror
  EXPECT_EQ(device.asked[0].ignore, kNoTriangle);
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    EXPECT_EQ(device.asked[i].ignore, 0U);
    EXPECT_EQ(device.asked[i].t0, 0.0);
  }
}

// A slab met at right angles: each face reflects F = 0.04 of what meets it. Depth 0 shows nothing,
// depth 1 the front's reflection F, depth 2 also (1 - F)^2 through the back; in the end all light.
TEST(Waves, AGlassSlabPassesOnAllLight) {
  SceneMaker maker;
  maker.scene.materials[0] = test::black();
  maker.scene.materials[0].transmission = glm::vec3(1.0F);
  maker.scene.background = glm::vec3(1.0F);
  maker.box({-1, -1, -1}, {1, 1, 1});
  BruteScene setup(maker.scene);
  Camera camera;
  const auto brightness = [&](int depth) {
    return setup.render_film(camera, picture(1, 1, depth)).pixels[0].x;
  };
  const float f = 0.04F;
  EXPECT_EQ(brightness(0), 0.0F);
  EXPECT_EQ(setup.report.total(), 1U);
  EXPECT_NEAR(brightness(1), f, 1e-6);
  EXPECT_EQ(setup.report.mirror, 1U);
  EXPECT_EQ(setup.report.refraction, 1U);
  EXPECT_NEAR(brightness(2), f + ((1 - f) * (1 - f)), 1e-6);
  EXPECT_EQ(setup.report.mirror, 2U);
  EXPECT_EQ(setup.report.refraction, 2U);
  EXPECT_NEAR(brightness(3), f + ((1 - f) * (1 - f)) + ((1 - f) * f * (1 - f)), 1e-6);
  EXPECT_NEAR(brightness(12), 1.0F, 1e-6);
}

TEST(Waves, AScenePaysOnlyForWhatItHas) {
  SceneMaker maker;
  maker.box({-1, -1, -1}, {1, 1, 1});
  BruteScene setup(maker.scene);
  Camera camera;
  setup.render_film(camera, picture(8, 8, 5));
  EXPECT_EQ(setup.report.total(), 64U);
  EXPECT_EQ(setup.report.primary, 64U);
  Light behind;
  behind.position = {0.0, 0.0, -9.0};
  setup.scene.lights = {behind};
  setup.render_film(camera, picture(8, 8, 5));
  EXPECT_EQ(setup.report.shadow, 0U);
  Light before;
  before.position = {0.0, 0.0, 9.0};
  setup.scene.lights = {behind, before, before};
  const Film film = setup.render_film(camera, picture(8, 8, 5));
  std::uint64_t hits = 0;
  for (const glm::vec3& pixel : film.pixels) hits += pixel.x > 0.0F ? 1U : 0U;
  EXPECT_GT(hits, 0U);
  EXPECT_EQ(setup.report.shadow, 2 * hits);
  EXPECT_EQ(setup.report.mirror + setup.report.refraction, 0U);
}

TEST(Waves, LampsNeitherLeakIntoARoomNorFailWithinIt) {
  for (const bool inside : {false, true}) {
    SceneMaker maker;
    maker.scene.materials[0] = test::black();
    maker.scene.materials[0].diffuse = glm::vec3(1.0F);
    maker.box({-1.1F, -0.9F, -1.3F}, {1.0F, 1.2F, 0.7F});
    Light lamp;
    lamp.position = inside ? glm::dvec3(0.5, 0.5, 0.25) : glm::dvec3(3.0, 4.0, 5.0);
    maker.scene.lights = {lamp};
    BruteScene setup(maker.scene);
    Camera camera;
    camera.eye = {0.1, 0.2, 0.3};
    camera.look = {-0.5, -0.3, -0.7};
    camera.fov_degrees = 120.0;
    const Film film = setup.render_film(camera, picture(48, 48));
    for (const glm::vec3& pixel : film.pixels) EXPECT_EQ(pixel.x > 0.0F, inside);
  }
}

// A sphere of which every third triangle is a mirror and the rest is glass, under two lamps.
BruteScene mixed_scene() {
  Material glass = test::black();
  glass.transmission = glm::vec3(0.9F);
  Scene scene = sphere(10, 6, glass);
  Material mirror = test::black();
  mirror.mirror = {0.9F, 0.8F, 0.7F};
  mirror.specular = glm::vec3(0.5F);
  scene.materials.push_back(mirror);
  for (std::size_t i = 0; i < scene.triangles.size(); i += 3) scene.triangle_materials[i] = 1;
  scene.background = {0.2F, 0.3F, 0.5F};
  Light lamp;
  lamp.position = {2.0, 3.0, 4.0};
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.direction = {0.3, -1.0, -0.2};
  scene.lights = {lamp, sun};
  return BruteScene(std::move(scene));
}

TEST(Waves, NeitherThreadsNorWaveSizesChangeABit) {
  BruteScene setup = mixed_scene();
  Camera camera;
  camera.eye = {0.0, 1.0, 3.0};
  RenderOptions options = picture(20, 15, 6);
  options.samples = 3;
  const Film expected = setup.render_film(camera, options);
  const std::uint64_t rays = setup.report.total();
  EXPECT_GT(setup.report.refraction, 100U);
  EXPECT_GT(setup.report.mirror, 100U);
  for (const std::size_t wave : {std::size_t{1}, std::size_t{7}, std::size_t{100}}) {
    for (const int threads : {1, 3}) {
      options.wave_rays = wave;
      options.threads = threads;
      const Film film = setup.render_film(camera, options);
      EXPECT_TRUE(film.pixels == expected.pixels) << wave << " " << threads;
      EXPECT_EQ(setup.report.total(), rays);
    }
  }
}

TEST(Waves, APixelIsTheMeanOfItsSamples) {
  SceneMaker maker;  // a wall over the left half of the only pixel
  maker.scene.materials[0] = test::black();
  maker.scene.materials[0].emission = glm::vec3(1.0F);
  maker.quad({-9, -9, 0}, {0, -9, 0}, {0, 9, 0}, {-9, 9, 0});
  BruteScene setup(maker.scene);
  RenderOptions options = picture(1, 1);
  options.samples = 8;
  EXPECT_EQ(setup.render_film({}, options).pixels[0].x, 0.5F);
  EXPECT_EQ(setup.report.primary, 8U);
}

TEST(Waves, ThePrimarySinkHearsEveryRayInOrder) {
  BruteScene setup = mixed_scene();
  RenderOptions options = picture(9, 7);
  options.samples = 2;
  options.wave_rays = 10;
  const PinholeCamera camera = PinholeCamera::create({}, 9, 7).value();
  test::BruteDevice device(setup.triangles);
  std::vector<Ray> heard;
  const PrimarySink sink = [&](std::span<const Ray> rays, std::span<const Segment> segments,
                               std::span<const Hit> hits) -> Result<void> {
    EXPECT_EQ(rays.size(), segments.size());
    EXPECT_EQ(rays.size(), hits.size());
    heard.insert(heard.end(), rays.begin(), rays.end());
    return {};
  };
  std::uint64_t last = 0;
  const ProgressSink progress = [&](std::uint64_t done, std::uint64_t total) {
    EXPECT_GT(done, last);
    EXPECT_EQ(total, 126U);
    last = done;
  };
  RenderReport report;
  ASSERT_TRUE(render({setup.scene, setup.lattice, setup.triangles, camera}, options, device, report,
                     sink, progress)
                  .has_value());
  EXPECT_EQ(last, 126U);
  ASSERT_EQ(heard.size(), 126U);
  for (int i = 0; i < 126; ++i) {
    const Ray ray = camera.ray((i / 2) % 9, i / 18, sample_position(i % 2, 2));
    EXPECT_EQ(heard[static_cast<std::size_t>(i)].direction, ray.direction);
  }
}

TEST(Waves, ADeviceThatAnswersNonsenseIsAnError) {
  BruteScene setup = mixed_scene();
  const PinholeCamera camera = PinholeCamera::create({}, 4, 4).value();
  test::BruteDevice device(setup.triangles);
  RenderReport report;
  for (const std::int32_t id : {-2, 1 << 30}) {
    device.broken_id = id;
    const auto film = render({setup.scene, setup.lattice, setup.triangles, camera}, picture(4, 4),
                             device, report);
    ASSERT_FALSE(film.has_value());
    EXPECT_EQ(film.error().kind, ErrorKind::kDevice);
  }
}

TEST(Waves, AnExplosionOfRaysIsAnErrorAndNoHang) {
  SceneMaker maker;
  maker.scene.materials[0].transmission = glm::vec3(0.5F);
  maker.scene.materials[0].mirror = glm::vec3(0.5F);
  maker.scene.materials[0].ior = 1.0F;
  maker.box({-1, -1, -1}, {1, 1, 1});
  maker.box({-2, -2, -2}, {2, 2, 2});
  BruteScene setup(maker.scene);
  RenderOptions options = picture(2, 2, 100);
  options.sample_rays = 16;
  options.wave_rays = 8;
  Camera camera;
  camera.eye = {0.0, 0.0, 0.5};
  const PinholeCamera pinhole = PinholeCamera::create(camera, 2, 2).value();
  test::BruteDevice device(setup.triangles);
  RenderReport report;
  const auto film =
      render({setup.scene, setup.lattice, setup.triangles, pinhole}, options, device, report);
  ASSERT_FALSE(film.has_value());
  EXPECT_EQ(film.error().kind, ErrorKind::kLimit);
}

TEST(Waves, RefusesOptionsOutOfRange) {
  BruteScene setup = mixed_scene();
  const PinholeCamera camera = PinholeCamera::create({}, 4, 4).value();
  test::BruteDevice device(setup.triangles);
  RenderReport report;
  const auto kind = [&](const RenderOptions& options) {
    const auto film =
        render({setup.scene, setup.lattice, setup.triangles, camera}, options, device, report);
    return film.has_value() ? ErrorKind::kInternal : film.error().kind;
  };
  EXPECT_EQ(kind(picture(0, 4)), ErrorKind::kUsage);
  EXPECT_EQ(kind(picture(65535, 65535)), ErrorKind::kUsage);
  EXPECT_EQ(kind(picture(4, 4, -1)), ErrorKind::kUsage);
  RenderOptions options = picture(4, 4);
  options.samples = 0;
  EXPECT_EQ(kind(options), ErrorKind::kUsage);
}

}  // namespace
}  // namespace gridrt
