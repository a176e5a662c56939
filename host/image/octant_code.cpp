#include "host/image/octant_code.hpp"

#include <array>
#include <bit>

#include "gridrt_protocol.hpp"

namespace gridrt {
namespace {

constexpr auto& kSets = protocol::kOctantSets;

constexpr std::array<std::uint8_t, 256> smallest_sets() {
  std::array<std::uint8_t, 256> codes{};
  for (unsigned set = 0; set < codes.size(); ++set) {
    int least = 9;
    for (unsigned code = 0; code < kSets.size(); ++code) {
      const int size = std::popcount(kSets[code]);
      if ((kSets[code] & set) == set && size < least) {
        least = size;
        codes[set] = static_cast<std::uint8_t>(code);
      }
    }
  }
  return codes;
}

}  // namespace

std::uint8_t octant_code(OctantSet octants) {
  static constexpr std::array<std::uint8_t, 256> kCodes = smallest_sets();
  return kCodes[octants];
}

OctantSet octants_of_code(std::uint32_t code) { return kSets[code % kSets.size()]; }

}  // namespace gridrt
