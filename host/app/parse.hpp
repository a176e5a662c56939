// Strict readers of option values; every error names the option and shows what is expected.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/grid/partition.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// A whole number in [least, most].
Result<std::int64_t> parse_integer(std::string_view option, std::string_view text,
                                   std::int64_t least, std::int64_t most);

/// A finite number.
Result<double> parse_number(std::string_view option, std::string_view text);

/// "x,y,z", finite.
Result<glm::dvec3> parse_vector(std::string_view option, std::string_view text);

/// "WxH", each in [1, kMaxPictureSide], at most kMaxPicturePixels in all.
Result<glm::ivec2> parse_size(std::string_view option, std::string_view text);

/// "x,y", each >= 0.
Result<glm::ivec2> parse_pixel(std::string_view option, std::string_view text);

/// "auto" or "NXxNYxNZ".
Result<std::optional<glm::ivec3>> parse_grid(std::string_view option, std::string_view text);

/// "auto" or a number of lattice bits.
Result<int> parse_bits(std::string_view option, std::string_view text);

/// "compact" or "wide".
Result<protocol::Layout> parse_layout(std::string_view option, std::string_view text);
std::string_view layout_name(protocol::Layout layout);

}  // namespace gridrt
