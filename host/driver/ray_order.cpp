#include "host/driver/ray_order.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace gridrt {

std::size_t spreading_stride(std::size_t n) {
  constexpr std::uint64_t kMillionths = 381966;  // of the golden section's smaller part
  constexpr std::uint64_t kMillion = 1000000;
  std::uint64_t stride = std::max<std::uint64_t>(
      1, n / kMillion * kMillionths + n % kMillion * kMillionths / kMillion);
  while (std::gcd(stride, std::uint64_t{n}) > 1) ++stride;  // n - 1 is coprime to n
  return stride;
}

std::vector<std::size_t> spread(std::span<const std::size_t> places) {
  std::vector<std::size_t> order(places.size());
  const std::size_t stride = spreading_stride(places.size());
  std::size_t at = 0;
  for (std::size_t& place : order) {
    place = places[at];
    at += stride;
    if (at >= places.size()) at -= places.size();
  }
  return order;
}

}  // namespace gridrt
