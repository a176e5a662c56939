#include "firmware/crc32c.hpp"

namespace gridrt::firmware {

uint32_t crc32c(const uint32_t* data, uint32_t words) {
  constexpr uint32_t kPolynomial = 0x82F63B78U;  // Castagnoli, reflected
  uint32_t crc = ~0U;
  for (uint32_t w = 0; w < words; ++w) {
    crc ^= data[w];
    for (uint32_t bit = 0; bit < 32; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? kPolynomial : 0U);
    }
  }
  return ~crc;
}

}  // namespace gridrt::firmware
