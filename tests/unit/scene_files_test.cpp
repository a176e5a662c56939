// Scenes from files: side files beside them, and files that cannot be read.
#include <filesystem>
#include <fstream>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

class SceneFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("scene_") + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "sub");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  std::filesystem::path folder_;
};

TEST_F(SceneFiles, SideFilesAreFoundBesideTheFileThatNamesThem) {
  write("sub/red.mtl", "newmtl red\nKd 1 0 0\n");
  const std::string obj =
      write("sub/t.OBJ", "mtllib red.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string toml = write("s.toml", "[[mesh]]\nfile = \"sub/t.OBJ\"\n");
  for (const std::string& path : {obj, toml}) {
    const auto scene = load_scene(path);
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_EQ(scene->materials.at(scene->triangle_materials.at(0)).diffuse, glm::vec3(1, 0, 0));
  }
  write("sub/b.bin", gltf_buffer(builtin("cube")));
  const auto gltf = load_scene(write("sub/c.gltf", to_gltf(builtin("cube"), "b.bin")));
  ASSERT_TRUE(gltf.has_value()) << gltf.error().message;
  EXPECT_EQ(gltf->triangles.size(), 12U);
}

TEST_F(SceneFiles, EveryEndingIsKnown) {
  const Scene cube = builtin("cube");
  for (const std::string& path :
       {write("a.obj", to_obj(cube)), write("a.PLY", to_ply_binary(cube, true)),
        write("a.stl", to_stl_binary(cube)),
        write("a.glb", to_glb(to_gltf(cube, ""), gltf_buffer(cube)))}) {
    const auto scene = load_scene(path);
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_EQ(corners_of(*scene), corners_of(cube));
  }
}

TEST_F(SceneFiles, RefusesWhatCannotBeRead) {
  const auto kind_of = [](const std::string& spec) {
    const auto scene = load_scene(spec);
    EXPECT_FALSE(scene.has_value());
    EXPECT_NE(scene.error().message.find(spec), std::string::npos) << scene.error().message;
    return scene.error().kind;
  };
  EXPECT_EQ(kind_of((folder_ / "gone.obj").string()), ErrorKind::kFile);
  EXPECT_EQ(kind_of(write("a.xyz", "")), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(write("plain", "")), ErrorKind::kUsage);
  std::filesystem::create_directories(folder_ / "d.obj");
  EXPECT_EQ(kind_of((folder_ / "d.obj").string()), ErrorKind::kFile);
  EXPECT_FALSE(load_scene("").has_value());
  EXPECT_EQ(kind_of(write("bad.obj", "v 1 2\n")), ErrorKind::kInput);
}

}  // namespace
}  // namespace gridrt::scene_test
