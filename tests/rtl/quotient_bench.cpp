// gridrt_quotient against 128-bit division.
#include <random>

#include <Vgridrt_quotient.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/exact_test.hpp"
#include "tests/rtl/ports.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kBits = GRIDRT_RTL_B;
constexpr std::uint64_t kMostDet = (std::uint64_t{1} << (3 * kBits + 2)) - 1;
constexpr std::uint32_t kMostLength = (1U << static_cast<unsigned>(kBits)) - 1;
constexpr int kClocks = 13;

class Quotient : public testing::Test {
 protected:
  Quotient() {
    rtl_->start_i = 0;
    rtl_.reset();
  }

  void divide(std::uint64_t tn, std::uint64_t det, std::uint32_t length) {
    rtl_->start_i = 1;
    rtl_->tn_i = tn;
    rtl_->det_i = det;
    put_bits(rtl_->length_i, 0, kBits, length);
    rtl_.settle();
    const long start = rtl_.clocks();
    do {
      rtl_.tick();
      rtl_->start_i = 0;
      rtl_->tn_i = ~tn & kMostDet;  // inputs count in the first clock only
      rtl_->det_i = 0;
      rtl_->length_i = 0;
      rtl_.settle();
      ASSERT_LE(rtl_.clocks() - start, kClocks);
    } while (rtl_->busy_o != 0);
    const std::uint32_t quotient = exact_quotient(tn, det);
    const std::uint32_t limit = exact_limit(quotient, length);
    ASSERT_EQ(rtl_->quotient_o, quotient) << tn << " / " << det;
    ASSERT_EQ(rtl_->limit_o, limit) << tn << " / " << det << ", length " << length;
    // What the limit is for: the last whole distance that may still hold this quotient.
    ASSERT_LE((std::uint64_t{limit} << 24U) / length, quotient);
    ASSERT_GT((std::uint64_t{limit + 1} << 24U) / length, quotient);
    rtl_.tick();
    ASSERT_EQ(rtl_->quotient_o, quotient) << "the answer does not stay";
    ASSERT_EQ(rtl_->limit_o, limit);
  }

 private:
  Clocked<Vgridrt_quotient> rtl_;
};

TEST_F(Quotient, DividesAnyFraction) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 60'000; ++i) {
    const std::uint64_t det = 1 + (random() & kMostDet) % (kMostDet >> (random() % (3 * kBits)));
    const std::uint32_t length =
        1 + static_cast<std::uint32_t>(random()) % (kMostLength >> (random() % kBits));
    std::uint64_t tn = random() % (det + 1);
    if (i % 4 == 0) {  // at a step of the quotient, or beside it
      tn = static_cast<std::uint64_t>(Wide{det} * Wide{random() % (1U << 24U)} >> 24U) +
           random() % 2;
    } else if (i % 4 == 1) {  // at a whole distance
      tn = static_cast<std::uint64_t>(Wide{det} * Wide{random() % (length + 1)} / length);
    }
    divide(std::min(tn, det), det, length);
    if (HasFatalFailure()) return;
  }
}

TEST_F(Quotient, DividesTheExtremes) {
  for (const std::uint64_t det :
       {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}, (kMostDet >> 1U) + 1, kMostDet}) {
    for (const std::uint32_t length :
         {1U, 2U, 3U, kMostLength / 2 + 1, kMostLength - 1, kMostLength}) {
      for (const std::uint64_t tn : {std::uint64_t{0}, std::uint64_t{1}, det / 2, det - 1, det}) {
        divide(tn, det, length);
        if (HasFatalFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace gridrt::rtl
