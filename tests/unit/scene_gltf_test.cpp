// glTF: containers, nodes, strips and fans, materials, lights, cameras, and refusals by place.
#include <cmath>
#include <cstring>
#include <limits>

#include <nlohmann/json.hpp>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

using nlohmann::json;
using Triples = std::vector<std::array<std::uint32_t, 3>>;

// A document of one triangle with side files "t.bin".
json triangle_document() { return json::parse(to_gltf(builtin("triangle"), "t.bin")); }
const Files& files() {
  static const Files kFiles = {{"t.bin", gltf_buffer(builtin("triangle"))}};
  return kFiles;
}
Scene gltf(const json& document, const Files& side = files()) {
  return good(SceneFormat::kGltf, document.dump(), side);
}
void refused(const json& document, const std::vector<std::string>& parts,
             const Files& side = files()) {
  expect_refused(SceneFormat::kGltf, document.dump(), parts, side);
}

TEST(SceneGltf, NodesPlaceAndRepeatMeshes) {
  json document = triangle_document();
  document["scenes"][0]["nodes"] = {0, 3};
  document["nodes"] = json::parse(R"([
    {"translation":[10,0,0],"children":[1,2]},
    {"mesh":0,"scale":[2,3,4],"rotation":[0,0,0.70710678118654752,0.70710678118654752]},
    {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,5,0,1]},
    {"mesh":0}])");
  const Scene scene = gltf(document);
  ASSERT_EQ(scene.triangles.size(), 3U);
  const auto corner = [&](std::size_t i) { return scene.positions[scene.triangles[i][0]]; };
  // (-1, -1, 0) scaled to (-2, -3, 0), turned by 90 degrees to (3, -2, 0), moved.
  EXPECT_NEAR(corner(0).x, 13, 1e-5);
  EXPECT_NEAR(corner(0).y, -2, 1e-5);
  EXPECT_EQ(corner(1), glm::vec3(9, 4, 0));
  EXPECT_EQ(corner(2), glm::vec3(-1, -1, 0));
}

TEST(SceneGltf, MirroredNodesKeepOutsidesOutside) {
  const Scene cube = builtin("cube");
  json document = json::parse(to_gltf(cube, "c.bin"));
  document["nodes"][0]["scale"] = {-1, 2, 1};
  EXPECT_NEAR(volume_of(gltf(document, {{"c.bin", gltf_buffer(cube)}})), 16.0, 1e-6);
}

TEST(SceneGltf, WithoutAScenesListTheRootsAreDrawn) {
  json document = triangle_document();
  document.erase("scenes");
  document.erase("scene");
  document["nodes"] = json::parse(R"([{"mesh":0},{"children":[0]},{"mesh":0}])");
  EXPECT_EQ(gltf(document).triangles.size(), 2U);
}

