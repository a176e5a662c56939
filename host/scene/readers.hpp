// The readers of the formats, one a file; load.cpp chooses among them. All of them check whatever
// they read against what is there, and return scenes that check_scene() accepts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "host/scene/load.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::scene_detail {

/// Wavefront OBJ with its MTL libraries. Positions are the float32 nearest to the text.
Result<Scene> read_obj(std::string_view text, const std::string& name, const FileResolver& resolve);

/// A built-in scene from what follows "builtin:", NAME[?key=value&...].
Result<Scene> make_builtin(std::string_view spec);

}  // namespace gridrt::scene_detail
