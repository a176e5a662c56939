// How a rank waits when there is nothing to do: it leaves the processor to others at once, since
// there may be more ranks than cores, and sleeps when nothing has come for a while.
#pragma once

#include <chrono>
#include <thread>

namespace gridrt {

class Patience {
 public:
  /// Something was done.
  void renew() { rounds_ = 0; }

  /// Nothing was to do. `busy`: others may need an answer soon.
  void wait(bool busy) {
    ++rounds_;
    if (rounds_ <= kYields) {
      std::this_thread::yield();
      return;
    }
    std::this_thread::sleep_for(busy ? kShort : kLong);
  }

 private:
  static constexpr int kYields = 200;
  static constexpr std::chrono::microseconds kShort{50};
  static constexpr std::chrono::microseconds kLong{500};
  int rounds_ = 0;
};

}  // namespace gridrt
