// What the tests of scenes share: loading from text, comparing, and writers of the mesh formats.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "host/scene/load.hpp"

namespace gridrt::scene_test {

/// Side files of a scene in memory, by name.
using Files = std::map<std::string, std::string>;

/// Loads a scene from text and side files under the name "mesh".
Result<Scene> load(SceneFormat format, std::string_view bytes, const Files& files = {});

/// Loads a scene that must be good.
Scene good(SceneFormat format, std::string_view bytes, const Files& files = {});

/// Loads a scene that must be refused with kInput; the message must hold all `parts`.
void expect_refused(SceneFormat format, std::string_view bytes,
                    const std::vector<std::string>& parts, const Files& files = {});

/// Loads a built-in scene that must exist.
Scene builtin(const std::string& spec);

/// The corners of all triangles, nine numbers each.
std::vector<float> corners_of(const Scene& scene);

/// The volume that the triangles enclose, outsides outward.
double volume_of(const Scene& scene);

/// True if every edge of the triangles is met by one in the opposite direction.
bool is_closed(const Scene& scene);

/// One warning holds `part`.
bool warns(const Scene& scene, std::string_view part);

// Writers, which keep every float exactly.
std::string to_obj(const Scene& scene);
std::string to_ply_text(const Scene& scene);
std::string to_ply_binary(const Scene& scene, bool big_endian);
std::string to_stl_text(const Scene& scene);
std::string to_stl_binary(const Scene& scene);
/// The JSON of a glTF file with one mesh, whose buffer is `uri`, or the BIN chunk if empty.
std::string to_gltf(const Scene& scene, const std::string& uri);
/// The buffer of to_gltf(): positions, then indices of 32 bits.
std::string gltf_buffer(const Scene& scene);
std::string to_glb(const std::string& json, const std::string& binary);
std::string base64(std::string_view bytes);

/// Appends a number in a byte order.
template <class T>
void put(std::string& bytes, T value, bool big_endian = false) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
  bytes.append(big_endian ? std::string(raw.rbegin(), raw.rend()) : raw);
}

}  // namespace gridrt::scene_test
