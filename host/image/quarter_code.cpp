#include "host/image/quarter_code.hpp"

#include <array>

#include "gridrt_protocol.hpp"

namespace gridrt {
namespace {

constexpr auto& kIntervals = protocol::kQuarterIntervals;
constexpr std::uint32_t kLarge = 8;  ///< digits from here on have three bits in common

/// What the declet has in place of a digit's two upper bits below 8: those bits, or none.
constexpr std::uint32_t upper(std::uint32_t digit) { return digit >> 1U & 3U; }

constexpr std::uint32_t pack(std::uint32_t z, std::uint32_t y, std::uint32_t x) {
  const std::uint32_t lowest = (z & 1U) << 7U | (y & 1U) << 4U | (x & 1U);
  const auto place = [&](std::uint32_t p, std::uint32_t s, std::uint32_t w, std::uint32_t v) {
    return lowest | p << 8U | s << 5U | v << 3U | w << 1U;
  };
  switch ((z >= kLarge ? 4U : 0U) | (y >= kLarge ? 2U : 0U) | (x >= kLarge ? 1U : 0U)) {
    case 0:
      return place(upper(z), upper(y), upper(x), 0);
    case 1:
      return place(upper(z), upper(y), 0, 1);
    case 2:
      return place(upper(z), upper(x), 1, 1);
    case 3:
      return place(upper(z), 2, 3, 1);
    case 4:
      return place(upper(x), upper(y), 2, 1);
    case 5:
      return place(upper(y), 1, 3, 1);
    case 6:
      return place(upper(x), 0, 3, 1);
    default:
      return place(0, 3, 3, 1);
  }
}

constexpr QuarterMasks unpack(std::uint32_t code) {
  const std::uint32_t p = code >> 8U & 3U;
  const std::uint32_t s = code >> 5U & 3U;
  const std::uint32_t w = code >> 1U & 3U;
  // Per digit: its upper bits, or 4 for a large one.
  std::uint32_t z = p;
  std::uint32_t y = s;
  std::uint32_t x = w;
  if ((code >> 3U & 1U) != 0) {
    switch (w) {
      case 0:
        x = 4;
        break;
      case 1:
        y = 4;
        x = s;
        break;
      case 2:
        z = 4;
        x = p;
        break;
      default:
        z = s == 2 ? p : 4;
        y = s == 1 ? p : 4;
        x = s == 0 ? p : 4;
    }
  }
  const auto mask = [](std::uint32_t top, std::uint32_t low) {
    return std::uint32_t{kIntervals[2 * top + low]};
  };
  return static_cast<QuarterMasks>(mask(x, code & 1U) | mask(y, code >> 4U & 1U) << 4U |
                                   mask(z, code >> 7U & 1U) << 8U);
}

constexpr std::array<QuarterMasks, 1024> all_codes() {
  std::array<QuarterMasks, 1024> all{};
  for (std::uint32_t code = 0; code < all.size(); ++code) all[code] = unpack(code);
  return all;
}

/// Digits by mask; what is no interval stands as all of it.
constexpr std::array<std::uint8_t, 16> kDigits = [] {
  std::array<std::uint8_t, 16> digits{};
  digits.fill(static_cast<std::uint8_t>(kIntervals.size() - 1));
  for (std::size_t digit = 0; digit < kIntervals.size(); ++digit) {
    digits[kIntervals[digit]] = static_cast<std::uint8_t>(digit);
  }
  return digits;
}();

}  // namespace

std::uint32_t quarter_code(QuarterMasks quarters) {
  return pack(kDigits[quarters >> 8U & 0xFU], kDigits[quarters >> 4U & 0xFU],
              kDigits[quarters & 0xFU]);
}

QuarterMasks quarters_of_code(std::uint32_t code) {
  static constexpr std::array<QuarterMasks, 1024> kCodes = all_codes();
  return kCodes[code % kCodes.size()];
}

}  // namespace gridrt
