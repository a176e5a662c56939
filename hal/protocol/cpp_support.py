"""The fixed parts of gridrt_protocol.hpp: byte and bit access that needs no library."""

HEADER = """\
// Constants, enums, structs, records and reports of the GridRT protocol.
// Generated from hal/protocol/protocol.toml by hal/protocol/generate.py; change it there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridrt::protocol {

"""

FOOTER = "}  // namespace gridrt::protocol\n"

SUPPORT = """\
namespace detail {

constexpr std::uint64_t byte_at(const std::byte* in, std::size_t i) {
  return static_cast<std::uint64_t>(in[i]);
}

constexpr std::uint8_t get8(const std::byte* in) {
  return static_cast<std::uint8_t>(byte_at(in, 0));
}

constexpr std::uint16_t get16(const std::byte* in) {
  return static_cast<std::uint16_t>(byte_at(in, 0) | byte_at(in, 1) << 8U);
}

constexpr std::uint32_t get32(const std::byte* in) {
  return static_cast<std::uint32_t>(byte_at(in, 0) | byte_at(in, 1) << 8U | byte_at(in, 2) << 16U |
                                    byte_at(in, 3) << 24U);
}

constexpr std::uint64_t get64(const std::byte* in) {
  return byte_at(in, 0) | byte_at(in, 1) << 8U | byte_at(in, 2) << 16U | byte_at(in, 3) << 24U |
         byte_at(in, 4) << 32U | byte_at(in, 5) << 40U | byte_at(in, 6) << 48U |
         byte_at(in, 7) << 56U;
}

constexpr std::byte low_byte(std::uint64_t value) {
  return static_cast<std::byte>(value & 0xFFU);
}

constexpr void put8(std::byte* out, std::uint8_t value) { out[0] = low_byte(value); }

constexpr void put16(std::byte* out, std::uint16_t value) {
  out[0] = low_byte(value);
  out[1] = low_byte(static_cast<std::uint64_t>(value) >> 8U);
}

constexpr void put32(std::byte* out, std::uint32_t value) {
  out[0] = low_byte(value);
  out[1] = low_byte(value >> 8U);
  out[2] = low_byte(value >> 16U);
  out[3] = low_byte(value >> 24U);
}

constexpr void put64(std::byte* out, std::uint64_t value) {
  put32(out, static_cast<std::uint32_t>(value & 0xFFFFFFFFU));
  put32(out + 4, static_cast<std::uint32_t>(value >> 32U));
}

// Bits of one field, 1 <= width <= 32.
constexpr std::uint64_t mask(unsigned width) { return (std::uint64_t{1} << width) - 1U; }

constexpr std::uint64_t low(std::uint64_t value, unsigned width) { return value & mask(width); }

constexpr bool fits(std::uint64_t value, unsigned width) { return value <= mask(width); }

// A width from an image header, forced into [1, 32] so that no shift goes wrong; valid() of the
// codec tells whether it had to be.
constexpr bool is_width(std::uint8_t width) { return width >= 1 && width <= 32; }

constexpr unsigned width_or_limit(std::uint8_t width) {
  return width < 1 ? 1U : (width > 32 ? 32U : static_cast<unsigned>(width));
}

// Adds a field at bit `at`; its bits are zero before. Returns the bit after it.
constexpr unsigned add_bits(std::byte* out, unsigned at, unsigned width, std::uint32_t value) {
  std::uint64_t rest = low(value, width) << (at % 8U);
  for (std::size_t i = at / 8U; rest != 0; ++i, rest >>= 8U) {
    out[i] |= low_byte(rest);
  }
  return at + width;
}

// The field at bit `at`.
constexpr std::uint32_t bits_at(const std::byte* in, unsigned at, unsigned width) {
  const std::size_t first = at / 8U;
  const std::size_t count = (at % 8U + width + 7U) / 8U;
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < count; ++i) {
    word |= byte_at(in, first + i) << (8U * static_cast<unsigned>(i));
  }
  return static_cast<std::uint32_t>(low(word >> (at % 8U), width));
}

}  // namespace detail

"""
