// PLY: types, byte orders, unknown parts, and refusals that name line, element or byte.
#include <limits>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

using Triples = std::vector<std::array<std::uint32_t, 3>>;

const std::string kHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

Scene ply(const std::string& text) { return good(SceneFormat::kPly, text); }
void refused(const std::string& text, const std::vector<std::string>& parts) {
  expect_refused(SceneFormat::kPly, text, parts);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(ScenePly, ReadsTextWithNormalsAndUnknownElements) {
  const Scene scene =
      ply("ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 2\r\nproperty float f\r\n"
          "property list uchar float many\r\nelement face 2\r\nproperty uchar flag\r\n"
          "property list uchar uint vertex_index\r\nelement vertex 4\r\nproperty double x\r\n"
          "property double y\r\nproperty double z\r\nproperty float nx\r\nproperty float ny\r\n"
          "property float nz\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n"
          "1 0\r\n2 3 7 8 9\r\n0 3 0 1 2\r\n0 4 0 1 2 3\r\n0 0 0 0 0 2\r\n1 0 0 0 0 1\r\n"
          "\r\n0.1 1 0 0 0 1\r\n0 1 0 0 0 0\r\n5\r\n");
  EXPECT_EQ(scene.triangles, (Triples{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.positions[2].x, 0.1F);
  EXPECT_EQ(scene.normals[scene.triangle_normals[0][0]], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.triangle_normals[2][0], kNoIndex);  // its last normal is zero
  EXPECT_TRUE(warns(scene, "'camera'"));
  EXPECT_TRUE(warns(scene, "'edge'"));
}

// All eight types as coordinates and as indices, in both byte orders.
TEST(ScenePly, ReadsEveryTypeInBothByteOrders) {
  const auto check = []<class T>(T, const char* name, bool big) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\nelement vertex 3\nproperty " + name + " x\nproperty " + name +
                        " y\nproperty " + name + " z\nelement face 1\nproperty list " +
                        (std::numeric_limits<T>::is_integer ? name : "int8") + " " +
                        (std::numeric_limits<T>::is_integer ? name : "int32") +
                        " vertex_indices\nend_header\n";
    for (int i = 0; i < 9; ++i) {
      put<T>(bytes, static_cast<T>(i * 13), big);
    }
    if constexpr (std::numeric_limits<T>::is_integer) {
      for (const int i : {3, 0, 1, 2}) {
        put<T>(bytes, static_cast<T>(i), big);
      }
    } else {
      put<std::int8_t>(bytes, 3, big);
      for (const int i : {0, 1, 2}) {
        put<std::int32_t>(bytes, i, big);
      }
    }
    const Scene scene = ply(bytes);
    EXPECT_EQ(scene.triangles, (Triples{{0, 1, 2}})) << name;
    ASSERT_EQ(scene.positions.size(), 3U) << name;
    EXPECT_EQ(scene.positions[2], glm::vec3(78, 91, 104)) << name;
  };
  for (const bool big : {false, true}) {
    check(std::int8_t{}, "char", big);
    check(std::uint8_t{}, "uint8", big);
    check(std::int16_t{}, "short", big);
    check(std::uint16_t{}, "uint16", big);
    check(std::int32_t{}, "int", big);
    check(std::uint32_t{}, "uint", big);
    check(float{}, "float32", big);
    check(double{}, "double", big);
  }
}

TEST(ScenePly, NegativeIntegersStayNegative) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty char x\nproperty short y\n"
      "property int z\nend_header\n";
  put<std::int8_t>(bytes, -3, true);
  put<std::int16_t>(bytes, -300, true);
  put<std::int32_t>(bytes, -70000, true);
  const Scene scene = ply(bytes);
  ASSERT_EQ(scene.positions.size(), 1U);
  EXPECT_EQ(scene.positions[0], glm::vec3(-3, -300, -70000));
}

TEST(ScenePly, BinaryDataMayBeginWithALineFeed) {
  // Lines that end in CR alone, and a first data byte of 10.
  std::string bytes =
      "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\r"
      "property uchar y\rproperty uchar z\rend_header\r\n\x02\x03";
  const Scene scene = ply(bytes);
  ASSERT_EQ(scene.positions.size(), 1U);
  EXPECT_EQ(scene.positions[0], glm::vec3(10, 2, 3));
}

TEST(ScenePly, RefusesBadHeadersByLine) {
  for (const auto& [from, to, part] : std::vector<std::array<std::string, 3>>{
           {"ply\n", "plx\n", "mesh:1:"},
           {"format ascii 1.0", "format ascii 2.0", "mesh:2:"},
           {"format ascii 1.0", "format utf8 1.0", "mesh:2:"},
           {"format ascii 1.0\n", "", "no format"},
           {"vertex 3", "vertex -3", "mesh:3:"},
           {"vertex 3", "vertex", "mesh:3:"},
           {"vertex 3", "vertex 3x", "mesh:3:"},
           {"float x", "half x", "mesh:4:"},
           {"float y", "float x", "mesh:5:"},
           {"property float z", "property float", "mesh:6:"},
           {"property float z\n", "", "x, y and z"},
           {"element face", "element vertex", "mesh:7:"},
           {"uchar int", "float int", "mesh:8:"},
           {"int vertex_indices", "float vertex_indices", "vertex_indices"},
           {"vertex_indices", "corners", "vertex_indices"},
           {"end_header\n", "", "mesh:"},
           {"element vertex 3\n", "", "mesh:3:"}}) {
    refused(replaced(kHead, from, to) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"mesh", part});
  }
}

