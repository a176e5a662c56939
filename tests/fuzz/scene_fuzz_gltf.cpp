// The glTF reader: a JSON document up to the first NUL, and what follows as the file "b".
#include <algorithm>

#include "scene_fuzz_support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridrt::scene_fuzz;
  const std::string_view input = text_of(data, size);
  const std::size_t end = std::min(input.find('\0'), input.size());
  read_with(gridrt::SceneFormat::kGltf, input.substr(0, end), "b",
            input.substr(std::min(end + 1, input.size())));
  return 0;
}
