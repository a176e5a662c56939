// A board's reports as text for people.
#pragma once

#include <optional>
#include <string>

#include "gridrt_protocol.hpp"

namespace gridrt {

/// What `gridrt-board info` asked for; a report that a board does not have is empty.
struct BoardInfo {
  protocol::IdentityReport identity;
  protocol::CapabilitiesReport capabilities;
  protocol::StatusReport status;
  std::optional<protocol::BootReport> boot;
  std::optional<protocol::SelfTestReport> self_test;
};

std::string describe_info(const BoardInfo& info);
std::string describe_counters(const protocol::CountersReport& counters,
                              const std::optional<protocol::StallsReport>& stalls);

/// One line for each entry.
std::string describe_journal(const protocol::JournalReport& journal);
std::string describe_event(const protocol::EventReport& event);

/// The result of a self-test, one line.
std::string describe_self_test(const protocol::SelfTestReport& report);

}  // namespace gridrt