TEST(SceneGltf, StripsAndFansAreSplitAsSpecified) {
  std::string bytes;
  for (int i = 0; i < 5; ++i) {
    for (const float part : {float(i), float(i * i), 0.0F}) {
      put(bytes, part);
    }
  }
  json document = json::parse(R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"mode":5,"attributes":{"POSITION":0}}]}],
    "buffers":[{"byteLength":60,"uri":"b"}],"bufferViews":[{"buffer":0,"byteLength":60}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"}]})");
  EXPECT_EQ(gltf(document, {{"b", bytes}}).triangles, (Triples{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  document["meshes"][0]["primitives"][0]["mode"] = 6;
  EXPECT_EQ(gltf(document, {{"b", bytes}}).triangles, (Triples{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  document["meshes"][0]["primitives"][0]["mode"] = 1;
  EXPECT_TRUE(warns(gltf(document, {{"b", bytes}}), "points and lines"));
  document["meshes"][0]["primitives"][0]["mode"] = 4;
  refused(document, {"meshes[0].primitives[0]", "5 corners"}, {{"b", bytes}});
}

TEST(SceneGltf, ReadsIndicesOfEveryWidthAndStrides) {
  for (const auto& [type, size] : {std::pair{5121, 1}, {5123, 2}, {5125, 4}}) {
    std::string bytes;
    for (const std::uint32_t index : {2U, 1U, 0U}) {
      bytes.append(reinterpret_cast<const char*>(&index), static_cast<std::size_t>(size));
    }
    bytes.resize(12, '\0');
    for (int i = 0; i < 3; ++i) {  // each vertex followed by 4 bytes of something else
      put(bytes, float(i));
      put(bytes, float(i == 1));
      put(bytes, 0.5F);
      bytes += "junk";
    }
    const json document = {
        {"asset", {{"version", "2.0"}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
        {"buffers", {{{"byteLength", 60}, {"uri", "b%20c"}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteOffset", 8}, {"byteLength", 52}, {"byteStride", 16}},
          {{"buffer", 0}, {"byteLength", 12}}}},
        {"accessors",
         {{{"bufferView", 0},
           {"byteOffset", 4},
           {"componentType", 5126},
           {"count", 3},
           {"type", "VEC3"}},
          {{"bufferView", 1}, {"componentType", type}, {"count", 3}, {"type", "SCALAR"}}}}};
    const Scene scene = gltf(document, {{"b c", bytes}});
    EXPECT_EQ(scene.triangles, (Triples{{2, 1, 0}}));
    EXPECT_EQ(scene.positions[2], glm::vec3(2, 0, 0.5F));
  }
}

TEST(SceneGltf, MapsMaterials) {
  json document = triangle_document();
  document["materials"] = json::parse(R"([
    {"name":"metal","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.6,0.4,1],
      "metallicFactor":1,"roughnessFactor":0}},
    {"name":"glass","pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0},
      "extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
                    "KHR_materials_ior":{"ior":1.33}}},
    {"name":"clay","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],
      "metallicFactor":0,"baseColorTexture":{"index":0}},"emissiveFactor":[0,0.5,0],
      "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":3}}},
    {"name":"veil","alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25],
      "metallicFactor":0}},
    {"name":"sign","extensions":{"KHR_materials_unlit":{}},
      "pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}])");
  document["meshes"][0]["primitives"][0]["material"] = 1;
  const Scene scene = gltf(document);
  EXPECT_EQ(scene.triangle_materials[0], 2U);
  const auto& m = scene.materials;
  EXPECT_EQ(m[1].mirror, glm::vec3(0.8F, 0.6F, 0.4F));
  EXPECT_EQ(m[1].diffuse, glm::vec3(0));
  EXPECT_EQ(m[2].transmission, glm::vec3(1));
  EXPECT_EQ(m[2].ior, 1.33F);
  EXPECT_EQ(m[2].diffuse, glm::vec3(0));
  EXPECT_EQ(m[3].diffuse, glm::vec3(0.5F));
  EXPECT_EQ(m[3].mirror, glm::vec3(0));
  EXPECT_EQ(m[3].emission, glm::vec3(0, 1.5F, 0));
  EXPECT_EQ(m[4].transmission, glm::vec3(0.75F));
  EXPECT_EQ(m[4].ior, 1.0F);
  EXPECT_EQ(m[5].emission, glm::vec3(1, 0, 0));
  EXPECT_TRUE(warns(scene, "textures"));
}

TEST(SceneGltf, ReadsLightsAndTheFirstCamera) {
  json document = triangle_document();
  document["cameras"] = json::parse(R"([{"type":"orthographic","orthographic":{}},
    {"type":"perspective","perspective":{"yfov":1.5707963267948966,"znear":0.1}}])");
  document["extensions"] = json::parse(R"({"KHR_lights_punctual":{"lights":[
    {"type":"point","intensity":800,"color":[1,0.5,0.25]},
    {"type":"directional","intensity":2}]}})");
  document["nodes"] = json::parse(R"([{"mesh":0,"children":[1,2,3,4]},{"camera":0},
    {"camera":1,"translation":[0,0,9]},
    {"translation":[0,0,20],"extensions":{"KHR_lights_punctual":{"light":0}}},
    {"rotation":[0.70710678118654752,0,0,0.70710678118654752],
     "extensions":{"KHR_lights_punctual":{"light":1}}}])");
  const Scene scene = gltf(document);
  ASSERT_TRUE(scene.camera.has_value());
  EXPECT_EQ(scene.camera->eye, glm::dvec3(0, 0, 9));
  EXPECT_EQ(scene.camera->look, glm::dvec3(0, 0, 8));
  EXPECT_NEAR(scene.camera->fov_degrees, 90.0, 1e-12);
  EXPECT_TRUE(warns(scene, "cameras[0] is left out"));
  ASSERT_EQ(scene.lights.size(), 2U);
  // 800 cd at a distance of 20 are 2 lux, as much as the other light: both become 1.
  EXPECT_NEAR(scene.lights[0].colour.x, 1.0, 1e-6);
  EXPECT_NEAR(scene.lights[0].colour.z, 0.25, 1e-6);
  EXPECT_NEAR(scene.lights[1].colour.x, 1.0, 1e-6);
  EXPECT_EQ(scene.lights[1].kind, Light::Kind::kDirectional);
  EXPECT_NEAR(scene.lights[1].direction.y, 1.0, 1e-12);
}

