// CRC-32C (Castagnoli), the checksum of frames and image sections.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridrt {

/// CRC-32C as in RFC 3720: reflected polynomial 0x82F63B78, initial value and final inversion all
/// ones. Pass the result of the bytes before as `crc` to go on; 0 starts, and is the CRC of no
/// bytes. Uses the processor's instruction where there is one.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t crc = 0);

/// The same by tables alone, on any processor.
std::uint32_t crc32c_table(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace gridrt
