// What goes wrong in the guest, by number: the same for the board outside and the program inside.
#pragma once

#include <cstdint>
#include <random>

#include "hal/fault_injector.hpp"
#include "tests/usb/frame_faults.hpp"

namespace gridrt {

struct GuestSchedule {
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  const char* kind = "";
  bool recovers = true;  ///< nothing lasting happens: there is no excuse
  FaultRates to_device = {};
  FaultRates to_host = {};
  double stall = 0.0;             ///< chance that a transfer halts its pipe for the next one
  std::uint64_t most_stalls = 4;  ///< in all
  double nak = 0.0;               ///< chance that an answer is not there yet
  std::size_t most_in = 0;        ///< answers come in pieces of [1, this]; 0: whole
  std::uint64_t unplug = kNever;  ///< after so many transfers; back half a second later
  std::uint64_t silent = kNever;  ///< no answer from then on
  std::uint64_t reset = kNever;   ///< the image is forgotten
  bool other_version = false;
};

inline GuestSchedule guest_schedule(std::uint64_t number) {
  std::mt19937_64 random(number * 7919 + 11);
  const auto chance = [&](double most) {
    return most * static_cast<double>(random() % 1000) / 1000.0;
  };
  const std::uint64_t moment = 2 + random() % 18;  // a run has some 25 transfers
  GuestSchedule s;
  s.to_device.limit = s.to_host.limit = 1 + random() % 3;
  switch (number % 10) {
    case 0:
    case 1:
    case 2:
    case 3:
      s.kind = set_frame_faults(static_cast<int>(number % 10), chance, s.to_device, s.to_host);
      break;
    case 4:
      s.kind = "stalls";
      s.stall = 0.05 + chance(0.2);
      break;
    case 5:
      s.kind = "short transfers, NAKs";
      s.most_in = 20 + random() % 600;
      s.nak = chance(0.5);
      break;
    case 6:
      s.kind = "unplugged";
      s.recovers = false;
      s.unplug = moment;
      break;
    case 7:
      s.kind = "a board that falls silent";
      s.recovers = false;
      s.silent = 14 + random() % 14;  // while rays are under way, mostly
      break;
    case 8:
      s.kind = "reset in flight";
      s.recovers = false;
      s.reset = moment;
      break;
    default:
      s.kind = "another version";
      s.recovers = false;
      s.other_version = true;
  }
  return s;
}

}  // namespace gridrt
