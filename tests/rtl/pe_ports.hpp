/// The packed structs of gridrt_pkg at the ports of a processing element, fields from bit 0 up.
#pragma once

#include <cstdint>
#include <ostream>

#include "tests/rtl/ports.hpp"

namespace gridrt::rtl {

inline constexpr std::uint32_t kNoId = (1U << 20U) - 1;

/// event_t
struct Event {
  int slot = 0;
  bool last = false;
  bool hit = false;
  std::uint32_t quotient = 0;
  std::uint32_t id = 0;
  std::uint32_t limit = 0;
  bool operator==(const Event&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const Event& e) {
  return out << "slot " << e.slot << (e.last ? " last" : "") << (e.hit ? " hit " : " ")
             << e.quotient << " id " << e.id << " limit " << e.limit;
}

template <class Port>
Event get_event(const Port& port) {
  Event e;
  e.limit = static_cast<std::uint32_t>(get_bits(port, 0, 18));
  e.id = static_cast<std::uint32_t>(get_bits(port, 18, 20));
  e.quotient = static_cast<std::uint32_t>(get_bits(port, 38, 25));
  e.hit = get_bits(port, 63, 1) != 0;
  e.last = get_bits(port, 64, 1) != 0;
  e.slot = static_cast<int>(get_bits(port, 65, 6));
  if (!e.hit) e.quotient = e.id = e.limit = 0;  // they have no meaning
  return e;
}

/// slot_event_t
constexpr std::uint8_t slot_event(int slot) { return static_cast<std::uint8_t>(64 + slot); }

/// task_t
struct Task {
  int slot = 0;
  int first = 0;
  int count = 1;
  std::uint64_t cells = 0xFFFFFFFF;  ///< of dominant axis x: all
  std::uint32_t enter = 0;
};

template <class Port>
void put_task(Port& port, const Task& t) {
  put_bits(port, 0, 18, t.enter);
  put_bits(port, 18, 34, t.cells);
  put_bits(port, 52, 10, static_cast<std::uint64_t>(t.count));
  put_bits(port, 62, 14, static_cast<std::uint64_t>(t.first));
  put_bits(port, 76, 6, static_cast<std::uint64_t>(t.slot));
}

/// interrupt_t
constexpr std::uint32_t interrupt(int slot, std::uint32_t limit) {
  return (1U << 24U) | (static_cast<std::uint32_t>(slot) << 18U) | limit;
}

/// load_t
template <class Port>
void put_load(Port& port, unsigned kind, unsigned pe, unsigned index, std::uint64_t data) {
  put_bits(port, 0, 56, data);
  put_bits(port, 56, 14, index);
  put_bits(port, 70, 2, pe);
  put_bits(port, 72, 8, kind);
  put_bits(port, 80, 1, 1);
}

}  // namespace gridrt::rtl
