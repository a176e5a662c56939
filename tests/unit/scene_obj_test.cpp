// OBJ: every form of a face, odd lines, and refusals that name the line.
#include <fmt/format.h>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

using Triples = std::vector<std::array<std::uint32_t, 3>>;

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene obj(const std::string& text, const Files& files = {}) {
  return good(SceneFormat::kObj, text, files);
}

void refused(const std::string& text, const std::vector<std::string>& parts) {
  expect_refused(SceneFormat::kObj, text, parts);
}

TEST(SceneObj, SplitsPolygonsIntoFansFromTheFirstCorner) {
  const Scene scene = obj(std::string(kSquare) + "v 0.5 0.2 0\nf 2 3 4 1 5\n");
  EXPECT_EQ(scene.triangles, (Triples{{1, 2, 3}, {1, 3, 0}, {1, 0, 4}}));
}

TEST(SceneObj, ReadsEveryFormOfACorner) {
  const std::string head = std::string(kSquare) + "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 -2\n";
  for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/1", "f 1//1 2//1 3//2", "f 1/1/1 2/2/1 3/1/2",
                           "f -4 -3 -2", "f -4/-2/-2 -3/-1/-2 -2/-2/-1", "f 1/ 2/ 3/",
                           "f 1// 2// 3//", "fo 1 2 3", "f\t1   2\t 3 \t # 4"}) {
    const Scene scene = obj(head + face + "\n");
    EXPECT_EQ(scene.triangles, (Triples{{0, 1, 2}})) << face;
    const bool has_normals = std::string_view(face).find("1//1") != std::string_view::npos ||
                             std::string_view(face).find("1/1/1") != std::string_view::npos ||
                             std::string_view(face).find("-2/-2") != std::string_view::npos;
    EXPECT_EQ(scene.triangle_normals.empty(), !has_normals) << face;
  }
  const Scene scene = obj(head + "f 1//1 2//1 3//2\n");
  EXPECT_EQ(scene.normals[scene.triangle_normals[0][2]], glm::vec3(0, 0, -1));
}

TEST(SceneObj, NegativeIndicesCountFromTheFace) {
  const Scene scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -3 -2 -1\n");
  EXPECT_EQ(scene.triangles, (Triples{{0, 1, 2}, {1, 2, 3}}));
}

TEST(SceneObj, FacesMayStandBeforeTheirVertices) {
  EXPECT_EQ(obj(std::string("f 1 2 3\n") + kSquare).triangles, (Triples{{0, 1, 2}}));
}

TEST(SceneObj, AFaceWithSomeNormalsIsFlat) {
  const Scene scene = obj(std::string(kSquare) + "vn 0 0 1\nf 1//1 2//1 3\nf 1//1 2//1 3//1\n");
  EXPECT_EQ(scene.triangle_normals[0], (std::array{kNoIndex, kNoIndex, kNoIndex}));
  EXPECT_EQ(scene.triangle_normals[1], (std::array{0U, 0U, 0U}));
}

TEST(SceneObj, AZeroNormalMakesItsFacesFlat) {
  const Scene scene = obj(std::string(kSquare) +
                          "vn 0 0 0\nvn 0 1e-30 0\nf 1//1 2//2 3//2\n"
                          "f 1//2 2//2 3//2\n");
  EXPECT_EQ(scene.triangle_normals[0][0], kNoIndex);
  EXPECT_EQ(scene.normals[scene.triangle_normals[1][0]], glm::vec3(0, 1, 0));
}

TEST(SceneObj, LineEndsAndJoinedLinesMakeNoDifference) {
  const std::string text = std::string("# c\n") + kSquare + "s off\nf 1 2 3 4\n";
  const Scene expected = obj(text);
  std::string crlf;
  std::string cr;
  for (const char c : text) {
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    cr += c == '\n' ? '\r' : c;
  }
  for (const std::string& other : {crlf, cr, text.substr(0, text.size() - 1)}) {
    EXPECT_EQ(obj(other).triangles, expected.triangles);
    EXPECT_EQ(corners_of(obj(other)), corners_of(expected));
  }
  EXPECT_EQ(obj(std::string(kSquare) + "f 1 2 \\\n3 \\\r\n4\n").triangles, expected.triangles);
  EXPECT_EQ(obj(std::string(kSquare) + "f 1 2 3 4 \\").triangles, expected.triangles);
}

TEST(SceneObj, ReadsLinesOfAMillionCharacters) {
  std::string text = kSquare;
  text += "# " + std::string(1'000'000, 'x') + "\n";
  text += "f 1" + std::string(1'000'000, ' ') + "2 3\n";
  text += "v 0." + std::string(1'000'000, '1') + " 0 0\nf";
  constexpr std::size_t kCorners = 200'000;
  for (std::size_t i = 0; i < kCorners; ++i) {
    text += fmt::format(" {}", i % 4 + 1);
  }
  const Scene scene = obj(text + "\n");
  EXPECT_EQ(scene.triangles.size(), 1 + kCorners - 2);
  EXPECT_EQ(scene.positions[4].x, 0.11111111F);
  refused(std::string("\n\nf ") + std::string(1'000'000, '9') + " 1 2\n", {"mesh:3:", "999..."});
  refused(std::string(1'000'000, 'q') + "\n", {"mesh:1:", "qqq..."});
}

