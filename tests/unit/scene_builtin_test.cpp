// Built-in scenes: each one is made, closed shapes are closed, options do what they say.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include <glm/geometric.hpp>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

TEST(SceneBuiltin, AllAreMadeAndTheSameEachTime) {
  const auto all = builtin_names();
  ASSERT_GE(all.size(), 15U);
  for (const BuiltinInfo& info : all) {
    EXPECT_FALSE(info.summary.empty());
    const Scene one = builtin(info.name);
    const Scene two = builtin(info.name);
    EXPECT_EQ(corners_of(one), corners_of(two)) << info.name;
    EXPECT_EQ(one.triangles.empty(), info.name == "empty") << info.name;
    EXPECT_FALSE(one.lights.empty()) << info.name;
    EXPECT_TRUE(builtin(info.name + "?lights=0").lights.empty()) << info.name;
  }
}

TEST(SceneBuiltin, TeapotHasNewellsPatches) {
  const Scene teapot = builtin("teapot");
  EXPECT_EQ(teapot.triangles.size(), 6320U);  // 32 patches of 200 less 80 at the poles
  EXPECT_EQ(teapot.normals.size(), teapot.positions.size());
  // No two vertices of a tube are equal; only the handle's end may touch the body's.
  std::set<std::array<float, 3>> distinct;
  for (const glm::vec3& p : teapot.positions) {
    distinct.insert({p.x, p.y, p.z});
  }
  EXPECT_GE(distinct.size() + 2, teapot.positions.size());
  float top = 0.0F;
  float spout = 0.0F;
  float handle = 0.0F;
  for (const glm::vec3& p : teapot.positions) {
    EXPECT_GE(p.y, -1e-6F);
    top = std::max(top, p.y);
    spout = std::max(spout, p.x);
    handle = std::min(handle, p.x);
  }
  EXPECT_EQ(top, 3.15F);
  EXPECT_NEAR(spout, 3.434F, 0.01F);
  EXPECT_NEAR(handle, -3.0F, 0.01F);
}

// Where two patches meet, the surface passes through their control points.
TEST(SceneBuiltin, TeapotPassesThroughNewellsSeams) {
  const Scene teapot = builtin("teapot?tessellation=4");
  const auto has = [&](float x, float y, float z) {
    return std::any_of(teapot.positions.begin(), teapot.positions.end(), [&](const glm::vec3& p) {
      return glm::length(p - glm::vec3(x, y, z)) < 1e-6F;
    });
  };
  for (const auto& [radius, height] : {std::pair{1.4F, 2.4F},
                                       {1.5F, 2.4F},
                                       {2.0F, 0.9F},
                                       {1.5F, 0.15F},
                                       {0.2F, 2.7F},
                                       {1.3F, 2.4F},
                                       {0.0F, 3.15F},
                                       {0.0F, 0.0F}}) {
    EXPECT_TRUE(has(radius, height, 0)) << radius << " " << height;
    EXPECT_TRUE(has(0, height, -radius)) << radius << " " << height;
    EXPECT_TRUE(has(-radius, height, 0)) << radius << " " << height;
  }
  for (const auto& [x, y] : {std::pair{-1.6F, 2.025F},
                             {-1.5F, 2.25F},
                             {-2.7F, 1.8F},
                             {-3.0F, 1.8F},
                             {-2.0F, 0.9F},
                             {-1.9F, 0.6F},
                             {1.7F, 1.425F},
                             {1.7F, 0.6F},
                             {2.7F, 2.4F},
                             {3.3F, 2.4F},
                             {2.8F, 2.4F},
                             {3.2F, 2.4F}}) {
    EXPECT_TRUE(has(x, y, 0)) << x << " " << y;
  }
  EXPECT_NEAR(volume_of(builtin("teapot?tessellation=40")), 25.92, 0.01);
}

