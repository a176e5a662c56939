// Every format gives the same triangles in the same order for the same shape.
#include <functional>
#include <utility>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

struct Format {
  const char* name;
  SceneFormat format;
  std::function<std::string(const Scene&)> write;
};

class SceneFormats : public testing::TestWithParam<Format> {};

void expect_same(const Scene& scene, const Scene& expected) {
  EXPECT_EQ(scene.triangles.size(), expected.triangles.size());
  EXPECT_EQ(corners_of(scene), corners_of(expected));  // bit for bit but for signs of zero
  EXPECT_EQ(scene.triangle_materials, std::vector<std::uint32_t>(scene.triangles.size(), 0));
  EXPECT_FALSE(scene.camera.has_value());
  EXPECT_FALSE(scene.lights.empty());
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

TEST_P(SceneFormats, KeepsACube) {
  const Scene cube = builtin("cube?size=1,2,0.1&centre=0.3,-7,1e-3");
  expect_same(good(GetParam().format, GetParam().write(cube)), cube);
}

TEST_P(SceneFormats, KeepsATeapot) {
  const Scene teapot = builtin("teapot?tessellation=5");
  expect_same(good(GetParam().format, GetParam().write(teapot)), teapot);
}

TEST_P(SceneFormats, KeepsDegenerateTrianglesAndTheirNumbers) {
  const Scene scene = builtin("degenerate?triangles=9&whole=1");
  expect_same(good(GetParam().format, GetParam().write(scene)), scene);
}

TEST_P(SceneFormats, KeepsDenormalsAndTheLargestFloats) {
  Scene scene = builtin("triangle");
  scene.positions = {{1e-45F, -3e-40F, 0.0F}, {3.4028235e38F, 1e-38F, -1.0F}, {0.1F, 1e30F, 7.0F}};
  expect_same(good(GetParam().format, GetParam().write(scene)), scene);
}

// A file that ends anywhere before its end is refused, or gives a true part of the shape (formats
// without counts); it never gives anything else.
TEST_P(SceneFormats, NeverInventsWhenTruncated) {
  const Scene cube = builtin("cube");
  const std::string whole = GetParam().write(cube);
  const std::vector<float> all = corners_of(cube);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto scene = load(GetParam().format, std::string_view(whole).substr(0, size));
    if (!scene) {
      EXPECT_NE(scene.error().message.find("mesh"), std::string::npos);
      continue;
    }
    const std::vector<float> part = corners_of(*scene);
    ASSERT_LE(part.size(), all.size()) << size;
    // The last number of a text may be cut short; what is before it stands.
    const std::size_t sure = part.size() - part.size() % 9;
    const std::size_t checked = sure < 9 ? 0 : sure - 9;
    EXPECT_TRUE(
        std::equal(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(checked), all.begin()))
        << size;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneFormats,
    testing::Values(Format{"Obj", SceneFormat::kObj, to_obj},
                    Format{"PlyText", SceneFormat::kPly, to_ply_text},
                    Format{"PlyLittle", SceneFormat::kPly,
                           [](const Scene& s) { return to_ply_binary(s, false); }},
                    Format{"PlyBig", SceneFormat::kPly,
                           [](const Scene& s) { return to_ply_binary(s, true); }},
                    Format{"StlText", SceneFormat::kStl, to_stl_text},
                    Format{"StlBinary", SceneFormat::kStl, to_stl_binary},
                    Format{"Gltf", SceneFormat::kGltf,
                           [](const Scene& s) {
                             return to_gltf(s, "data:application/octet-stream;base64," +
                                                   base64(gltf_buffer(s)));
                           }},
                    Format{"Glb", SceneFormat::kGlb,
                           [](const Scene& s) { return to_glb(to_gltf(s, ""), gltf_buffer(s)); }}),
    [](const auto& chosen) { return chosen.param.name; });

}  // namespace
}  // namespace gridrt::scene_test
