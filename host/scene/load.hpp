// Reads a scene from a file of any known format, from memory, or makes a built-in one.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// The formats that a scene is read from.
enum class SceneFormat { kObj, kPly, kStl, kGltf, kGlb, kToml };

/// Hands out the bytes of a file that a scene refers to (an MTL library, a glTF buffer, a mesh of a
/// .toml scene) by the name that stands in the scene.
using FileResolver = std::function<Result<std::string>(const std::string& name)>;

/// Loads `spec`: the path of a .obj, .ply, .stl, .gltf, .glb or .toml file, or
/// `builtin:NAME[?key=value&...]`. Formats that cannot hold lights, or hold none, get default ones.
/// Errors: kUsage for a spec of no known kind, kFile for unreadable files, kInput for bad content
/// (the message names file and line or element), kLimit for more triangles than ids.
Result<Scene> load_scene(const std::string& spec);

/// The same from bytes already in memory; `name` stands for the file in messages. Files that the
/// scene refers to come from `resolve`; without one, there are none.
Result<Scene> load_scene_from_memory(SceneFormat format, std::string_view bytes,
                                     const std::string& name, const FileResolver& resolve = {});

/// One built-in scene for a help text: its name, a line about it, and its options with defaults.
struct BuiltinInfo {
  std::string name;
  std::string summary;
  std::vector<std::string> options;  ///< "key=default  what it does"
};

/// All built-in scenes in the order of their names.
std::vector<BuiltinInfo> builtin_names();

}  // namespace gridrt