TEST(SceneBuiltin, TeapotNormalsAgreeWithItsTriangles) {
  const Scene teapot = builtin("teapot?tessellation=16");
  std::size_t against = 0;
  for (std::size_t i = 0; i < teapot.triangles.size(); ++i) {
    const auto& [a, b, c] = teapot.triangles[i];
    const glm::dvec3 p(teapot.positions[a]);
    const glm::dvec3 flat =
        glm::cross(glm::dvec3(teapot.positions[b]) - p, glm::dvec3(teapot.positions[c]) - p);
    ASSERT_GT(glm::length(flat), 0.0) << i;
    for (const std::uint32_t n : teapot.triangle_normals[i]) {
      against += glm::dot(flat, glm::dvec3(teapot.normals[n])) <= 0.0 ? 1U : 0U;
    }
  }
  EXPECT_EQ(against, 0U);
  EXPECT_GT(volume_of(teapot), 0.0);
}

// A mesh of the same teapot by others: every vertex of theirs lies on ours.
TEST(SceneBuiltin, TeapotMatchesAPublishedMesh) {
  std::ifstream file(GRIDRT_SHARED_SCENES "/teapot.obj");
  if (!file) {
    GTEST_SKIP() << "no published teapot beside this checkout";
  }
  std::stringstream text;
  text << file.rdbuf();
  const Scene published = good(SceneFormat::kObj, text.str());
  const Scene ours = builtin("teapot?tessellation=60");
  float lowest = published.positions[0].y;
  for (const glm::vec3& p : published.positions) {
    lowest = std::min(lowest, p.y);
  }
  constexpr float kNear = 0.03F;
  std::size_t far = 0;
  for (std::size_t i = 0; i < published.positions.size(); i += 7) {
    const glm::vec3 p = published.positions[i] - glm::vec3(0.0F, lowest, 0.0F);
    const bool near = std::any_of(ours.positions.begin(), ours.positions.end(),
                                  [&](auto q) { return glm::length(p - q) < kNear; });
    far += near ? 0U : 1U;
  }
  EXPECT_EQ(far, 0U);
}

TEST(SceneBuiltin, ClosedShapesAreClosedAndFaceOutward) {
  const double ball = 4.0 / 3.0 * M_PI;
  for (const auto& [spec, volume] : std::vector<std::pair<std::string, double>>{
           {"cube?size=1,2,3", 6.0},
           {"sphere?subdivisions=4", ball},
           {"sphere?kind=uv&segments=64&radius=2", 8 * ball},
           {"sphere?kind=uv&segments=5", 1.585},
           {"glass?floor=0&layers=1", 3.375 * ball}}) {
    const Scene scene = builtin(spec);
    EXPECT_TRUE(is_closed(scene)) << spec;
    EXPECT_NEAR(volume_of(scene) / volume, 1.0, 0.03) << spec;
  }
  for (const char* spec : {"room?cells=5", "mirrorbox?ball=0&cells=7", "mirrorbox"}) {
    EXPECT_TRUE(is_closed(builtin(spec))) << spec;
  }
  EXPECT_LT(volume_of(builtin("mirrorbox?ball=0")), -63.9);  // walls face inward
}

TEST(SceneBuiltin, SpheresMayLieFarAway) {
  const Scene scene = builtin("sphere?radius=2&centre=148376,1234,-223423&subdivisions=2");
  EXPECT_TRUE(is_closed(scene));
  for (const glm::vec3& p : scene.positions) {
    const double distance = glm::length(glm::dvec3(p) - glm::dvec3(148376, 1234, -223423));
    EXPECT_NEAR(distance, 2.0, 0.02);
  }
}

TEST(SceneBuiltin, SheetsCoverTheirSquareWithoutFolds) {
  for (const std::uint32_t count : {4U, 6U, 26U, 512U, 65536U}) {
    for (const int seed : {0, 1, 2}) {
      const Scene scene = builtin("sheet?triangles=" + std::to_string(count) +
                                  "&jitter=0.24&seed=" + std::to_string(seed));
      ASSERT_EQ(scene.triangles.size(), count);
      double area = 0.0;
      for (const auto& [a, b, c] : scene.triangles) {
        const glm::dvec3 p(scene.positions[a]);
        const double twice =
            glm::cross(glm::dvec3(scene.positions[b]) - p, glm::dvec3(scene.positions[c]) - p).z;
        EXPECT_GT(twice, 0.0);
        area += twice / 2;
      }
      EXPECT_NEAR(area, 4.0, 1e-5);
    }
  }
  EXPECT_NE(corners_of(builtin("sheet?seed=1")), corners_of(builtin("sheet?seed=2")));
}

