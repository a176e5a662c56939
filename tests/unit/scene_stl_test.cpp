// STL: telling text from binary, and refusals that name line or triangle.
#include <cstring>
#include <limits>

#include "scene_support.hpp"

namespace gridrt::scene_test {
namespace {

Scene stl(const std::string& text) { return good(SceneFormat::kStl, text); }
void refused(const std::string& text, const std::vector<std::string>& parts) {
  expect_refused(SceneFormat::kStl, text, parts);
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

TEST(SceneStl, TellsBinaryFromTextWhateverTheHeaderSays) {
  const std::string binary = to_stl_binary(builtin("cube"));
  ASSERT_TRUE(binary.starts_with("solid"));
  EXPECT_EQ(stl(binary).triangles.size(), 12U);
  // Data after the triangles: no longer the exact length, but still no text.
  const Scene longer = stl(binary + std::string(7, '\0'));
  EXPECT_EQ(longer.triangles.size(), 12U);
  EXPECT_TRUE(warns(longer, "after the last triangle"));
  EXPECT_EQ(stl("\n  solid\n" + kFacet + "endsolid").triangles.size(), 1U);
}

TEST(SceneStl, ReadsTextInAnyCaseAndSpacing) {
  EXPECT_EQ(stl("SOLID\nFACET NORMAL 0 0 1 OUTER LOOP\nVERTEX 0 0 0\nVertex 1 0 0 vertex 0\n1 0 "
                "ENDLOOP ENDFACET ENDSOLID\n")
                .triangles.size(),
            1U);
  EXPECT_EQ(
      stl("solid a facet\r\n" + kFacet + "endsolid a facet\r\nsolid b\n" + kFacet + "endsolid\n")
          .triangles.size(),
      2U);
  EXPECT_TRUE(warns(stl("solid nothing\nendsolid nothing\n"), "no facets"));
}

TEST(SceneStl, RefusesBadTextByLine) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string facet = kFacet;
    facet.replace(facet.find(from), from.size(), to);
    return "solid x\n" + facet + "endsolid x\n";
  };
  refused(with("vertex 1 0 0", "vertex 1 nan 0"), {"mesh:5:", "finite"});
  refused(with("vertex 1 0 0", "vertex 1 1e39 0"), {"mesh:5:", "range"});
  refused(with("normal 0 0 1", "normal 0 inf 1"), {"mesh:2:", "finite"});
  refused(with("vertex 1 0 0\n", ""), {"mesh:6:", "'endloop'", "vertex"});
  refused(with("endloop", "vertex 1 1 1"), {"mesh:7:", "'vertex'"});
  refused(with("vertex 1 0 0", "vertex 1 0"), {"mesh:6:", "'vertex' is not a number"});
  refused(with("outer loop", "outer"), {"mesh:4:", "loop"});
  refused("solid x\n" + kFacet, {"mesh:8:", "endsolid"});
  refused("solid x\nsolid y\n", {"mesh:2:", "'solid'"});
  refused("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", {"mesh:4:"});
  refused("solid x\n" + kFacet + "endsolid\njunk\n", {"mesh:10:", "'junk'"});
}

TEST(SceneStl, RefusesBadBinaryByTriangle) {
  std::string binary = to_stl_binary(builtin("cube"));
  refused(binary.substr(0, binary.size() - 1), {"12 triangles are announced, but only 11"});
  refused(std::string(60, '\0'), {"60 bytes"});
  refused(binary.substr(0, 60), {"mesh:1:"});  // a text so far
  refused("", {"0 bytes"});
  refused("\x01\x02", {"mesh", "not an STL file"});
  std::string nan = binary;
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data() + 84 + 3 * 50 + 12, &bad, 4);
  refused(nan, {"triangle 3", "vertex is not finite"});
  std::string normal = binary;
  std::memcpy(normal.data() + 84 + 50, &bad, 4);
  refused(normal, {"triangle 1", "normal is not finite"});
  std::string huge = binary;
  std::memset(huge.data() + 80, 0xFF, 4);
  refused(huge, {"4294967295 triangles are announced"});
}

}  // namespace
}  // namespace gridrt::scene_test
