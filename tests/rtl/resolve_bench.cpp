// gridrt_resolve: every result of a test becomes its event, in order, with pauses at both ends.
#include <deque>
#include <map>
#include <random>
#include <vector>

#include <Vgridrt_resolve.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/exact_test.hpp"
#include "tests/rtl/pe_ports.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kBits = GRIDRT_RTL_B;
constexpr int kTriangles = GRIDRT_RTL_TRIS;
constexpr int kSlots = GRIDRT_RTL_SLOTS;
constexpr int kRoom = 16;
constexpr std::uint64_t kMostDet = (std::uint64_t{1} << (3 * kBits + 2)) - 1;

struct Ray {
  std::uint32_t length = 1;
  std::uint32_t ignore = kNoId;
  bool any = false;
};

struct Rates {
  int offer = 100;  // percent of clocks
  int take = 100;
  int hits = 30;  // percent of results
};

class Resolve : public testing::TestWithParam<Rates> {
 protected:
  Resolve() : rays_(kSlots) {
    rtl_->write_i = 0;
    rtl_->alloc_i = 0;
    rtl_->valid_i = 0;
    rtl_->event_ready_i = 0;
    rtl_.reset();
    for (int i = 0; i < kTriangles; ++i) {
      ids_.push_back(static_cast<std::uint32_t>(random_()) % kNoId);
      if (i < 3) ids_.back() = std::array{0U, kNoId - 1, 1U}[static_cast<std::size_t>(i)];
      rtl_->write_i = 1;
      put_bits(rtl_->write_index_i, 0, 12, static_cast<std::uint64_t>(i));
      rtl_->write_id_i = ids_.back();
      rtl_.tick();
    }
    rtl_->write_i = 0;
    for (int slot = 0; slot < kSlots; ++slot) new_ray(slot);
  }

  void new_ray(int slot) {
    Ray& ray = rays_[static_cast<std::size_t>(slot)];
    ray.length = 1 + static_cast<std::uint32_t>(random_() % ((1U << kBits) - 1));
    ray.ignore = random_() % 2 == 0 ? kNoId : ids_[random_() % ids_.size()];
    ray.any = random_() % 4 == 0;
    rtl_->alloc_i = slot_event(slot);
    put_bits(rtl_->ray_length_i, 0, kBits, ray.length);
    rtl_->ray_ignore_i = ray.ignore;
    rtl_->ray_any_i = ray.any ? 1 : 0;
    rtl_->event_ready_i = 0;
    rtl_.tick();
    rtl_->alloc_i = 0;
    rtl_.settle();
  }

  // Puts a random result at the port and its event, if it makes one, into the list.
  void offer(int hits) {
    const int slot = static_cast<int>(random_() % kSlots);
    const std::size_t triangle = random_() % ids_.size();
    const Ray& ray = rays_[static_cast<std::size_t>(slot)];
    const bool hit = static_cast<int>(random_() % 100) < hits;
    const bool last = !hit || random_() % 2 == 0;
    const std::uint64_t det = 1 + random_() % kMostDet;
    const std::uint64_t tn = random_() % 8 == 0 ? det * (random_() % 2) : random_() % (det + 1);
    rtl_->valid_i = 1;
    rtl_->hit_i = hit ? 1 : 0;
    rtl_->last_i = last ? 1 : 0;
    rtl_->slot_i = static_cast<std::uint8_t>(slot);
    rtl_->triangle_i = static_cast<std::uint16_t>(triangle);
    rtl_->tn_i = tn;
    rtl_->det_i = det;
    Event e{slot, last, hit && ids_[triangle] != ray.ignore, 0, 0, 0};
    if (e.hit && !ray.any) {
      e.quotient = exact_quotient(tn, det);
      e.id = ids_[triangle];
      e.limit = exact_limit(e.quotient, ray.length);
    }
    if (e.hit || e.last) expected_.push_back(e);
    ++inside_;
  }

  void clock(const Rates& rates, bool sending) {
    rtl_->valid_i = 0;
    if (sending && inside_ < kRoom && static_cast<int>(random_() % 100) < rates.offer) {
      offer(rates.hits);
    }
    rtl_->event_ready_i = static_cast<int>(random_() % 100) < rates.take ? 1 : 0;
    rtl_.settle();
    if (rtl_->event_valid_o != 0) {
      const Event e = get_event(rtl_->event_o);
      ASSERT_FALSE(expected_.empty()) << e;
      ASSERT_EQ(e, expected_.front());
      if (rtl_->event_ready_i != 0) {
        expected_.pop_front();
        ++events_;
      }
    } else {
      ASSERT_FALSE(held_) << "an event has been taken back";
    }
    held_ = rtl_->event_valid_o != 0 && rtl_->event_ready_i == 0;
    if (rtl_->taken_o != 0) --inside_;
    ASSERT_GE(inside_, 0);
    rtl_.tick();
  }

  [[nodiscard]] bool empty() const { return expected_.empty() && inside_ == 0; }
  [[nodiscard]] long events() const { return events_; }
  int random_slot() { return static_cast<int>(random_() % kSlots); }

 private:
  Clocked<Vgridrt_resolve> rtl_;
  std::mt19937_64 random_{11};
  std::vector<std::uint32_t> ids_;
  std::vector<Ray> rays_;
  std::deque<Event> expected_;
  int inside_ = 0;
  bool held_ = false;
  long events_ = 0;
};

TEST_P(Resolve, GivesEveryEventInOrder) {
  for (int round = 0; round < 60; ++round) {
    for (int i = 0; i < 1000; ++i) {
      clock(GetParam(), true);
      if (HasFatalFailure()) return;
    }
    for (int i = 0; i < 5000 && !empty(); ++i) {
      clock(GetParam(), false);
      if (HasFatalFailure()) return;
    }
    ASSERT_TRUE(empty()) << "results without an event";
    for (int i = 0; i < 5; ++i) new_ray(random_slot());
  }
  EXPECT_GT(events(), 1000);
}

// Ends of tasks that hit nothing leave one a clock.
TEST_P(Resolve, PassesMissesWithoutDelay) {
  const Rates misses{100, 100, 0};
  for (int i = 0; i < 2000; ++i) {
    clock(misses, true);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(events(), 1980);
}

// Dividers work side by side: hits alone leave at one in 15 clocks for each.
TEST_P(Resolve, DividesSideBySide) {
  for (int i = 0; i < 3000; ++i) {
    clock({100, 100, 100}, true);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(events(), 3000 * GRIDRT_RTL_DIVIDERS / 15);
}

INSTANTIATE_TEST_SUITE_P(Stalls, Resolve,
                         testing::Values(Rates{100, 100, 10}, Rates{100, 100, 90},
                                         Rates{50, 90, 30}, Rates{100, 20, 20}, Rates{5, 100, 50}));

}  // namespace
}  // namespace gridrt::rtl
