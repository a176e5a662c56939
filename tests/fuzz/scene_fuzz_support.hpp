// What the fuzz targets of scene readers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/scene/load.hpp"

namespace gridrt::scene_fuzz {

/// Reads `bytes` as a scene, with a few side files, and aborts unless the answer is an error that
/// names the file, or a scene in which everything is as scene.hpp says.
void read(SceneFormat format, std::string_view bytes);

/// The same with one side file, `name`, of the given content.
void read_with(SceneFormat format, std::string_view bytes, const std::string& name,
               std::string_view side);

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace gridrt::scene_fuzz
