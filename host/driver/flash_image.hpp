// What a board's flash holds, so that the board has a scene as soon as it has power.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/error.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// 16 bytes that are equal for equal images as a device sees them, and else, but for chance
/// (2^-64), not. They protect from mistakes, not from somebody who wants two images to look alike.
using Fingerprint = std::array<std::uint8_t, 16>;
Fingerprint fingerprint(const Image& image);

/// FlashHeader and the frames that load `image`, for flash_address of the board's flash. Errors:
/// kUnsupported and kLimit as check_fits() (upload.hpp); kLimit for one of several chunks of a
/// scene, or if it is larger than flash_max_bytes.
Result<std::vector<std::byte>> flash_image(const Image& image,
                                           const protocol::CapabilitiesReport& capabilities);

}  // namespace gridrt
