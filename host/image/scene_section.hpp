// The Scene section: everything that shading needs, so that a .grt renders like its source.
#pragma once

#include <span>
#include <vector>

#include "hal/error.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// Version of the section's format, its first word.
inline constexpr std::uint32_t kSceneVersion = 1;

/// Serialises a scene; `warnings` are left out. Errors: kInput if an index is out of range or a
/// number is not valid (the same checks as unpack_scene), kLimit for 2^32 items or more.
Result<std::vector<std::byte>> pack_scene(const Scene& scene);

/// Reads what pack_scene wrote. Errors: kInput for another version, a wrong size, an index out of
/// range, a number that is not finite or out of its range; the message names the element.
Result<Scene> unpack_scene(std::span<const std::byte> bytes);

}  // namespace gridrt
