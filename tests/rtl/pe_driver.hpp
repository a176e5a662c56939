/// Plays the neighbours of a gridrt_pe: loads images, gives rays, tasks and interrupts, takes
/// events with pauses, and holds the PE to the rules of pe_slot.hpp.
#pragma once

#include <algorithm>
#include <deque>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include <Vgridrt_pe.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/pe_slot.hpp"

namespace gridrt::rtl {

inline constexpr int kPeBits = GRIDRT_RTL_B;
inline constexpr int kPeSlots = GRIDRT_RTL_SLOTS;
inline constexpr PeSizes kPeSizes{GRIDRT_RTL_REFS, GRIDRT_RTL_TRIS, GRIDRT_RTL_VERTS};

#ifdef GRIDRT_BENCH_NO_CANCEL
inline constexpr bool kCancels = false;
#else
inline constexpr bool kCancels = true;
#endif

struct PeTraffic {
  int offer = 100;        ///< percent of clocks in which a task is offered
  int take = 100;         ///< percent of clocks in which an event is taken
  int interrupts = 0;     ///< per thousand clocks, at random
  bool feedback = false;  ///< each hit sends its limit back, as the engine does
  int list = 12;          ///< references of a task: 1 to this
  int whole = 33;         ///< percent of tasks whose ray touches all of the voxel
  int near = 30;          ///< tasks enter at 0 to this, or anywhere for 0
};

class PeDriver : public testing::Test {
 public:
  /// Sums over the clocks so far.
  struct Counts {
    long tasks = 0;
    long tests = 0;
    long masked = 0;
    long busy = 0;
    long work = 0;  ///< clocks that the tasks take at the least
    long hits = 0;
    long lasts = 0;
    long drops = 0;
    long cancelled = 0;
  };

 protected:
  PeDriver() : slots_(kPeSlots) {
    pe_->load_i[0] = pe_->load_i[1] = pe_->load_i[2] = 0;
    pe_->alloc_i = 0;
    pe_->interrupt_i = 0;
    pe_->task_valid_i = 0;
    pe_->event_ready_i = 0;
    pe_.reset();
  }

  /// Fills all memories; what is meant for others, or lies beyond, must change nothing.
  void load(std::int64_t size, unsigned sparse) {
    image_ = std::make_unique<PeImage>(kPeBits, kPeSizes, size, sparse, random_);
    for (std::size_t i = 0; i < image_->vertices.size(); ++i) {
      const Point& p = image_->vertices[i];
      std::uint64_t record = 0;
      for (int a = 0; a < 3; ++a) {
        put_bits(record, 18 * a, 18, static_cast<std::uint64_t>(p[static_cast<std::size_t>(a)]));
      }
      write(5, i, record);
    }
    for (std::size_t i = 0; i < image_->triangles.size(); ++i) {
      const StoredTriangle& t = image_->triangles[i];
      std::uint64_t record = std::uint64_t{t.id} << 36U;
      for (int c = 0; c < 3; ++c) {
        put_bits(record, 12 * c, 12, t.vertex[static_cast<std::size_t>(c)]);
      }
      write(4, i, record);
    }
    for (std::size_t i = 0; i < image_->references.size(); ++i) {
      const Reference& r = image_->references[i];
      write(3, i, r.triangle | (r.quarters << 12U));
    }
    for (int i = 0; i < 3; ++i) pe_->load_i[static_cast<std::size_t>(i)] = 0;
    pe_.settle();
  }

  void run(const PeTraffic& traffic, int clocks) {
    for (int i = 0; i < clocks; ++i) {
      clock(traffic, true);
      if (HasFatalFailure()) return;
    }
  }

  /// No further tasks; everything must come to its end.
  void drain(PeTraffic traffic) {
    for (int i = 0; i < 20'000 && pending_ > 0; ++i) {
      clock(traffic, false);
      if (HasFatalFailure()) return;
    }
    ASSERT_EQ(pending_, 0) << "tasks that do not end";
    traffic.interrupts = 0;
    for (int i = 0; i < 50; ++i) {  // nothing may follow
      clock(traffic, false);
      if (HasFatalFailure()) return;
    }
    ASSERT_EQ(pe_->busy_o, 0);
  }

  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] int pending() const { return pending_; }
  Random& random() { return random_; }
  bool percent(int share) { return static_cast<int>(random_() % 100) < share; }

