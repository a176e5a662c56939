/// The life of one ray in a PE, as the bench has seen it, and whether it is explained by the rules:
/// every task ends once; all of its tests are made unless it may be cancelled.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "tests/rtl/pe_model.hpp"

namespace gridrt::rtl {

inline constexpr long kNever = std::numeric_limits<long>::max();

struct SentTask {
  Task task;
  std::vector<PeTest> tests;
  long cancel_at = kNever;        ///< clock of the first interrupt below `enter`
  bool cancelled_before = false;  ///< that one was known before the task came: no test is allowed
};

struct SeenEvent {
  Event event;
  long at = 0;
};

struct PeSlot {
  bool live = false;
  PeRay ray;
  int to_send = 0;
  std::uint32_t limit = kNoId;  ///< above every distance: none
  long limit_at = 0;
  std::vector<SentTask> tasks;
  std::vector<SeenEvent> events;
  int lasts = 0;
  int drops = 0;
  long last_drop = 0;

  [[nodiscard]] int pending() const { return static_cast<int>(tasks.size()) - lasts - drops; }

  /// Events come in the order of tasks, drops have no number: there must be a choice of dropped
  /// tasks, all of which were allowed to be dropped, that explains all events.
  [[nodiscard]] bool explained() const {
    std::vector<std::vector<Event>> seen(1);
    std::vector<long> ends;
    for (const SeenEvent& e : events) {
      seen.back().push_back(e.event);
      if (!e.event.last) continue;
      ends.push_back(e.at);
      seen.emplace_back();
    }
    if (!seen.back().empty()) return false;
    std::vector<bool> can(ends.size() + 1, false);  // [n]: the tasks so far made n of the ends
    can[0] = true;
    for (const SentTask& t : tasks) {
      std::vector<bool> next(can.size(), false);
      for (std::size_t n = 0; n < can.size(); ++n) {
        if (!can[n]) continue;
        if (t.tests.empty() || t.cancel_at < last_drop) next[n] = true;
        if (n < ends.size() && fits(t, seen[n], ends[n])) next[n + 1] = true;
      }
      can = next;
    }
    return can[ends.size()];
  }

 private:
  static bool fits(const SentTask& t, const std::vector<Event>& seen, long end) {
    if (t.tests.empty() || t.cancelled_before) return false;
    for (std::size_t n = t.cancel_at < end ? 1 : t.tests.size(); n <= t.tests.size(); ++n) {
      if (events_of(t.tests, n) == seen) return true;
    }
    return false;
  }
};

}  // namespace gridrt::rtl
