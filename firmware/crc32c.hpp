// CRC-32C, a bit at a time: firmware checks headers of some ten bytes only.
#pragma once

#include <stdint.h>

namespace gridrt::firmware {

/// Of `words` words in memory order of the wire, the lowest byte first.
uint32_t crc32c(const uint32_t* data, uint32_t words);

}  // namespace gridrt::firmware