 private:
  void write(unsigned kind, std::size_t index, std::uint64_t data) {
    if (random_() % 8 == 0) {
      const auto junk = std::uint64_t{random_()} << 16U;
      put_load(pe_->load_i, kind, (GRIDRT_RTL_NUMBER + 1 + random_() % 3) % 4,
               static_cast<unsigned>(index), junk);
      pe_.tick();
      put_load(pe_->load_i, 6 + random_() % 2, GRIDRT_RTL_NUMBER, static_cast<unsigned>(index),
               junk);
      pe_.tick();
      const std::array beyond = {kPeSizes.references, kPeSizes.triangles, kPeSizes.vertices};
      put_load(pe_->load_i, kind, GRIDRT_RTL_NUMBER, static_cast<unsigned>(beyond[kind - 3]), junk);
      pe_.tick();
    }
    put_load(pe_->load_i, kind, GRIDRT_RTL_NUMBER, static_cast<unsigned>(index), data);
    pe_.tick();
  }

  void clock(const PeTraffic& traffic, bool sending) {
    pe_->alloc_i = 0;
    pe_->interrupt_i = 0;
    if (sending) renew_a_slot();
    offer_a_task(traffic, sending);
    interrupt_a_ray(traffic);
    pe_->event_ready_i = percent(traffic.take) ? 1 : 0;
    pe_.settle();
    observe(traffic);
    if (HasFatalFailure()) return;
    pe_.tick();
  }