TEST(SceneBuiltin, SliversAreAsThinAsAsked) {
  for (const char* kind : {"needles", "caps", "fan"}) {
    for (const double aspect : {1e3, 1e12}) {
      const Scene scene = builtin(std::string("slivers?triangles=8&kind=") + kind +
                                  "&aspect=" + std::to_string(aspect));
      for (const auto& [a, b, c] : scene.triangles) {
        const glm::dvec3 p(scene.positions[a]);
        const double area = glm::length(glm::cross(glm::dvec3(scene.positions[b]) - p,
                                                   glm::dvec3(scene.positions[c]) - p)) /
                            2;
        EXPECT_NEAR(area * aspect / 2.0, 1.0, 1e-6) << kind;
      }
    }
  }
}

TEST(SceneBuiltin, DegenerateOnesHaveNoArea) {
  const Scene scene = builtin("degenerate?triangles=400");
  for (const auto& [a, b, c] : scene.triangles) {
    const glm::dvec3 p(scene.positions[a]);
    EXPECT_EQ(glm::cross(glm::dvec3(scene.positions[b]) - p, glm::dvec3(scene.positions[c]) - p),
              glm::dvec3(0.0));
  }
}

TEST(SceneBuiltin, OptionsMoveWhatTheySay) {
  EXPECT_EQ(builtin("room?lamp=outside").triangles, builtin("room").triangles);
  EXPECT_GT(builtin("room?lamp=outside").lights[0].position.x, 2.0);
  EXPECT_EQ(builtin("soup?copies=3&triangles=5").triangles.size(), 15U);
  EXPECT_EQ(builtin("teapots?tessellation=1").triangles.size(), 18U * 56U);
  EXPECT_EQ(builtin("teapots?tessellation=1&stray=1e20").triangles.size(), 18U * 56U + 1);
  EXPECT_EQ(builtin("fan?valence=64").triangles.size(), 64U);
  for (const char* axis : {"x", "y", "z"}) {
    const Scene quad = builtin(std::string("quad?axis=") + axis);
    const int i = axis[0] - 'x';
    for (const glm::vec3& p : quad.positions) {
      EXPECT_EQ(p[i], 0.0F);
    }
  }
}

TEST(SceneBuiltin, RefusalsListWhatIsValid) {
  for (const auto& [spec, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"kettle", {"kettle", "teapot"}},
           {"", {"teapot"}},
           {"teapot?tesselation=3", {"tesselation=3", "tessellation"}},
           {"teapot?tessellation", {"tessellation"}},
           {"teapot?tessellation=0", {"'0'", "from 1 to 400"}},
           {"teapot?tessellation=401", {"'401'", "from 1 to 400"}},
           {"teapot?tessellation=2.5", {"'2.5'", "whole"}},
           {"teapot?tessellation=nan", {"'nan'"}},
           {"teapot?tessellation=", {"''"}},
           {"cube?size=1,2", {"'1,2'", "three numbers"}},
           {"cube?size=1,2,3,4", {"three numbers"}},
           {"cube?size=1,-2,3", {"three numbers"}},
           {"quad?axis=w", {"'w'", "x|y|z"}},
           {"quad?axis=", {"x|y|z"}},
           {"quad?axis=x|y", {"x|y|z"}}}) {
    const auto scene = load_scene("builtin:" + spec);
    ASSERT_FALSE(scene.has_value()) << spec;
    EXPECT_EQ(scene.error().kind, ErrorKind::kUsage);
    const std::string told = scene.error().message + " " + scene.error().advice;
    for (const std::string& part : parts) {
      EXPECT_NE(told.find(part), std::string::npos) << told;
    }
  }
}

}  // namespace
}  // namespace gridrt::scene_test
