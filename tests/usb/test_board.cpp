// A board for tests in the guest, behind USB redirection: `faults SOCKET` goes on to the next
// schedule of faults each time that it is reset; `endless SOCKET` takes every byte and, once a
// Control report has set `log`, never runs out of its own.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string_view>
#include <utility>

#include "gridrt_usb.hpp"
#include "host/pe/software_device.hpp"
#include "tests/usb/guest_schedule.hpp"
#include "tools/virtual/listen.hpp"
#include "tools/virtual/redirection.hpp"
#include "tools/virtual/usb_function.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;

class FaultyBoard final : public Endpoint {
 public:
  FaultyBoard() {
    SoftwareDeviceOptions options{.name = "board", .capabilities = board_capabilities()};
    options.frame_patience = milliseconds(100);
    inner_ = std::make_unique<SoftwareDevice>(std::move(options));
  }

  void set_function(UsbFunction* function) { function_ = function; }
  bool take_unplugging() { return std::exchange(unplugging_, false); }

  Result<void> consume(std::span<const std::byte> bytes) override {
    count(usb::kBulkOut);
    std::vector<std::byte> left;
    if (!to_device_) return inner_->consume(bytes);
    to_device_->apply(bytes, left);
    return left.empty() ? Result<void>{} : inner_->consume(left);
  }

  Result<std::size_t> produce(std::span<std::byte> out, milliseconds timeout) override {
    if (transfers_ >= schedule_.silent || happens(schedule_.nak)) return 0;
    if (taken_ == ready_.size()) {
      std::vector<std::byte> raw(std::size_t{1} << 16U);
      const auto got = inner_->produce(raw, timeout);
      if (!got) return got;
      ready_.clear();
      taken_ = 0;
      const auto came = std::span<const std::byte>(raw).first(*got);
      if (to_host_) {
        to_host_->apply(came, ready_);
      } else {
        ready_.assign(came.begin(), came.end());
      }
    }
    std::size_t size = std::min(out.size(), ready_.size() - taken_);
    if (size == 0) return 0;
    if (schedule_.most_in > 0) size = std::min(size, 1 + random_() % schedule_.most_in);
    std::copy_n(ready_.begin() + static_cast<std::ptrdiff_t>(taken_), size, out.begin());
    taken_ += size;
    count(usb::kBulkIn);
    return size;
  }

  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    auto done = inner_->get_feature(id, body);
    if (id == protocol::IdentityReport::kId && schedule_.other_version) body[0] ^= std::byte{0x80};
    return done;
  }

  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    auto done = inner_->set_feature(id, body);
    if (done && id == protocol::ResetReport::kId) next_schedule();
    return done;
  }

 private:
  void next_schedule() {
    schedule_ = guest_schedule(number_);
    random_.seed(number_++);
    transfers_ = stalls_ = 0;
    to_device_.reset();
    to_host_.reset();
    if (schedule_.to_device.any()) to_device_.emplace(schedule_.to_device, number_);
    if (schedule_.to_host.any()) to_host_.emplace(schedule_.to_host, number_ + 1);
    ready_.clear();
    taken_ = 0;
  }

  bool happens(double chance) {
    return chance > 0.0 && static_cast<double>(random_() >> 11U) * 0x1p-53 < chance;
  }

  void count(std::uint16_t endpoint) {
    ++transfers_;
    unplugging_ = unplugging_ || transfers_ == schedule_.unplug;
    if (stalls_ < schedule_.most_stalls && happens(schedule_.stall)) {
      ++stalls_;
      function_->halt(static_cast<std::uint8_t>(endpoint));
    }
    if (transfers_ == schedule_.reset) {
      std::array<std::byte, protocol::ResetReport::kBytes> body{};
      protocol::store(protocol::ResetReport{protocol::kResetKey}, body);
      static_cast<void>(inner_->set_feature(protocol::ResetReport::kId, body));
    }
  }

  std::unique_ptr<Endpoint> inner_;
  UsbFunction* function_ = nullptr;
  GuestSchedule schedule_;  // none until the first reset
  std::uint64_t number_ = 0;
  std::mt19937_64 random_;
  std::uint64_t transfers_ = 0;
  std::uint64_t stalls_ = 0;
  bool unplugging_ = false;
  std::optional<FaultInjector> to_device_, to_host_;
  std::vector<std::byte> ready_;
  std::size_t taken_ = 0;
};

class EndlessBoard final : public Endpoint {
 public:
  Result<void> consume(std::span<const std::byte> /*bytes*/) override { return {}; }
  Result<std::size_t> produce(std::span<std::byte> out, milliseconds /*timeout*/) override {
    return speaks_ ? out.size() : 0;
  }
  Result<void> get_feature(std::uint8_t /*id*/, std::span<std::byte> body) override {
    std::ranges::fill(body, std::byte{0});
    return {};
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    if (id != protocol::ControlReport::kId || body.size() < protocol::ControlReport::kBytes) {
      return {};
    }
    protocol::ControlReport control;
    protocol::load(body.first<protocol::ControlReport::kBytes>(), control);
    speaks_ = control.log != 0;
    return {};
  }

 private:
  bool speaks_ = false;
};

int serve(std::string_view mode, const char* place) {
  constexpr milliseconds kPatience(100);
  constexpr milliseconds kAway(500);
  FaultyBoard faulty;
  EndlessBoard endless;
  UsbFunction function(mode == "faults" ? static_cast<Endpoint&>(faulty) : endless);
  faulty.set_function(&function);
  const auto listening = listen_at(place);
  if (!listening) return 1;
  std::puts("waiting");
  std::fflush(stdout);
  for (;;) {
    const auto socket = accept_one(*listening, kPatience);
    if (!socket) return 1;
    if (!socket->is_open()) continue;
    Redirection redirection(function, socket->file());
    auto back = std::chrono::steady_clock::time_point::max();
    for (Result<bool> going = true; going && *going; going = redirection.step(kPatience)) {
      const auto now = std::chrono::steady_clock::now();
      if (faulty.take_unplugging()) {
        redirection.unplug();
        back = now + kAway;
      } else if (now >= back) {
        redirection.plug_in();
        back = std::chrono::steady_clock::time_point::max();
      }
    }
  }
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) { return argc == 3 ? gridrt::serve(argv[1], argv[2]) : 2; }
