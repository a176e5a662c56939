// What links do to frames, in the schedules of faults of the device usb: four kinds of it.
#pragma once

#include "hal/fault_injector.hpp"

namespace gridrt {

inline constexpr int kFrameFaultKinds = 4;

/// Sets the rates of one kind, [0, kFrameFaultKinds), for both ways, and names it; chance(most) is
/// a random number in [0, most).
template <class Chance>
const char* set_frame_faults(int kind, const Chance& chance, FaultRates& to_device,
                             FaultRates& to_host) {
  switch (kind) {
    case 0:
      to_device.drop = to_host.drop = chance(0.3);
      return "lost frames";
    case 1:
      to_device.flip = to_host.flip = chance(0.3);
      return "bad CRCs";
    case 2:
      to_device.truncate = to_host.truncate = chance(0.2);
      to_device.garbage = to_host.garbage = chance(0.5);
      return "cut frames, garbage";
    default:
      to_device.duplicate = to_host.duplicate = chance(0.5);
      to_device.reorder = to_host.reorder = chance(0.3);
      return "doubled and reordered frames";
  }
}

}  // namespace gridrt