TEST(ScenePly, RefusesCountsThatTheFileCannotHold) {
  refused(replaced(kHead, "vertex 3", "vertex 4000000000") + "0 0 0\n",
          {"4000000000 elements 'vertex'"});
  refused(replaced(kHead, "face 1", "face 9000000000000000000") + "0 0 0\n0 0 0\n0 0 0\n",
          {"elements 'face'"});
  refused(replaced(kHead, "vertex 3", "vertex 99999999999999999999"), {"mesh:3:"});
  refused(
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n12345678901234567890123",
      {"only 23 bytes"});
}

TEST(ScenePly, RefusesBadElementsByLine) {
  const std::string good_vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(ply(kHead + good_vertices + "3 0 1 2\n").triangles.size(), 1U);
  refused(kHead + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", {"mesh:11: vertex 1", "finite"});
  refused(kHead + "0 0 0\n1 0 0\n0 1 1e39\n3 0 1 2\n", {"mesh:12: vertex 2", "range"});
  refused(kHead + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", {"mesh:11:", "fewer"});
  refused(kHead + "0 0 0\n1 0 0 9\n0 1 0\n3 0 1 2\n", {"mesh:11:", "more values"});
  refused(kHead + good_vertices + "3 0 1 3\n", {"mesh:13: face 0", "index 3 of only 3"});
  refused(kHead + good_vertices + "3 0 1 -1\n", {"face 0", "index -1"});
  refused(kHead + good_vertices + "2 0 1\n", {"face 0", "2 corners"});
  refused(kHead + good_vertices + "0\n", {"face 0", "0 corners"});
  refused(kHead + good_vertices + "-1 0 1 2\n", {"face 0", "list of -1"});
  refused(kHead + good_vertices + "200 0 1 2\n", {"face 0", "list of 200"});
  refused(kHead + good_vertices + "3 0 1 1.5\n", {"face 0", "'1.5'"});
  refused(kHead + good_vertices + "3 0 1\n", {"face 0"});
  refused(kHead + good_vertices + "   \n   \n", {"face 0", "ends before"});
}

TEST(ScenePly, RefusesBadBinaryElementsByByte) {
  const auto binary = [](double x, std::int32_t corner) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\n"
        "property double y\nproperty double z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    put(bytes, 0.0);
    put(bytes, x);
    put(bytes, 0.0);
    put<std::uint8_t>(bytes, 3);
    put<std::int32_t>(bytes, 0);
    put<std::int32_t>(bytes, 0);
    put<std::int32_t>(bytes, corner);
    return bytes;
  };
  EXPECT_EQ(ply(binary(0.1, 0)).positions[0].y, 0.1F);
  refused(binary(std::numeric_limits<double>::quiet_NaN(), 0), {"vertex 0 (byte", "not finite"});
  refused(binary(1e39, 0), {"vertex 0 (byte", "range"});
  refused(binary(-std::numeric_limits<double>::infinity(), 0), {"vertex 0", "not finite"});
  refused(binary(0.0, 1), {"face 0 (byte", "index 1 of only 1"});
  refused(binary(0.0, -5), {"face 0", "index -5"});
}

TEST(ScenePly, WarnsOfEmptyAndSurplusData) {
  EXPECT_TRUE(
      warns(ply(replaced(kHead, "face 1", "face 0") + "0 0 0\n1 0 0\n0 1 0\n"), "no faces"));
  EXPECT_TRUE(warns(ply(kHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n7\n"), "after the last element"));
}

}  // namespace
}  // namespace gridrt::scene_test
