// An image onto a device, whatever the link does to the frames on the way.
#pragma once

#include <cstdint>

#include "host/driver/connection.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// Refuses an image that the device cannot hold, before anything is sent: kUnsupported or kLimit
/// with the sizes and what would help.
Result<void> check_fits(const Image& image, const protocol::CapabilitiesReport& capabilities);

/// Sends every device section and commits. Sections that the device misses or finds damaged are
/// sent again; `retries` counts them. Errors: kTimeout, kTransport, kDevice.
Result<void> upload(Connection& connection, const Image& image,
                    const protocol::CapabilitiesReport& capabilities, std::uint64_t& retries);

}  // namespace gridrt
