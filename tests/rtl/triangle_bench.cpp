// gridrt_triangle against signed volumes in 128-bit integers: hit or miss of every test, and the
// fraction of every hit, in order and one a clock.
#include <deque>
#include <string>

#include <Vgridrt_triangle.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/hard_tests.hpp"
#include "tests/rtl/ports.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kBits = GRIDRT_RTL_B;
constexpr int kLatency = 12;

class Triangle : public testing::Test {
 protected:
  Triangle() {
    rtl_->valid_i = 0;
    rtl_.reset();
  }

  // One clock with a test, or without one.
  void clock(const Case* test) {
    rtl_->valid_i = test != nullptr ? 1 : 0;
    if (test != nullptr) {
      for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(a);
        put_bits(rtl_->p0_i, a * kBits, kBits, static_cast<std::uint64_t>(test->p0[i]));
        put_bits(rtl_->d_i, a * (kBits + 1), kBits + 1,
                 static_cast<std::uint64_t>(test->p1[i] - test->p0[i]));
        for (int c = 0; c < 3; ++c) {
          put_bits(rtl_->v_i, (3 * c + a) * kBits, kBits,
                   static_cast<std::uint64_t>(test->v[static_cast<std::size_t>(c)][i]));
        }
      }
      rtl_->meta_i = static_cast<std::uint32_t>(sent_);
      waiting_.push_back({*test, sent_, rtl_.clocks()});
      ++sent_;
    }
    rtl_.tick();
    rtl_.settle();
    check();
  }

  void finish() {
    for (int i = 0; i < kLatency; ++i) {
      clock(nullptr);
      if (HasFatalFailure()) return;
    }
    ASSERT_TRUE(waiting_.empty());
  }

  [[nodiscard]] long hits() const { return hits_; }
  [[nodiscard]] long sent() const { return sent_; }

 private:
  struct Sent {
    Case test;
    long number = 0;
    long at = 0;
  };

  void check() {
    const bool due = !waiting_.empty() && rtl_.clocks() - waiting_.front().at == kLatency;
    ASSERT_EQ(rtl_->valid_o != 0, due);
    if (!due) return;
    const Sent sent = waiting_.front();
    waiting_.pop_front();
    const Case& c = sent.test;
    const Verdict truth = judge(c.p0, c.p1, c.v);
    ASSERT_EQ(rtl_->meta_o, static_cast<std::uint32_t>(sent.number));
    ASSERT_EQ(rtl_->hit_o != 0, truth.hit) << text(c);
    if (truth.hit) {
      ASSERT_EQ(rtl_->tn_o, truth.tn) << text(c);
      ASSERT_EQ(rtl_->det_o, truth.det) << text(c);
      ++hits_;
    }
  }

  static std::string text(const Case& c) {
    std::string all;
    for (const Point& p : {c.p0, c.p1, c.v[0], c.v[1], c.v[2]}) {
      for (const std::int64_t x : p) all += std::to_string(x) + " ";
      all += "| ";
    }
    return all;
  }

  Clocked<Vgridrt_triangle> rtl_;
  std::deque<Sent> waiting_;
  long sent_ = 0;
  long hits_ = 0;
};

TEST_F(Triangle, AgreesOnHardCases) {
  HardTests tests(kBits, 1);
  for (int i = 0; i < 400'000; ++i) {
    const Case c = tests.next();
    clock(&c);
    if (HasFatalFailure()) return;
  }
  finish();
  EXPECT_GT(hits() * 10, sent()) << "these tests hardly hit anything";
}

// All values on the way are affine in each single coordinate, so their extremes are at corners of
// the lattice box: every choice of corners for the five points shows every width to be enough.
TEST_F(Triangle, HoldsTheExtremesOfEveryValue) {
  constexpr std::int64_t kMost = (std::int64_t{1} << kBits) - 1;
  const auto corner = [&](unsigned choice) {
    return Point{(choice & 1U) != 0 ? kMost : 0, (choice & 2U) != 0 ? kMost : 0,
                 (choice & 4U) != 0 ? kMost : 0};
  };
  for (unsigned i = 0; i < (1U << 15U); ++i) {
    const Case c{corner(i), corner(i >> 3U), {corner(i >> 6U), corner(i >> 9U), corner(i >> 12U)}};
    clock(&c);
    if (HasFatalFailure()) return;
  }
  finish();
  EXPECT_GT(hits(), 1000);
}

// Two triangles with one segment through their common edge, or just beside it.
TEST_F(Triangle, SharedEdgesHaveNoCracks) {
  HardTests tests(kBits, 2);
  for (int i = 0; i < 50'000; ++i) {
    for (const Case& c : tests.neighbours()) {
      clock(&c);
      if (HasFatalFailure()) return;
    }
  }
  finish();
  EXPECT_GT(hits() * 5, sent());
}

// Clocks without a test do not disturb those under way.
TEST_F(Triangle, KeepsTimeWithPauses) {
  HardTests tests(kBits, 3);
  for (int i = 0; i < 50'000; ++i) {
    const Case c = tests.next();
    clock(tests.random()() % 3 == 0 ? &c : nullptr);
    if (HasFatalFailure()) return;
  }
  finish();
}

}  // namespace
}  // namespace gridrt::rtl
