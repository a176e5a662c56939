// The TOML reader on any bytes, with one mesh to place.
#include "scene_fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridrt::scene_fuzz;
  read_with(gridrt::SceneFormat::kToml, text_of(data, size), "t.obj",
            "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  return 0;
}