TEST(SceneGltf, RefusesWrongPartsByPath) {
  const auto with = [](const char* pointer, const json& value) {
    json document = triangle_document();
    document[json::json_pointer(pointer)] = value;
    return document;
  };
  refused(with("/asset/version", "1.0"), {"asset.version"});
  refused(with("/scene", 7), {"scene", "1 scenes"});
  refused(with("/scenes/0/nodes/0", 5), {"scenes[0].nodes[0]", "1 nodes"});
  refused(with("/nodes/0/mesh", -1), {"nodes[0].mesh"});
  refused(with("/nodes/0/mesh", "0"), {"nodes[0].mesh"});
  refused(with("/nodes/0/children", json{0}), {"nodes[0]", "twice"});
  refused(with("/nodes/0/translation", json{1, 2}), {"nodes[0].translation"});
  refused(with("/nodes/0/translation", json{1, 2, "x"}), {"nodes[0].translation[2]"});
  refused(with("/nodes/0/rotation", json{0, 0, 0, 0}), {"nodes[0].rotation"});
  refused(with("/nodes/0/scale", json{1e300, 1, 1}), {"nodes[0]", "range"});
  refused(with("/nodes/0/matrix", json(std::vector<double>(16, 1.0))), {"nodes[0].matrix"});
  refused(with("/meshes/0/primitives/0/attributes", json::object()), {"attributes", "POSITION"});
  refused(with("/meshes/0/primitives/0/mode", 9), {"mode"});
  refused(with("/meshes/0/primitives/0/indices", "1"), {"indices"});
  refused(with("/meshes/0/primitives/0/indices", 0), {"accessors[0]", "SCALAR"});
  refused(with("/meshes/0/primitives/0/material", 0), {"material", "0 materials"});
  refused(with("/accessors/0/type", "VEC2"), {"accessors[0]"});
  refused(with("/accessors/0/componentType", 5124), {"accessors[0].componentType"});
  refused(with("/accessors/1/componentType", 5126), {"accessors[1]"});
  refused(with("/accessors/0/count", 4), {"accessors[0]", "does not fit"});
  refused(with("/accessors/0/count", 18446744073709551615ULL), {"accessors[0].count"});
  refused(with("/accessors/0/byteOffset", 4), {"accessors[0]", "does not fit"});
  refused(with("/accessors/0/byteOffset", -4), {"accessors[0].byteOffset"});
  refused(with("/accessors/0/byteOffset", "4"), {"accessors[0].byteOffset"});
  refused(with("/accessors/0/sparse", json::object()), {"accessors[0]", "sparse"});
  refused(with("/accessors/0/bufferView", 2), {"bufferView", "2 bufferViews"});
  refused(with("/bufferViews/0/byteLength", 1000), {"bufferViews[0]", "48 bytes"});
  refused(with("/bufferViews/0/byteOffset", 20), {"bufferViews[0]", "byte 56 of a buffer of 48"});
  refused(with("/bufferViews/0/byteOffset", 9007199254740991ULL), {"bufferViews[0]"});
  refused(with("/bufferViews/0/byteStride", 4), {"accessors[0]"});
  refused(with("/bufferViews/0/buffer", 1), {"bufferViews[0].buffer"});
  refused(with("/buffers/0/byteLength", 49), {"buffers[0]", "48 are there"});
  refused(with("/buffers/0/uri", "gone.bin"), {"buffers[0].uri", "gone.bin"});
  refused(with("/buffers/0/uri", "data:text/plain,hello"), {"buffers[0].uri", "base64"});
  refused(with("/buffers/0/uri", "data:;base64,a*b"), {"buffers[0].uri"});
  json document = triangle_document();
  document["accessors"][0].erase("bufferView");
  refused(document, {"accessors[0]", "bufferView"});
  document = triangle_document();
  document["buffers"][0].erase("uri");
  refused(document, {"buffers[0]", "BIN"});
}