TEST(SceneObj, VertexWeightsAndColoursAreAllowed) {
  const Scene scene = obj("v 1 2 3 0.5\nv 1 2 3 0.1 0.2 0.3\nv 4 5 6 0.1 0.2 0.3 1\nf 1 2 3\n");
  EXPECT_EQ(scene.positions[2], glm::vec3(4, 5, 6));
}

TEST(SceneObj, SmoothingGroupsGiveNormalsOnlyWithinThem) {
  // Two faces that meet at a right angle: one group makes the edge smooth, two do not.
  const std::string vertices = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\n";
  const Scene one = obj(vertices + "s 1\nf 1 2 3\nf 1 4 2\n");
  ASSERT_EQ(one.triangle_normals.size(), 2U);
  EXPECT_EQ(one.triangle_normals[0][0], one.triangle_normals[1][0]);
  EXPECT_NEAR(one.normals[one.triangle_normals[0][1]].x, 0.70710678, 1e-6);
  const Scene two = obj(vertices + "s 1\nf 1 2 3\ns 2\nf 1 4 2\n");
  EXPECT_EQ(two.normals[two.triangle_normals[0][0]], glm::vec3(0, 1, 0));
  EXPECT_EQ(two.normals[two.triangle_normals[1][0]], glm::vec3(1, 0, 0));
  EXPECT_TRUE(obj(vertices + "s 1\ns off\nf 1 2 3\n").triangle_normals.empty());
  const Scene given = obj(vertices + "vn 0 0 1\ns 1\nf 1//1 2//1 3//1\n");
  EXPECT_EQ(given.normals[given.triangle_normals[0][0]], glm::vec3(0, 0, 1));
  refused("s x\n", {"mesh:1:", "'x'"});
}

TEST(SceneObj, WarnsOfWhatItLeavesOut) {
  EXPECT_TRUE(warns(obj(std::string(kSquare) + "l 1 2\np 3\nf 1 2 3\n"), "2 points, lines"));
  EXPECT_TRUE(warns(obj(kSquare), "no faces"));
  EXPECT_TRUE(warns(obj(""), "no faces"));
  EXPECT_TRUE(warns(obj("mtllib gone.mtl\nusemtl red\n"), "gone.mtl"));
  EXPECT_TRUE(warns(obj("usemtl red\n"), "mesh:1: material 'red'"));
}

TEST(SceneObj, RefusesBadVerticesByLine) {
  for (const char* vertex : {"v nan 0 0", "v 0 inf 0", "v 0 0 -inf", "v 0 0 1e39", "v 0 x 0",
                             "v 0 0", "v", "v 0 0 0 nan", "v 1,0 2 3", "v 1 2 3 4 5 6 7 8 9",
                             "vn nan 0 0", "vn 0 0", "vn 1 2 3 4", "vn inf 0 0", "vn 0 1e999 0"}) {
    refused(std::string("# a comment\n\n") + vertex + "\n", {"mesh:3:"});
  }
  refused("v 0 0 nan\n", {"mesh:1:", "'nan'", "finite"});
  refused("v 0 0 1e39\n", {"'1e39'", "range"});
}

TEST(SceneObj, RefusesBadFacesByLine) {
  for (const char* face : {"f", "f 1", "f 1 2", "f 0 1 2", "f 1 2 5", "f 1 2 -5", "f 1 2 x",
                           "f 1/9 2/1 3/1", "f 1/1/1 2/1/1 3/1/9", "f 1//0 2//1 3//1",
                           "f 1/1/-9 2 3", "f 1/-9 2 3", "f 1 2 3.0", "f 1 2 99999999999999999999",
                           "f 1 2 4294967297", "f / 1 2", "f 1 2 # 3", "f 1 2 -99999999999"}) {
    refused(std::string(kSquare) + "vt 0 0\nvn 0 0 1\n" + face + "\n\n", {"mesh:7:"});
  }
  refused(std::string(kSquare) + "f 1 2 9\n", {"mesh:5:", "vertex index 9 of only 4"});
}

TEST(SceneObj, RefusesJunkByLine) {
  refused("hello world\n", {"mesh:1:", "'hello'"});
  refused(std::string("v 0 0 0\n\0\1\2\xFF junk\n", 18), {"mesh:2:"});
  refused(
      "\x7F"
      "ELF\x02\x01",
      {"mesh:1:"});
}

TEST(SceneObj, TakesConcaveAndCrookedPolygonsAsTheyCome) {
  const Scene scene = obj("v 0 0 0\nv 2 0 0\nv 0.1 0.1 1\nv 0 2 0\nf 1 2 3 4\nf 1 1 1 1\n");
  EXPECT_EQ(scene.triangles, (Triples{{0, 1, 2}, {0, 2, 3}, {0, 0, 0}, {0, 0, 0}}));
}

}  // namespace
}  // namespace gridrt::scene_test
