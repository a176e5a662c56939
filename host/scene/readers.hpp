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

/// The format that the ending of a path tells; kUsage if it is not known.
Result<SceneFormat> format_of(const std::string& path);

/// Wavefront OBJ with its MTL libraries. Positions are the float32 nearest to the text.
Result<Scene> read_obj(std::string_view text, const std::string& name, const FileResolver& resolve);

/// PLY, text or binary of either byte order; smooth if its vertices have nx, ny and nz.
Result<Scene> read_ply(std::string_view bytes, const std::string& name);

/// STL, text or binary; flat, three vertices a triangle.
Result<Scene> read_stl(std::string_view bytes, const std::string& name);

/// glTF 2.0 as JSON or GLB: the default scene's nodes with triangles, strips and fans.
Result<Scene> read_gltf(std::string_view bytes, bool binary, const std::string& name,
                        const FileResolver& resolve);

/// A .toml scene, which places meshes of the other formats and built-in ones.
Result<Scene> read_toml(std::string_view text, const std::string& name,
                        const FileResolver& resolve);

/// A built-in scene from what follows "builtin:", NAME[?key=value&...].
Result<Scene> make_builtin(std::string_view spec);

}  // namespace gridrt::scene_detail