TEST(SceneGltf, RefusesBadNumbersAndIndicesByElement) {
  std::string bytes = files().at("t.bin");
  const float bad = std::numeric_limits<float>::infinity();
  std::memcpy(bytes.data() + 16, &bad, 4);
  refused(triangle_document(), {"accessors[0]", "element 1 is not finite"}, {{"t.bin", bytes}});
  bytes = files().at("t.bin");
  bytes[44] = 3;
  refused(triangle_document(), {"accessors[1]", "element 2 is 3"}, {{"t.bin", bytes}});
}

TEST(SceneGltf, RefusesExtensionsThatItCannotDoWithout) {
  json document = triangle_document();
  document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const auto scene = load(SceneFormat::kGltf, document.dump(), files());
  ASSERT_FALSE(scene.has_value());
  EXPECT_EQ(scene.error().kind, ErrorKind::kUnsupported);
  EXPECT_NE(scene.error().message.find("KHR_draco"), std::string::npos);
}

TEST(SceneGltf, RefusesBrokenContainersAndJson) {
  const std::string glb = to_glb(to_gltf(builtin("triangle"), ""), files().at("t.bin"));
  EXPECT_EQ(good(SceneFormat::kGlb, glb).triangles.size(), 1U);
  const auto changed = [&](std::size_t at, std::uint32_t word) {
    std::string bytes = glb;
    std::memcpy(bytes.data() + at, &word, 4);
    return bytes;
  };
  expect_refused(SceneFormat::kGlb, changed(0, 1), {"mesh", "GLB"});
  expect_refused(SceneFormat::kGlb, changed(4, 1), {"version 1"});
  expect_refused(SceneFormat::kGlb, changed(8, 0x7FFFFFFF), {"2147483647 bytes"});
  expect_refused(SceneFormat::kGlb, changed(8, 3), {"no JSON"});
  expect_refused(SceneFormat::kGlb, changed(12, 0xFFFFFFFF), {"chunk 0"});
  expect_refused(SceneFormat::kGlb, changed(16, 0), {"not JSON"});
  const std::size_t bin = glb.find(std::string("BIN\0", 4));
  // Longer than what follows by less than the chunk's own header.
  expect_refused(SceneFormat::kGlb, changed(bin - 4, 52), {"chunk 1 announces 52 bytes, but 48"});
  for (const char* text : {"", "{", "[]", "{}", "null", "{\"asset\":{}}", "\xFF\xFE",
                           "{\"asset\":{\"version\":2}}", "{\"asset\":{\"version\":\"2.0\"}}x"}) {
    expect_refused(SceneFormat::kGltf, text, {"mesh"});
  }
  expect_refused(SceneFormat::kGltf, std::string(200'000, '['), {"mesh"});
}

TEST(SceneGltf, DeepHierarchiesAreNoProblem) {
  json document = triangle_document();
  constexpr int kDepth = 50'000;
  json nodes = json::array();
  for (int i = 0; i < kDepth; ++i) {
    nodes.push_back(i + 1 < kDepth ? json{{"children", {i + 1}}} : json{{"mesh", 0}});
  }
  document["nodes"] = nodes;
  EXPECT_EQ(gltf(document).triangles.size(), 1U);
}

}  // namespace
}  // namespace gridrt::scene_test
