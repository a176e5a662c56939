/// Fields of the ports of a verilated module: integers up to 64 bits, arrays of words above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace gridrt::rtl {

constexpr std::uint64_t low_bits(int width) {
  return width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << width) - 1;
}

/// Writes the low `width` bits (1 to 64) of the value at bit `at`.
template <class Port>
void put_bits(Port& port, int at, int width, std::uint64_t value) {
  if constexpr (std::is_integral_v<Port>) {
    const std::uint64_t mask = low_bits(width) << at;
    port = static_cast<Port>((port & ~mask) | ((value << at) & mask));
  } else {
    while (width > 0) {
      const int offset = at % 32;
      const int part = width < 32 - offset ? width : 32 - offset;
      auto& word = port[static_cast<std::size_t>(at / 32)];
      const std::uint64_t mask = low_bits(part) << offset;
      word = static_cast<std::uint32_t>((word & ~mask) | ((value << offset) & mask));
      value >>= part;
      at += part;
      width -= part;
    }
  }
}

/// Reads `width` bits (1 to 64) from bit `at`.
template <class Port>
std::uint64_t get_bits(const Port& port, int at, int width) {
  if constexpr (std::is_integral_v<Port>) {
    return (std::uint64_t{port} >> at) & low_bits(width);
  } else {
    std::uint64_t value = 0;
    for (int done = 0; done < width;) {
      const int offset = (at + done) % 32;
      const int part = width - done < 32 - offset ? width - done : 32 - offset;
      const std::uint64_t word = port[static_cast<std::size_t>((at + done) / 32)];
      value |= ((word >> offset) & low_bits(part)) << done;
      done += part;
    }
    return value;
  }
}

}  // namespace gridrt::rtl
