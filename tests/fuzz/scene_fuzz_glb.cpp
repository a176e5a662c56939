// The GLB reader on any bytes.
#include "scene_fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gridrt::scene_fuzz::read(gridrt::SceneFormat::kGlb, gridrt::scene_fuzz::text_of(data, size));
  return 0;
}
