#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "host/render/optics.hpp"

namespace gridrt {
namespace {

const glm::dvec3 kUp(0.0, 0.0, 1.0);

// A unit direction that comes down at `angle` from the normal kUp.
glm::dvec3 incoming(double angle) { return {std::sin(angle), 0.0, -std::cos(angle)}; }

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(Optics, MirrorKeepsTheAngle) {
  const glm::dvec3 out = reflect(incoming(30.0 * kDegree), kUp);
  EXPECT_NEAR(out.x, 0.5, 1e-15);
  EXPECT_NEAR(out.y, 0.0, 1e-15);
  EXPECT_NEAR(out.z, std::sqrt(3.0) / 2.0, 1e-15);
}

TEST(Optics, SnellIntoGlass) {
  // sin 30 / 1.5 = 1/3.
  const Refraction r = refract(incoming(30.0 * kDegree), kUp, 1.0 / 1.5);
  EXPECT_NEAR(r.direction.x, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(r.direction.z, -std::sqrt(8.0) / 3.0, 1e-15);
}

TEST(Optics, SnellOutOfGlassUndoesSnellIntoGlass) {
  const glm::dvec3 in = incoming(50.0 * kDegree);
  const Refraction enter = refract(in, kUp, 1.0 / 1.7);
  const Refraction leave = refract(enter.direction, kUp, 1.7);
  EXPECT_NEAR(glm::length(leave.direction - in), 0.0, 1e-14);
  EXPECT_NEAR(enter.reflectance, leave.reflectance, 1e-14);
}

TEST(Optics, FresnelAtNormalIncidence) {
  // ((n - 1) / (n + 1))^2 = 0.04 for n = 1.5, from either side.
  EXPECT_NEAR(refract(incoming(0.0), kUp, 1.0 / 1.5).reflectance, 0.04, 1e-15);
  EXPECT_NEAR(refract(incoming(0.0), kUp, 1.5).reflectance, 0.04, 1e-15);
}

TEST(Optics, FresnelAtBrewstersAngle) {
  // tan theta = n: the amplitude along the plane vanishes, so R = Rs / 2 with
  // Rs = ((1 - n^2) / (1 + n^2))^2.
  const double n = 1.5;
  const double rs = std::pow((1.0 - (n * n)) / (1.0 + (n * n)), 2.0);
  EXPECT_NEAR(refract(incoming(std::atan(n)), kUp, 1.0 / n).reflectance, rs / 2.0, 1e-15);
}

TEST(Optics, FresnelGoesToOneAtGrazing) {
  EXPECT_GT(refract(incoming(89.999 * kDegree), kUp, 1.0 / 1.5).reflectance, 0.9998);
}

TEST(Optics, TotalReflectionBeginsAtTheCriticalAngle) {
  const double critical = std::asin(1.0 / 1.5);
  const Refraction above = refract(incoming(critical + 1e-9), kUp, 1.5);
  EXPECT_EQ(above.reflectance, 1.0);
  EXPECT_EQ(above.direction, glm::dvec3(0.0));
  const Refraction below = refract(incoming(critical - 1e-6), kUp, 1.5);
  EXPECT_LT(below.reflectance, 1.0);
  EXPECT_NEAR(below.direction.x, 1.0, 1e-5);
}

TEST(Optics, EqualMediaAreInvisible) {
  const glm::dvec3 in = incoming(40.0 * kDegree);
  const Refraction r = refract(in, kUp, 1.0);
  EXPECT_NEAR(r.reflectance, 0.0, 1e-30);
  EXPECT_NEAR(glm::length(r.direction - in), 0.0, 1e-15);
}

}  // namespace
}  // namespace gridrt
