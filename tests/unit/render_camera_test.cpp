#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "host/render/camera.hpp"
#include "render_support.hpp"

namespace gridrt {
namespace {

PinholeCamera make(const Camera& camera, int width, int height) {
  return PinholeCamera::create(camera, width, height).value();
}

const glm::dvec2 kCentre(0.5, 0.5);

TEST(Camera, CentralRayLooksAhead) {
  Camera camera;
  camera.eye = {1.0, 2.0, 3.0};
  camera.look = {1.0, 2.0, -4.0};
  const Ray ray = make(camera, 3, 3).ray(1, 1, kCentre);
  EXPECT_EQ(ray.origin, camera.eye);
  EXPECT_NEAR(glm::length(ray.direction - glm::dvec3(0.0, 0.0, -1.0)), 0.0, 1e-15);
  EXPECT_EQ(ray.tmin, 0.0);
  EXPECT_EQ(ray.tmax, std::numeric_limits<double>::infinity());
}

TEST(Camera, RowZeroIsOnTopAndColumnZeroOnTheLeft) {
  Camera camera;  // at z = 5, looking along -z, y up: x is to the right
  const PinholeCamera pinhole = make(camera, 2, 2);
  const Ray top_left = pinhole.ray(0, 0, kCentre);
  EXPECT_LT(top_left.direction.x, 0.0);
  EXPECT_GT(top_left.direction.y, 0.0);
  const Ray bottom_right = pinhole.ray(1, 1, kCentre);
  EXPECT_GT(bottom_right.direction.x, 0.0);
  EXPECT_LT(bottom_right.direction.y, 0.0);
}

TEST(Camera, FieldOfViewIsVerticalAndPixelsAreSquare) {
  Camera camera;
  camera.fov_degrees = 90.0;
  const PinholeCamera pinhole = make(camera, 300, 100);
  // At fov 90 the picture's upper edge is at 45 degrees; 300 columns are three times as wide.
  const Ray top = pinhole.ray(150, 0, {0.0, 0.0});
  EXPECT_NEAR(top.direction.y / -top.direction.z, 1.0, 1e-14);
  const Ray left = pinhole.ray(0, 50, {0.0, 0.0});
  EXPECT_NEAR(left.direction.x / -left.direction.z, -3.0, 1e-14);
}

TEST(Camera, ScalingBySomePowerOfTwoChangesNoDirection) {
  Camera camera;
  camera.eye = {0.3, 1.7, 2.9};
  camera.look = {-0.1, 0.2, 0.05};
  Camera scaled = camera;
  const double factor = std::ldexp(1.0, -43);
  scaled.eye *= factor;
  scaled.look *= factor;
  const PinholeCamera a = make(camera, 64, 48);
  const PinholeCamera b = make(scaled, 64, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const glm::dvec3 da = a.ray(x, y, kCentre).direction;
      const glm::dvec3 db = b.ray(x, y, kCentre).direction;
      ASSERT_EQ(std::memcmp(&da, &db, sizeof(da)), 0) << x << "," << y;
    }
  }
}

TEST(Camera, RefusesWhatHasNoPicture) {
  Camera same;
  same.look = same.eye;
  EXPECT_EQ(PinholeCamera::create(same, 4, 4).error().kind, ErrorKind::kUsage);
  Camera along;
  along.up = {0.0, 0.0, -2.0};
  EXPECT_EQ(PinholeCamera::create(along, 4, 4).error().kind, ErrorKind::kUsage);
  Camera not_finite;
  not_finite.eye.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(PinholeCamera::create(not_finite, 4, 4).error().kind, ErrorKind::kUsage);
  for (const double fov : {0.0, 180.0, -3.0, std::numeric_limits<double>::quiet_NaN()}) {
    Camera camera;
    camera.fov_degrees = fov;
    EXPECT_EQ(PinholeCamera::create(camera, 4, 4).error().kind, ErrorKind::kUsage) << fov;
  }
}

TEST(Camera, HugeCoordinatesDoNotOverflow) {
  Camera camera;
  camera.eye = {1e308, 0.0, 0.0};
  camera.look = {-1e308, 0.0, 0.0};
  const Ray ray = make(camera, 1, 1).ray(0, 0, kCentre);
  EXPECT_NEAR(ray.direction.x, -1.0, 1e-15);
}

TEST(Samples, OneIsTheCentre) { EXPECT_EQ(sample_position(0, 1), glm::dvec2(0.5, 0.5)); }

TEST(Samples, EachRowAndColumnOfThePixelHasOne) {
  for (const int count : {2, 4, 8, 16, 64}) {
    std::set<int> columns;
    std::set<int> rows;
    glm::dvec2 sum(0.0);
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 p = sample_position(i, count);
      columns.insert(static_cast<int>(p.x * count));
      rows.insert(static_cast<int>(p.y * count));
      sum += p;
    }
    EXPECT_EQ(columns.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(count));
    EXPECT_NEAR(sum.x / count, 0.5, 1e-12);
    EXPECT_NEAR(sum.y / count, 0.5, 1e-12);
  }
}

TEST(Samples, OddCountsStayWithinThePixel) {
  for (const int count : {3, 5, 7, 100}) {
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 p = sample_position(i, count);
      EXPECT_TRUE(p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0) << i << " of " << count;
    }
  }
}

// Whether a point projects into the picture, by the camera's definition.
bool in_view(const Camera& camera, double aspect, const glm::dvec3& point) {
  const glm::dvec3 forward = glm::normalize(camera.look - camera.eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const glm::dvec3 d = point - camera.eye;
  const double depth = glm::dot(d, forward);
  const double half = std::tan(camera.fov_degrees * std::acos(-1.0) / 360.0);
  return depth > 0.0 && std::abs(glm::dot(d, up)) <= depth * half &&
         std::abs(glm::dot(d, right)) <= depth * half * aspect;
}

TEST(FrameScene, ShowsTheWholeBox) {
  for (const glm::vec3 extent : {glm::vec3(1.0F), glm::vec3(1.0F, 100.0F, 1.0F),
                                 glm::vec3(1e-20F, 3e-20F, 0.0F), glm::vec3(1e30F, 1.0F, 5e29F)}) {
    const glm::vec3 lo(5.0F * extent.x, -3.0F * extent.y, 0.25F * extent.z);
    test::SceneMaker maker;
    maker.box(lo, lo + extent);
    for (const double aspect : {0.5, 1.0, 16.0 / 9.0}) {
      const Camera camera = frame_scene(maker.scene, aspect);
      for (const glm::vec3& p : maker.scene.positions) {
        EXPECT_TRUE(in_view(camera, aspect, glm::dvec3(p))) << extent.x << " " << aspect;
      }
    }
  }
}

TEST(FrameScene, HasACameraForNothingAndForAPoint) {
  test::SceneMaker nothing;
  EXPECT_TRUE(PinholeCamera::create(frame_scene(nothing.scene, 1.0), 8, 8).has_value());
  test::SceneMaker point;
  point.triangle(glm::vec3(1e30F), glm::vec3(1e30F), glm::vec3(1e30F));
  EXPECT_TRUE(PinholeCamera::create(frame_scene(point.scene, 1.0), 8, 8).has_value());
}

}  // namespace
}  // namespace gridrt
