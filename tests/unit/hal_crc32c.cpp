// CRC-32C against published values and a bit-by-bit definition.
#include <random>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "hal/crc32c.hpp"

namespace gridrt {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  std::vector<std::byte> bytes;
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

/// The definition, one bit at a time.
std::uint32_t crc_by_bits(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::byte b : bytes) {
    crc ^= static_cast<std::uint32_t>(b);
    for (int i = 0; i < 8; ++i) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0x82F63B78U : 0U);
  }
  return ~crc;
}

struct Vector {
  std::vector<std::byte> bytes;
  std::uint32_t crc;
};

/// RFC 3720, appendix B.4, and the check value of the CRC catalogue.
std::vector<Vector> published() {
  std::vector<Vector> vectors{{bytes_of("123456789"), 0xE3069283U},
                              {std::vector(32, std::byte{0}), 0x8A9136AAU},
                              {std::vector(32, std::byte{0xFF}), 0x62A8AB43U}};
  std::vector<std::byte> up;
  std::vector<std::byte> down;
  for (unsigned i = 0; i < 32; ++i) {
    up.push_back(static_cast<std::byte>(i));
    down.push_back(static_cast<std::byte>(31 - i));
  }
  vectors.push_back({up, 0x46DD794EU});
  vectors.push_back({down, 0x113FDB5CU});
  // An iSCSI SCSI Read (10) command PDU.
  std::vector<std::byte> pdu(48, std::byte{0});
  pdu[0] = std::byte{0x01};
  pdu[1] = std::byte{0xC0};
  pdu[16] = std::byte{0x14};
  pdu[22] = std::byte{0x04};
  pdu[27] = std::byte{0x14};
  pdu[31] = std::byte{0x18};
  pdu[32] = std::byte{0x28};
  pdu[40] = std::byte{0x02};
  vectors.push_back({pdu, 0xD9963A56U});
  return vectors;
}

TEST(Crc32c, PublishedValues) {
  for (const Vector& v : published()) {
    EXPECT_EQ(crc32c(v.bytes), v.crc);
    EXPECT_EQ(crc32c_table(v.bytes), v.crc);
  }
}

TEST(Crc32c, NoBytesIsZero) {
  EXPECT_EQ(crc32c({}), 0U);
  EXPECT_EQ(crc32c_table({}), 0U);
}

TEST(Crc32c, EveryLengthAndAlignment) {
  std::mt19937 random(1);
  std::vector<std::byte> bytes(96);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 0xFFU);
  for (std::size_t first = 0; first < 9; ++first) {
    for (std::size_t size = 0; size <= 64; ++size) {
      const auto part = std::span(bytes).subspan(first, size);
      EXPECT_EQ(crc32c(part), crc_by_bits(part)) << first << " " << size;
      EXPECT_EQ(crc32c_table(part), crc_by_bits(part)) << first << " " << size;
    }
  }
}

TEST(Crc32c, GoesOnInPieces) {
  const std::vector<std::byte> bytes = bytes_of("the quick brown fox jumps over the lazy dog");
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    const auto all = std::span(bytes);
    EXPECT_EQ(crc32c(all.subspan(cut), crc32c(all.first(cut))), crc32c(all));
    EXPECT_EQ(crc32c_table(all.subspan(cut), crc32c_table(all.first(cut))), crc32c(all));
  }
}

}  // namespace
}  // namespace gridrt
