// The MTL reader on any bytes, through an OBJ file that uses the library.
#include "scene_fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridrt::scene_fuzz;
  constexpr const char* kObj =
      "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
  read_with(gridrt::SceneFormat::kObj, kObj, "mesh.mtl", text_of(data, size));
  return 0;
}
