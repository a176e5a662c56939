// MTL material libraries of OBJ files.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::scene_detail {

/// Index of each material of a scene by its name.
using MaterialIndex = std::map<std::string, std::uint32_t, std::less<>>;

/// Adds the materials of the library `text`; of several with one name, the first counts. Kd, Ks,
/// Ns, Ke and Ni are taken as they are; Ka times 0.1, since exporters write 1 1 1 and the ambient
/// light of a scene is 1; without Ka, a tenth of Kd. illum 0 is constant colour; 3 and 5 mirror
/// with Ks; 4, 6, 7 and 9 are glass, which transmits Tf (what it mirrors follows from Ni when
/// rendered); in other models d below 1 (or Tr above 0) lets Tf (1 - d) through unbent. Textures
/// and what is out of range become warnings. Errors name `name` and line: not a number, NaN or
/// infinite, an unknown statement.
Result<void> read_mtl(std::string_view text, const std::string& name, Scene& scene,
                      MaterialIndex& index);

}  // namespace gridrt::scene_detail
