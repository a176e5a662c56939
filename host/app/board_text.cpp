#include "host/app/board_text.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace gridrt {
namespace {

using namespace protocol;

/// ASCII up to the first zero; what is no letter, digit or sign is shown as '?'.
std::string text(std::span<const std::uint8_t> bytes) {
  std::string out;
  for (const std::uint8_t c : bytes) {
    if (c == 0) break;
    out += c >= 0x20 && c < 0x7F ? static_cast<char>(c) : '?';
  }
  return out;
}

/// The name of an enum's value, or its number.
template <class Enum>
std::string named(std::uint64_t value) {
  const std::string_view known = name(static_cast<Enum>(value));
  return known.empty() ? fmt::format("unknown ({})", value) : std::string(known);
}

std::string row(std::string_view key, const std::string& value) {
  return fmt::format("{:<15} {}\n", key, value);
}

template <class Report>
std::string rows(const Report& report,
                 std::span<const std::pair<std::string_view, std::uint64_t Report::*>> fields) {
  std::string out;
  for (const auto& [key, field] : fields) out += row(key, fmt::format("{}", report.*field));
  return out;
}

std::string entry(std::uint32_t clock, std::uint64_t code, std::uint32_t detail) {
  return fmt::format("{:>10}  {:<15} {}\n", clock, named<JournalCode>(code), detail);
}

}  // namespace

std::string describe_info(const BoardInfo& info) {
  const CapabilitiesReport& c = info.capabilities;
  std::string out = row("name", text(info.identity.name));
  out += row("serial", text(info.identity.serial));
  out += row("protocol", fmt::format("version {}", info.identity.protocol_version));
  out += row("PEs", fmt::format("{}", c.pes));
  out += row("lattice bits", fmt::format("up to {}", c.max_bits));
  out += row("clock", c.clock_hz == 0 ? "none" : fmt::format("{} Hz", c.clock_hz));
  out += row("memory", fmt::format("{} triangles, {} vertices, {} references a PE; {} voxels, {} "
                                   "blocks in all",
                                   c.max_triangles, c.max_vertices, c.max_references, c.max_cells,
                                   c.max_blocks));
  out += row("frames", fmt::format("up to {} bytes, {} bad ones so far", c.max_payload,
                                   info.status.bad_frames));
  out += row("state", named<DeviceState>(info.status.state));
  const std::uint16_t last = info.status.last_error;
  out += row("last error", last == 0 ? "none"
                                     : fmt::format("{} (detail {})", named<ErrorCode>(last),
                                                   info.status.error_detail));
  if (info.boot) {
    const BootReport& b = *info.boot;
    std::string state = named<BootState>(b.state);
    if (b.error != 0) {
      state += fmt::format(", {} ({}, detail {})", named<BootError>(b.error),
                           named<ErrorCode>(b.refusal), b.detail);
    }
    if (b.length > 0) state += fmt::format(", {} bytes", b.length);
    if (b.resident != 0) state += ", answers rays now";
    out += row("image in flash", state);
  }
  if (info.self_test) out += row("self-test", describe_self_test(*info.self_test));
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

std::string describe_self_test(const SelfTestReport& report) {
  return fmt::format("{}: {} of {} bytes of answers to {} rays were right, run {}\n",
                     named<SelfTestState>(report.state), report.right, report.total, report.rays,
                     report.runs);
}

std::string describe_counters(const CountersReport& counters,
                              const std::optional<StallsReport>& stalls) {
  using Counter = std::pair<std::string_view, std::uint64_t CountersReport::*>;
  constexpr Counter kCounters[] = {{"rays", &CountersReport::rays},
                                   {"steps", &CountersReport::steps},
                                   {"tests", &CountersReport::tests},
                                   {"masked", &CountersReport::masked},
                                   {"interrupts", &CountersReport::interrupts},
                                   {"feedback waits", &CountersReport::feedback_waits},
                                   {"cycles", &CountersReport::cycles}};
  std::string out = rows<CountersReport>(counters, kCounters);
  if (!stalls) return out;
  using Stall = std::pair<std::string_view, std::uint64_t StallsReport::*>;
  constexpr Stall kStalls[] = {{"no ray", &StallsReport::no_ray},
                               {"no slot", &StallsReport::no_slot},
                               {"traversal idle", &StallsReport::traversal_idle},
                               {"queue full", &StallsReport::queue_full},
                               {"PE idle", &StallsReport::pe_idle},
                               {"divider busy", &StallsReport::divider_busy},
                               {"hit waits", &StallsReport::hit_waits}};
  return out + rows<StallsReport>(*stalls, kStalls);
}

std::string describe_journal(const JournalReport& journal) {
  std::string out;
  const std::size_t count = std::min<std::size_t>(journal.count, journal.codes.size());
  for (std::size_t i = 0; i < count; ++i) {
    out += entry(journal.clocks[i], journal.codes[i], journal.details[i]);
  }
  return out;
}

std::string describe_event(const EventReport& event) {
  return entry(event.clocks, event.code, event.detail);
}

}  // namespace gridrt
