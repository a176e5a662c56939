// gridrt_watch: what counts as a hang, what starts the soft core again, sleep.
#include <Vgridrt_watch.h>
#include <gtest/gtest.h>

#include "gridrt_firmware_protocol.hpp"
#include "tests/rtl/clocked.hpp"

namespace gridrt::rtl {
namespace {

namespace watch = wire::registers::Watch;

class Watch {
 public:
  Watch() {
    pins_->busy_i = pins_->answered_i = pins_->blocked_i = pins_->image_i = 0;
    pins_->trap_i = pins_->bus_timeout_i = pins_->wake_i = 0;
    pins_->bus_address_i = 0;
    pins_->select_i = pins_->write_i = 0;
    pins_.reset();
    run(40);
  }
  Vgridrt_watch* operator->() { return pins_.operator->(); }

  void run(int clocks) {
    for (int i = 0; i < clocks; ++i) pins_.tick();
  }
  std::uint32_t read(std::uint32_t address) {
    access(address, false, 0);
    const std::uint32_t data = pins_->read_data_o;
    release();
    return data;
  }
  /// Returns how many clocks it took.
  int write(std::uint32_t address, std::uint32_t data) {
    access(address, true, data);
    int clocks = 1;
    for (; pins_->ready_o == 0 && clocks < 10'000; ++clocks) {
      pins_.tick();
      pins_.settle();
    }
    release();
    return clocks;
  }
  /// Clocks until the soft core runs (or not), at most `most`.
  int until_core_runs(bool runs, int most) {
    int clocks = 0;
    while ((pins_->cpu_rst_no != 0) != runs && clocks < most) {
      pins_.tick();
      ++clocks;
    }
    return clocks;
  }

 private:
  void access(std::uint32_t address, bool write, std::uint32_t data) {
    pins_->select_i = 1;
    pins_->write_i = write ? 1 : 0;
    pins_->address_i = static_cast<std::uint8_t>((address - watch::kStuck) / 4);
    pins_->write_data_i = data;
    pins_.settle();
  }
  void release() {
    pins_.tick();
    pins_->select_i = 0;
    pins_->write_i = 0;
    pins_.settle();
  }
  Clocked<Vgridrt_watch> pins_;
};

TEST(Watch, CountsClocksWithoutAnAnswerWhileTheHostListens) {
  Watch w;
  EXPECT_EQ(w.read(watch::kLimit), 1024U);
  w.run(100);
  EXPECT_EQ(w.read(watch::kStuck), 0U);  // no rays
  w->busy_i = 1;
  w.run(500);
  EXPECT_EQ(w.read(watch::kStuck), 500U);
  w->blocked_i = 1;
  w.run(500);
  EXPECT_EQ(w.read(watch::kStuck), 501U);  // one clock was the reading's
  w->blocked_i = 0;
  w->answered_i = 1;
  w.run(1);
  w->answered_i = 0;
  EXPECT_EQ(w.read(watch::kStuck), 0U);
  w.run(1500);
  EXPECT_EQ(w.read(watch::kStuck), 1024U);
  w.write(watch::kAlive, 1);
  EXPECT_NE(w->core_rst_no, 0);
  w.write(watch::kReset, 1);  // no key
  w.run(2);
  EXPECT_NE(w->core_rst_no, 0);
  w.write(watch::kReset, wire::kCoreResetKey);
  w.run(2);
  EXPECT_EQ(w->core_rst_no, 0);
  w.run(40);
  EXPECT_NE(w->core_rst_no, 0);
}

TEST(Watch, AHangAndARequestEndSleepAndElseItsTime) {
  Watch w;
  EXPECT_NEAR(w.write(watch::kSleep, 300), 300, 3);
  w->wake_i = 1;
  EXPECT_LT(w.write(watch::kSleep, 300), 3);
  w->wake_i = 0;
  w->busy_i = 1;
  EXPECT_NEAR(w.write(watch::kSleep, 5000), 1024, 3);
  EXPECT_EQ(w.read(watch::kCause), 0U);  // asleep is not dead
}

TEST(Watch, ATrapAndSilenceStartTheSoftCoreAgain) {
  Watch w;
  ASSERT_NE(w->cpu_rst_no, 0);
  w->trap_i = 1;
  w.run(1);
  w->trap_i = 0;
  EXPECT_LT(w.until_core_runs(false, 10), 10);
  EXPECT_LT(w.until_core_runs(true, 100), 100);
  EXPECT_EQ(w.read(watch::kCause), static_cast<std::uint32_t>(wire::StartCause::kTrap));
  for (int i = 0; i < 10; ++i) {  // signs of life
    w.run(1000);
    w.write(watch::kAlive, 0);
    ASSERT_NE(w->cpu_rst_no, 0);
  }
  EXPECT_NEAR(w.until_core_runs(false, 10'000), 2048, 5);
  EXPECT_LT(w.until_core_runs(true, 100), 100);
  EXPECT_EQ(w.read(watch::kCause), static_cast<std::uint32_t>(wire::StartCause::kSilence));
}

TEST(Watch, RemembersThatAnImageWasLostAndWhichRegisterWasNotServed) {
  Watch w;
  EXPECT_EQ(w.read(watch::kImage), 1U);
  w.write(watch::kImage, 1);
  EXPECT_EQ(w.read(watch::kImage), 1U);  // there is none
  w->image_i = 1;
  w.run(1);
  w.write(watch::kImage, 1);
  EXPECT_EQ(w.read(watch::kImage), 0U);
  w->image_i = 0;
  w.run(1);
  w->image_i = 1;
  w.run(10);
  EXPECT_EQ(w.read(watch::kImage), 1U);

  EXPECT_EQ(w.read(watch::kBus), 0U);
  w->bus_timeout_i = 1;
  w->bus_address_i = 0x0C4;
  w.run(1);
  w->bus_address_i = 0x100;  // the first one counts
  w.run(1);
  w->bus_timeout_i = 0;
  EXPECT_EQ(w.read(watch::kBus), 0x0C5U);
  w.write(watch::kBus, 0);
  EXPECT_EQ(w.read(watch::kBus), 0U);
  EXPECT_EQ(w.read(watch::kReports), 0x1FEU);
}

}  // namespace
}  // namespace gridrt::rtl
