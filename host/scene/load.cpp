#include "host/scene/load.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "host/scene/assemble.hpp"
#include "host/scene/readers.hpp"

namespace gridrt {
namespace {

constexpr const char* kKnownSpecs =
    "give a .obj, .ply, .stl, .gltf, .glb or .toml file, or builtin:NAME (see --help)";

Result<std::string> read_file(const std::filesystem::path& path) {
  std::error_code status;
  if (std::filesystem::is_directory(path, status)) {
    return fail(ErrorKind::kFile, fmt::format("{}: is a directory", path.string()), kKnownSpecs);
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return fail(ErrorKind::kFile, fmt::format("{}: {}", path.string(), std::strerror(errno)));
  }
  std::string bytes;
  const auto size = std::filesystem::file_size(path, status);
  if (!status) {
    bytes.reserve(size);
  }
  bytes.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  if (file.bad()) {
    return fail(ErrorKind::kFile, fmt::format("{}: {}", path.string(), std::strerror(errno)));
  }
  return bytes;
}

Result<SceneFormat> format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::pair<const char*, SceneFormat> kFormats[] = {
      {".obj", SceneFormat::kObj},   {".ply", SceneFormat::kPly}, {".stl", SceneFormat::kStl},
      {".gltf", SceneFormat::kGltf}, {".glb", SceneFormat::kGlb}, {".toml", SceneFormat::kToml}};
  for (const auto& [known, format] : kFormats) {
    if (extension == known) {
      return format;
    }
  }
  return fail(ErrorKind::kUsage, fmt::format("{}: not a known kind of scene", path.string()),
              kKnownSpecs);
}

Result<Scene> read_format(SceneFormat format, std::string_view bytes, const std::string& name,
                          const FileResolver& resolve) {
  switch (format) {
    case SceneFormat::kObj:
      return scene_detail::read_obj(bytes, name, resolve);
    case SceneFormat::kPly:
    case SceneFormat::kStl:
    case SceneFormat::kGltf:
    case SceneFormat::kGlb:
    case SceneFormat::kToml:
      break;
  }
  return fail(ErrorKind::kUnsupported, fmt::format("{}: this format is not read", name));
}

}  // namespace

Result<Scene> load_scene_from_memory(SceneFormat format, std::string_view bytes,
                                     const std::string& name, const FileResolver& resolve) {
  const FileResolver no_files = [](const std::string& file) -> Result<std::string> {
    return fail(ErrorKind::kFile, fmt::format("{}: no such file", file));
  };
  Result<Scene> scene = read_format(format, bytes, name, resolve ? resolve : no_files);
  if (!scene) {
    return scene;
  }
  if (const auto ok = scene_detail::check_scene(*scene, name); !ok) {
    return std::unexpected(ok.error());
  }
  if (scene->lights.empty() && format != SceneFormat::kToml) {
    scene_detail::add_default_lights(*scene);
  }
  return scene;
}

Result<Scene> load_scene(const std::string& spec) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (spec.starts_with(kBuiltin)) {
    return scene_detail::make_builtin(std::string_view(spec).substr(kBuiltin.size()));
  }
  const std::filesystem::path path(spec);
  const auto format = format_of(path);
  if (!format) {
    return std::unexpected(format.error());
  }
  const auto bytes = read_file(path);
  if (!bytes) {
    return std::unexpected(bytes.error());
  }
  return load_scene_from_memory(*format, *bytes, spec, [&](const std::string& file) {
    return read_file(path.parent_path() / file);
  });
}

}  // namespace gridrt