  void renew_a_slot() {
    const int number = static_cast<int>(random_() % kPeSlots);
    PeSlot& slot = slots_[static_cast<std::size_t>(number)];
    if (slot.live && (slot.to_send > 0 || slot.pending() > 0)) return;
    if (offered_ && offered_->slot == number) return;  // its last task has not been taken yet
    slot = PeSlot{};
    slot.live = true;
    slot.ray = image_->ray(random_);
    slot.to_send = static_cast<int>(random_() % 12);
    pe_->alloc_i = slot_event(number);
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      put_bits(pe_->ray_p0_i, a * kPeBits, kPeBits, static_cast<std::uint64_t>(slot.ray.p0[i]));
      put_bits(pe_->ray_d_i, a * (kPeBits + 1), kPeBits + 1,
               static_cast<std::uint64_t>(slot.ray.p1[i] - slot.ray.p0[i]));
    }
    put_bits(pe_->ray_length_i, 0, kPeBits, slot.ray.length);
    pe_->ray_ignore_i = slot.ray.ignore;
    pe_->ray_any_i = slot.ray.any ? 1 : 0;
    renewed_ = number;
  }

  // A task that has been offered stays until it is taken.
  void offer_a_task(const PeTraffic& traffic, bool sending) {
    if (!offered_ && sending && percent(traffic.offer)) {
      for (int attempt = 0; attempt < 8 && !offered_; ++attempt) {
        const int number = static_cast<int>(random_() % kPeSlots);
        PeSlot& slot = slots_[static_cast<std::size_t>(number)];
        if (!slot.live || slot.to_send == 0 || slot.pending() >= 4 || number == renewed_) continue;
        offered_ = random_task(traffic, number, slot.ray.length);
        --slot.to_send;
      }
    }
    renewed_ = -1;
    pe_->task_valid_i = offered_ ? 1 : 0;
    if (offered_) put_task(pe_->task_i, *offered_);
  }

  Task random_task(const PeTraffic& traffic, int slot, std::uint32_t length) {
    Task t;
    t.slot = slot;
    t.count = 1 + static_cast<int>(random_() % static_cast<unsigned>(traffic.list));
    t.first =
        static_cast<int>(random_() % static_cast<unsigned>(kPeSizes.references - t.count + 1));
    t.cells = 0xFFFFFFFF;
    if (!percent(traffic.whole)) {
      t.cells = std::uint64_t{random_() % 3} << 32U | 1U << random_() % 16 |
                1U << (16 + random_() % 16) | (random_() & random_() & random_());
    }
    const unsigned most = traffic.near > 0 ? static_cast<unsigned>(traffic.near) : length;
    t.enter = random_() % (most + 1);
    return t;
  }

  // Limits fall only.
  void interrupt_a_ray(const PeTraffic& traffic) {
    if (pe_->alloc_i != 0) return;  // the two never come in one clock
    if (!limits_.empty()) {
      const auto [number, limit] = limits_.front();
      limits_.pop_front();
      lower(number, limit);
      return;
    }
    if (static_cast<int>(random_() % 1000) >= traffic.interrupts) return;
    const int number = static_cast<int>(random_() % kPeSlots);
    lower(number, random_() % static_cast<unsigned>(traffic.near + 1));
  }

  void lower(int number, std::uint32_t limit) {
    PeSlot& slot = slots_[static_cast<std::size_t>(number)];
    if (!slot.live || limit >= slot.limit ||
        (pe_->alloc_i & 63U) == static_cast<unsigned>(number)) {
      return;
    }
    slot.limit = limit;
    slot.limit_at = pe_.clocks();
    pe_->interrupt_i = interrupt(number, limit);
    for (SentTask& t : slot.tasks) {
      if (kCancels && t.task.enter > limit) t.cancel_at = std::min(t.cancel_at, pe_.clocks());
    }
  }

  void observe(const PeTraffic& traffic) {
    counts_.tests += pe_->test_o;
    counts_.masked += pe_->masked_o;
    counts_.busy += pe_->busy_o;
    counts_.cancelled += pe_->drop_cancelled_o;
    if (offered_ && pe_->task_ready_o != 0) {
      take_task(*offered_);
      offered_.reset();
    }
    if (pe_->tap_test_valid_o != 0) observe_test();
    if ((pe_->drop_o & 64U) != 0) {
      PeSlot& slot = slots_[pe_->drop_o & 63U];
      ASSERT_GT(slot.pending(), 0) << "a task is dropped twice";
      ++slot.drops;
      slot.last_drop = pe_.clocks();
      ++counts_.drops;
      end(slot);
    }
    observe_event(traffic);
  }

  void take_task(const Task& task) {
    PeSlot& slot = slots_[static_cast<std::size_t>(task.slot)];
    SentTask sent{task, tests_of(*image_, slot.ray, task)};
    if (kCancels && task.enter > slot.limit) {
      sent.cancel_at = slot.limit_at;
      sent.cancelled_before = slot.limit_at + 4 <= pe_.clocks();
    }
    expected_tests += static_cast<long>(sent.tests.size());
    expected_masked += sent.task.count - static_cast<long>(sent.tests.size());
    for (const PeTest& t : sent.tests) in_order_.push_back(t);
    counts_.work += std::max<long>((sent.task.count + 7) / 8, std::ssize(sent.tests));
    slot.tasks.push_back(std::move(sent));
    ++counts_.tasks;
    ++pending_;
  }

  // Tests are made in the order of tasks; those of cancelled tasks may be missing.
  void observe_test() {
    while (!in_order_.empty() && in_order_.front().triangle != pe_->tap_test_triangle_o) {
      ++skipped_tests;
      in_order_.pop_front();
    }
    ASSERT_FALSE(in_order_.empty()) << "a test that belongs to no task";
    if (skipped_tests == 0) {
      ASSERT_EQ(pe_->tap_test_hit_o != 0, in_order_.front().hit);
    }
    in_order_.pop_front();
  }

  void observe_event(const PeTraffic& traffic) {
    if (held_) {
      ASSERT_NE(pe_->event_valid_o, 0) << "an event has been taken back";
      ASSERT_EQ(get_event(pe_->event_o), *held_);
    }
    held_.reset();
    if (pe_->event_valid_o == 0) return;
    const Event event = get_event(pe_->event_o);
    if (pe_->event_ready_i == 0) {
      held_ = event;
      return;
    }
    ASSERT_LT(event.slot, kPeSlots);
    PeSlot& slot = slots_[static_cast<std::size_t>(event.slot)];
    ASSERT_GT(slot.pending(), 0) << "an event without a task: " << event;
    slot.events.push_back({event, pe_.clocks()});
    if (event.hit) {
      ++counts_.hits;
      if (traffic.feedback) limits_.emplace_back(event.slot, event.limit);
    }
    if (event.last) {
      ++slot.lasts;
      ++counts_.lasts;
      end(slot);
    }
  }

  void end(const PeSlot& slot) {
    --pending_;
    if (slot.pending() > 0) return;
    ASSERT_TRUE(slot.explained()) << explain(slot);
  }

  static std::string explain(const PeSlot& slot) {
    std::ostringstream out;
    for (const SentTask& t : slot.tasks) {
      out << "\ntask " << t.task.first << "+" << t.task.count << " enters at " << t.task.enter
          << (t.cancel_at == kNever ? "" : ", cancelled") << ":";
      for (const Event& e : events_of(t.tests, t.tests.size())) out << "\n    " << e;
    }
    for (const SeenEvent& e : slot.events) out << "\nseen " << e.event;
    out << "\ndrops " << slot.drops;
    return out.str();
  }

  Clocked<Vgridrt_pe> pe_;
  Random random_;
  std::unique_ptr<PeImage> image_;
  std::vector<PeSlot> slots_;
  std::optional<Task> offered_;
  std::optional<Event> held_;
  std::deque<std::pair<int, std::uint32_t>> limits_;
  std::deque<PeTest> in_order_;
  Counts counts_;
  int pending_ = 0;
  int renewed_ = -1;

 protected:
  long expected_tests = 0;
  long expected_masked = 0;
  long skipped_tests = 0;
};

}  // namespace gridrt::rtl
