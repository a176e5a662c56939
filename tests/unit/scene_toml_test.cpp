// Scenes in TOML: placements, materials, lights, camera, and refusals that name line and key.
#include <cmath>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

Scene toml(const std::string& text, const Files& files = {}) {
  return good(SceneFormat::kToml, text, files);
}
void refused(const std::string& text, const std::vector<std::string>& parts,
             const Files& files = {}) {
  expect_refused(SceneFormat::kToml, text, parts, files);
}

const Files kFiles = {
    {"sub/t.obj", "mtllib t.mtl\nusemtl red\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"},
    {"sub/t.mtl", "newmtl red\nKd 1 0 0\n"}};

glm::vec3 first_corner(const Scene& scene, std::size_t triangle) {
  return scene.positions[scene.triangles[triangle][0]];
}

TEST(SceneToml, ReadsEverything) {
  const Scene scene = toml(
      "background = [0.1, 0.2, 0.3]\nambient = 0.5\n"
      "[camera]\neye = [0, 1, 5]\nlook = [0, 0, 0]\nup = [0, 0, 1]\nfov = 60\n"
      "[[light]]\ntype = \"point\"\nposition = [1, 2, 3]\ncolour = [1, 0.5, 0]\nintensity = 2\n"
      "[[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\n"
      "[[material]]\nname = \"glass\"\ndiffuse = 0\ntransmission = [0.9, 0.8, 0.7]\nior = 1.4\n"
      "specular = 0.5\nshininess = 99\nmirror = 0.1\nemission = [0, 0, 2]\nambient = 0.2\n"
      "[[mesh]]\nfile = \"sub/t.obj\"\n[[mesh]]\nfile = \"sub/t.obj\"\nmaterial = \"glass\"\n",
      kFiles);
  EXPECT_EQ(scene.background, glm::vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(scene.ambient_light, glm::vec3(0.5F));
  EXPECT_EQ(scene.camera->eye, glm::dvec3(0, 1, 5));
  EXPECT_EQ(scene.camera->up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.camera->fov_degrees, 60.0);
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_EQ(scene.lights[0].colour, glm::vec3(2, 1, 0));
  EXPECT_EQ(scene.lights[1].direction, glm::dvec3(0, -1, 0));
  ASSERT_EQ(scene.triangles.size(), 2U);
  const Material& own = scene.materials[scene.triangle_materials[0]];
  const Material& glass = scene.materials[scene.triangle_materials[1]];
  EXPECT_EQ(own.diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(glass.transmission, glm::vec3(0.9F, 0.8F, 0.7F));
  EXPECT_EQ(glass.ior, 1.4F);
  EXPECT_EQ(glass.shininess, 99.0F);
  EXPECT_EQ(glass.mirror, glm::vec3(0.1F));
  EXPECT_EQ(glass.emission, glm::vec3(0, 0, 2));
}

TEST(SceneToml, PlacesByScaleThenRotateThenTranslate) {
  const Scene scene = toml(
      "[[mesh]]\nfile = \"sub/t.obj\"\nscale = [2, 1, 1]\nrotate = [0, 0, 3, 90]\n"
      "translate = [0, 10, 0]\ninstances = [{}, {translate = [100, 0, 0]}, {scale = 2}]\n",
      kFiles);
  ASSERT_EQ(scene.triangles.size(), 3U);
  // (1, 0, 0) to (2, 0, 0) to (0, 2, 0) to (0, 12, 0).
  EXPECT_NEAR(first_corner(scene, 0).x, 0, 1e-15);
  EXPECT_EQ(first_corner(scene, 0).y, 12.0F);
  EXPECT_EQ(first_corner(scene, 1).x, 100.0F);
  EXPECT_EQ(first_corner(scene, 2).y, 24.0F);
}

TEST(SceneToml, MatricesAreRows) {
  for (const char* last : {"", ", [0, 0, 0, 1]"}) {
    const Scene scene = toml(std::string("[[mesh]]\nfile = \"sub/t.obj\"\n"
                                         "matrix = [[0, 1, 0, 5], [7, 0, 0, 6], [0, 0, 1, 0]") +
                                 last + "]\n",
                             kFiles);
    EXPECT_EQ(first_corner(scene, 0), glm::vec3(5, 13, 0));
  }
}

// Rounded once: 0.1f * 3 + 0.2 in double, not in float steps.
TEST(SceneToml, RoundsPositionsOnce) {
  const Scene scene = toml("[[mesh]]\nfile = \"t.obj\"\nscale = 3\ntranslate = [1e-9, 0, 0]\n",
                           {{"t.obj", "v 0.1 0 0\nf 1 1 1\n"}});
  EXPECT_EQ(first_corner(scene, 0).x, static_cast<float>(static_cast<double>(0.1F) * 3.0 + 1e-9));
}

TEST(SceneToml, MirroringKeepsOutsidesOutside) {
  const Scene scene = toml("[[mesh]]\nfile = \"builtin:cube\"\nscale = [-1, 1, 1]\n");
  EXPECT_NEAR(volume_of(scene), 8.0, 1e-6);
  const Scene sphere = toml("[[mesh]]\nfile = \"builtin:sphere\"\nscale = [-1, 1, 1]\n");
  for (std::size_t i = 0; i < sphere.triangles.size(); ++i) {
    const glm::vec3 p = sphere.positions[sphere.triangles[i][1]];
    const glm::vec3 n = sphere.normals[sphere.triangle_normals[i][1]];
    EXPECT_GT(p.x * n.x + p.y * n.y + p.z * n.z, 0.99F);
  }
}

TEST(SceneToml, SmoothChoosesNormals) {
  const auto with = [](const char* line) {
    return toml(std::string("[[mesh]]\nfile = \"builtin:cube\"\n") + line);
  };
  EXPECT_TRUE(with("").triangle_normals.empty());
  const Scene smooth = with("smooth = true\n");
  ASSERT_EQ(smooth.triangle_normals.size(), 12U);
  const glm::vec3 n = smooth.normals[smooth.triangle_normals[0][0]];
  EXPECT_NEAR(std::abs(n.x), 0.57735F, 1e-5);  // the angles make all three faces count alike
  EXPECT_NEAR(std::abs(n.y), 0.57735F, 1e-5);
  EXPECT_TRUE(
      toml("[[mesh]]\nfile = \"builtin:sphere\"\nsmooth = false\n").triangle_normals.empty());
}

TEST(SceneToml, WarnsOfWhatIsMissing) {
  EXPECT_TRUE(warns(toml(""), "no triangles"));
  EXPECT_TRUE(warns(toml(""), "no [[light]]"));
  EXPECT_TRUE(warns(toml("[[mesh]]\nfile = \"a.obj\"\n", {{"a.obj", "usemtl x\n"}}), "a.obj:1"));
}

TEST(SceneToml, RefusesUnknownKeysByLineAndKey) {
  refused("\nbackround = 1\n", {"mesh:2:", "'backround'"});
  refused("[camera]\neye = [0,0,1]\nlook = [0,0,0]\nfow = 3\n", {"mesh:4:", "'fow'", "camera"});
  refused("[[light]]\ntype = \"point\"\nposition = [0,0,0]\npower = 3\n", {"mesh:4:", "'power'"});
  refused("[[material]]\nname = \"a\"\nroughness = 1\n", {"mesh:3:", "'roughness'"});
  refused("[[mesh]]\nfile = \"builtin:cube\"\ninstances = [\n{translat = [0,0,0]}]\n",
          {"mesh:4:", "'translat'"});
}

TEST(SceneToml, RefusesWrongValuesByLineAndKey) {
  const std::string camera = "[camera]\nlook = [0,0,0]\n";
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {camera, "mesh:1: camera has no 'eye'"},
           {camera + "eye = [0,0]", "mesh:3: eye"},
           {camera + "eye = [0,0,nan]", "mesh:3: eye"},
           {camera + "eye = [0,0,inf]", "mesh:3: eye"},
           {camera + "eye = 3", "mesh:3: eye"},
           {camera + "eye = [0,0,0]", "camera has its eye"},
           {camera + "eye = [0,0,1]\nfov = 180", "mesh:4: fov"},
           {camera + "eye = [0,0,1]\nfov = \"a\"", "mesh:4: fov"},
           {camera + "eye = [0,0,1]\nup = [0,0,0]", "mesh:4: up"},
           {"camera = 3", "mesh:1: camera"},
           {"light = 3", "mesh:1: light"},
           {"light = [3]", "mesh:1: light"},
           {"[[light]]\n", "has no 'type'"},
           {"[[light]]\ntype = \"area\"", "mesh:2: type is 'area'"},
           {"[[light]]\ntype = \"point\"", "has no 'position'"},
           {"[[light]]\ntype = \"point\"\nposition = [0,0,0]\ndirection = [1,0,0]", "direction"},
           {"[[light]]\ntype = \"directional\"\ndirection = [0,0,0]", "mesh:3: direction"},
           {"[[light]]\ntype = \"point\"\nposition = [0,0,0]\ncolour = -1", "mesh:4: colour"},
           {"[[material]]\ndiffuse = 1", "has no 'name'"},
           {"[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"", "mesh:4: name"},
           {"[[material]]\nname = \"a\"\ndiffuse = 1.5", "mesh:3: diffuse"},
           {"[[material]]\nname = \"a\"\ndiffuse = [0, 0, 1.5]", "mesh:3: diffuse"},
           {"[[material]]\nname = \"a\"\nior = 0", "mesh:3: ior"},
           {"[[material]]\nname = \"a\"\nshininess = -1", "mesh:3: shininess"},
           {"[[mesh]]\n", "has no 'file'"},
           {"[[mesh]]\nfile = 3", "mesh:2: file"},
           {"[[mesh]]\nfile = \"a.xyz\"", "mesh:2: file is 'a.xyz'"},
           {"[[mesh]]\nfile = \"a.toml\"", "mesh:2: file is 'a.toml', a scene within a scene"},
           {"[[mesh]]\nfile = \"builtin:x\"", "mesh:2: builtin:x"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nmaterial = \"m\"", "mesh:3: material"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nsmooth = 1", "mesh:3: smooth"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nrotate = [0, 0, 0, 9]", "mesh:3: rotate"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nrotate = [0, 0, 1]", "mesh:3: rotate"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nscale = [1, 1]", "mesh:3: scale"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nmatrix = [[1,0,0,0]]", "mesh:3: matrix"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nmatrix = [[1,0,0],[0,1,0],[0,0,1]]", "mesh:3:"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nmatrix = "
            "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]",
            "mesh:3: matrix is not affine"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nscale = 2\nmatrix = "
            "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]",
            "mesh:4: matrix stands beside"},
           {"[[mesh]]\nfile = \"builtin:cube\"\ninstances = 2", "mesh:3: instances"},
           {"[[mesh]]\nfile = \"builtin:cube\"\nscale = 1e39", "range"},
           {"[[mesh]]\nfile = \"builtin:cube\"\ntranslate = [1e300, 0, 0]\nscale = 1e300", "range"},
           {"a = [", "mesh:1:"},
           {"a = 1\na = 2", "mesh:2:"}}) {
    const auto scene = load(SceneFormat::kToml, text);
    ASSERT_FALSE(scene.has_value()) << text;
    EXPECT_NE(scene.error().message.find(part), std::string::npos)
        << text << "\n -> " << scene.error().message;
    EXPECT_EQ(scene.error().message.find("mesh"), 0U) << scene.error().message;
  }
}

TEST(SceneToml, ErrorsOfMeshesNameBothFiles) {
  refused("\n[[mesh]]\nfile = \"a.obj\"\n", {"mesh:3:", "a.obj:2:"}, {{"a.obj", "\nv nan 0 0\n"}});
  const auto gone = load(SceneFormat::kToml, "[[mesh]]\nfile = \"gone.ply\"\n");
  ASSERT_FALSE(gone.has_value());
  EXPECT_EQ(gone.error().kind, ErrorKind::kFile);
  EXPECT_NE(gone.error().message.find("mesh:2: gone.ply"), std::string::npos);
}

}  // namespace
}  // namespace gridrt::scene_test
