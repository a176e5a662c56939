#include "tests/adversarial/devices.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace gridrt::adversarial {

std::vector<std::string> asked_devices() {
  const char* text = std::getenv("GRIDRT_DEVICES");
  std::vector<std::string> names;
  std::string_view left = text == nullptr ? "" : text;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(','), left.size());
    if (end > 0) names.emplace_back(left.substr(0, end));
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return names;
}

std::vector<std::string> devices_under_test() {
  std::vector<std::string> names = asked_devices();
  if (names.empty()) {
    names = built_in_devices();
    // A job of processes for each device that a test opens: such runs have tests of their own.
    std::erase(names, "mpi");
    std::erase(names, "usb");  // asked for where a board is
    names.emplace_back("seq-board");
  }
  return names;
}

std::size_t rays_per_traced_one() {
  const char* text = std::getenv("GRIDRT_FRACTION");
  if (text == nullptr) return 1;
  const std::string_view fraction = text;
  char* end = nullptr;
  const std::size_t n = fraction.starts_with("1/") ? std::strtoul(text + 2, &end, 10) : 0;
  if (n == 0 || *end != '\0') {
    throw std::invalid_argument("GRIDRT_FRACTION: expected 1/N such as 1/64, not " +
                                std::string(fraction));
  }
  return n;
}

bool is_beyond(const Image& image, const protocol::CapabilitiesReport& capabilities) {
  return ((capabilities.layouts >> image.header.layout) & 1U) == 0 ||
         image.header.bits > capabilities.max_bits || image.header.pes > capabilities.pes;
}

}  // namespace gridrt::adversarial
