// MTL: what each statement means, and refusals that name library and line.
#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

constexpr const char* kObj = "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

Material material(const std::string& statements) {
  const Scene scene = good(SceneFormat::kObj, kObj, {{"a.mtl", "newmtl m\n" + statements}});
  EXPECT_EQ(scene.triangle_materials, std::vector<std::uint32_t>{1});
  return scene.materials.at(1);
}

TEST(SceneMtl, TakesColoursAndNumbers) {
  const Material m =
      material("Ka 1 0.5 0\nKd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nKe 2 3 4\nNs 77\nNi 1.33\nillum 2\n");
  EXPECT_EQ(m.name, "m");
  EXPECT_FLOAT_EQ(m.ambient.x, 0.1F);
  EXPECT_FLOAT_EQ(m.ambient.y, 0.05F);
  EXPECT_EQ(m.diffuse, glm::vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(m.specular, glm::vec3(0.4F, 0.5F, 0.6F));
  EXPECT_EQ(m.emission, glm::vec3(2, 3, 4));
  EXPECT_EQ(m.shininess, 77.0F);
  EXPECT_EQ(m.ior, 1.33F);
  EXPECT_EQ(m.mirror, glm::vec3(0));
  EXPECT_EQ(m.transmission, glm::vec3(0));
}

TEST(SceneMtl, ModelsChooseMirrorAndGlass) {
  const std::string colours = "Kd 0.5 0.5 0.5\nKs 0.25 0.5 0.75\nTf 0.9 0.8 0.7\n";
  for (const char* mirror : {"illum 3\n", "illum 5\n"}) {
    EXPECT_EQ(material(colours + mirror).mirror, glm::vec3(0.25F, 0.5F, 0.75F));
    EXPECT_EQ(material(colours + mirror).transmission, glm::vec3(0));
  }
  for (const char* glass : {"illum 4\n", "illum 6\n", "illum 7\n", "illum 9\n"}) {
    EXPECT_EQ(material(colours + glass).transmission, glm::vec3(0.9F, 0.8F, 0.7F));
  }
  EXPECT_EQ(material(colours + "illum 1\n").specular, glm::vec3(0));
  const Material constant = material(colours + "illum 0\n");
  EXPECT_EQ(constant.emission, glm::vec3(0.5F));
  EXPECT_EQ(constant.diffuse, glm::vec3(0));
}

TEST(SceneMtl, DissolveLetsLightThroughUnbent) {
  for (const char* text : {"d 0.25\n", "Tr 0.75\n", "d -halo 0.25\n"}) {
    const Material m = material(std::string("Kd 0.8 0.8 0.8\nNi 1.5\n") + text);
    EXPECT_FLOAT_EQ(m.transmission.x, 0.75F) << text;
    EXPECT_EQ(m.ior, 1.0F) << text;
    EXPECT_FLOAT_EQ(m.diffuse.x, 0.2F) << text;
  }
  EXPECT_EQ(material("d 1\n").transmission, glm::vec3(0));
}

TEST(SceneMtl, OneNumberStandsForThree) {
  EXPECT_EQ(material("Kd 0.3\n").diffuse, glm::vec3(0.3F));
}

TEST(SceneMtl, TexturesAndStrangeRangesAreWarnings) {
  const Scene scene = good(SceneFormat::kObj, kObj,
                           {{"a.mtl", "newmtl m\nKd 2 -1 0.5\nmap_Kd wood.png\nbump b.png\n"}});
  EXPECT_EQ(scene.materials[1].diffuse, glm::vec3(1, 0, 0.5F));
  EXPECT_TRUE(warns(scene, "a.mtl:3: textures"));
  EXPECT_TRUE(warns(scene, "a.mtl:2: value outside"));
}

TEST(SceneMtl, LibrariesMayBeSeveralOrHaveBlanksInTheirNames) {
  const Files files = {{"one.mtl", "newmtl a\nKd 1 0 0\n"},
                       {"two.mtl", "newmtl b\nKd 0 1 0\nnewmtl a\nKd 0 0 1\n"},
                       {"my own.mtl", "newmtl c d\nKd 0 0 1\n"}};
  const Scene scene = good(SceneFormat::kObj,
                           "mtllib one.mtl two.mtl\nmtllib my own.mtl\nv 0 0 0\n"
                           "usemtl a\nf 1 1 1\nusemtl b\nf 1 1 1\nusemtl c d\nf 1 1 1\n"
                           "usemtl e\nf 1 1 1\nusemtl a\nf 1 1 1\n",
                           files);
  ASSERT_EQ(scene.triangle_materials.size(), 5U);
  const auto diffuse = [&](std::size_t i) {
    return scene.materials[scene.triangle_materials[i]].diffuse;
  };
  EXPECT_EQ(diffuse(0), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse(1), glm::vec3(0, 1, 0));
  EXPECT_EQ(diffuse(2), glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.triangle_materials[4], scene.triangle_materials[0]);
  EXPECT_TRUE(warns(scene, "'a' is defined again"));
  EXPECT_TRUE(warns(scene, "mesh:10: material 'e'"));
}

TEST(SceneMtl, RefusesByLibraryAndLine) {
  for (const char* bad :
       {"Kd nan 0 0", "Kd 1 inf 0", "Ks x 0 0", "Ns nan", "Ni", "d 1e99", "illum 11", "illum -1",
        "illum x", "Kd 1 2", "Ke 1 1 1e40", "wibble 3", "Tr nan"}) {
    expect_refused(SceneFormat::kObj, kObj, {"a.mtl:2:"},
                   {{"a.mtl", std::string("newmtl m\n") + bad + "\n"}});
  }
  expect_refused(SceneFormat::kObj, kObj, {"a.mtl:1:", "before any newmtl"},
                 {{"a.mtl", "Kd 1 1 1\n"}});
}

}  // namespace
}  // namespace gridrt::scene_test
