#include "host/scene/load.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
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
  // In pieces, since a pipe has no size to ask for.
  constexpr std::size_t kPiece = std::size_t{1} << 20U;
  std::string bytes;
  while (file) {
    const std::size_t held = bytes.size();
    bytes.resize(held + kPiece);
    file.read(bytes.data() + held, static_cast<std::streamsize>(kPiece));
    bytes.resize(held + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) {
    return fail(ErrorKind::kFile, fmt::format("{}: {}", path.string(), std::strerror(errno)));
  }
  return bytes;
}

// Turns the exceptions of allocation into an error.
template <class Make>
Result<Scene> within_memory(const std::string& name, Make make) {
  const auto refusal = [&] {
    return fail(ErrorKind::kLimit, fmt::format("{}: the scene does not fit into memory", name));
  };
  try {
    return make();
  } catch (const std::bad_alloc&) {
    return refusal();
  } catch (const std::length_error&) {
    return refusal();
  }
}

Result<Scene> read_format(SceneFormat format, std::string_view bytes, const std::string& name,
                          const FileResolver& resolve) {
  switch (format) {
    case SceneFormat::kObj:
      return scene_detail::read_obj(bytes, name, resolve);
    case SceneFormat::kPly:
      return scene_detail::read_ply(bytes, name);
    case SceneFormat::kStl:
      return scene_detail::read_stl(bytes, name);
    case SceneFormat::kGltf:
    case SceneFormat::kGlb:
      return scene_detail::read_gltf(bytes, format == SceneFormat::kGlb, name, resolve);
    case SceneFormat::kToml:
      break;
  }
  return scene_detail::read_toml(bytes, name, resolve);
}

}  // namespace

namespace scene_detail {

Result<SceneFormat> format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
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
  return fail(ErrorKind::kUsage, fmt::format("{}: not a known kind of scene", path), kKnownSpecs);
}

}  // namespace scene_detail

Result<Scene> load_scene_from_memory(SceneFormat format, std::string_view bytes,
                                     const std::string& name, const FileResolver& resolve) {
  const FileResolver no_files = [](const std::string& file) -> Result<std::string> {
    return fail(ErrorKind::kFile, fmt::format("{}: no such file", file));
  };
  return within_memory(name, [&]() -> Result<Scene> {
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
  });
}

Result<Scene> load_scene(const std::string& spec) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (spec.starts_with(kBuiltin)) {
    return within_memory(spec, [&] {
      return scene_detail::make_builtin(std::string_view(spec).substr(kBuiltin.size()));
    });
  }
  const auto format = scene_detail::format_of(spec);
  if (!format) {
    return std::unexpected(format.error());
  }
  return within_memory(spec, [&]() -> Result<Scene> {
    const std::filesystem::path path(spec);
    const auto bytes = read_file(path);
    if (!bytes) {
      return std::unexpected(bytes.error());
    }
    return load_scene_from_memory(*format, *bytes, spec, [&](const std::string& file) {
      return read_file(path.parent_path() / file);
    });
  });
}

}  // namespace gridrt
