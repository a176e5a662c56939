#include "hal/crc32c.hpp"

#include <array>
#include <cstring>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace gridrt {
namespace {

constexpr std::uint32_t kPolynomial = 0x82F63B78U;
constexpr std::size_t kSlices = 8;
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

// kTables[k][b]: the CRC register after byte b and k zero bytes ("slicing by 8", Kounavis and
// Berry 2005).
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t crc = b;
    for (int i = 0; i < 8; ++i) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? kPolynomial : 0U);
    }
    tables[0][b] = crc;
  }
  for (std::size_t k = 1; k < kSlices; ++k) {
    for (std::size_t b = 0; b < 256; ++b) {
      const std::uint32_t before = tables[k - 1][b];
      tables[k][b] = (before >> 8U) ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}
constexpr Tables kTables = make_tables();

constexpr std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
  return static_cast<std::uint32_t>(bytes[i]);
}

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) std::uint32_t crc32c_instruction(std::span<const std::byte> bytes,
                                                                   std::uint32_t crc) {
  std::uint64_t state = ~crc;
  while (bytes.size() >= sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof word);
    state = _mm_crc32_u64(state, word);
    bytes = bytes.subspan(sizeof word);
  }
  auto rest = static_cast<std::uint32_t>(state);
  for (const std::byte b : bytes) {
    rest = _mm_crc32_u8(rest, static_cast<unsigned char>(b));
  }
  return ~rest;
}
#endif

}  // namespace

std::uint32_t crc32c_table(std::span<const std::byte> bytes, std::uint32_t crc) {
  std::uint32_t state = ~crc;
  while (bytes.size() >= kSlices) {
    const std::uint32_t low = state ^ (byte_at(bytes, 0) | byte_at(bytes, 1) << 8U |
                                       byte_at(bytes, 2) << 16U | byte_at(bytes, 3) << 24U);
    state = kTables[7][low & 0xFFU] ^ kTables[6][(low >> 8U) & 0xFFU] ^
            kTables[5][(low >> 16U) & 0xFFU] ^ kTables[4][low >> 24U] ^
            kTables[3][byte_at(bytes, 4)] ^ kTables[2][byte_at(bytes, 5)] ^
            kTables[1][byte_at(bytes, 6)] ^ kTables[0][byte_at(bytes, 7)];
    bytes = bytes.subspan(kSlices);
  }
  for (const std::byte b : bytes) {
    state = (state >> 8U) ^ kTables[0][(state ^ static_cast<std::uint32_t>(b)) & 0xFFU];
  }
  return ~state;
}

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t crc) {
#if defined(__x86_64__)
  static const bool has_instruction = __builtin_cpu_supports("sse4.2") != 0;
  if (has_instruction) {
    return crc32c_instruction(bytes, crc);
  }
#endif
  return crc32c_table(bytes, crc);
}

}  // namespace gridrt
