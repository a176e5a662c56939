// What a kernel shows of a board and what it answers, for tests with the real libusb and hidapi.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace gridrt::fake {

/// Beside the bus's faults. Set before Bus::plug_in(), which makes sysfs agree.
struct MockFaults {
  bool configured = true;  ///< the kernel has chosen a configuration
  bool hidraw = true;      ///< and has made a node for reports
  std::size_t config_bytes = std::numeric_limits<std::size_t>::max();  ///< of the descriptor
  std::size_t wrong_byte = std::numeric_limits<std::size_t>::max();    ///< of it
  std::uint8_t wrong_bits = 0;
  std::uint64_t fail_call = 0;  ///< the ioctl of usbfs that fails, from 1; 0: none
  int fail_with = 0;            ///< its errno
  std::uint64_t calls = 0;      ///< so far
};
MockFaults& mock_faults();

}  // namespace gridrt::fake
