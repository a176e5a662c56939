// Schedules of faults between host and board, with the real firmware on the soft core: the answers
// are the right ones after recovery, or there is one clear error in time, and a Reset then makes
// the board as good as new. GRIDRT_SIM_SCHEDULES sets how many (8).
#include <array>
#include <bit>
#include <cstdio>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "hal/fault_injector.hpp"
#include "tests/rtl/board_bench.hpp"
#include "tests/rtl/environment.hpp"

namespace gridrt {
namespace {

constexpr std::uint64_t kNever = ~std::uint64_t{0};
/// Clocks of one schedule and the recovery after it: above 16 attempts of the longest silence.
constexpr std::uint64_t kMostClocks = 8'000'000;
constexpr std::uint64_t kSilence = 5000;     ///< longest wait for an answer in clocks
constexpr std::uint64_t kReboot = 250'000;   ///< the same where a hang and a boot may lie between
constexpr std::uint32_t kIdleClocks = 2000;  ///< an unfinished frame is given up
constexpr std::uint64_t kKinds = 10;
constexpr std::uint64_t kSurelySent = 100;  ///< rays of a picture that are no misses by definition

std::uint64_t schedules() { return number_of("GRIDRT_SIM_SCHEDULES", 8); }

/// What happens at a moment, besides faults of frames.
enum class Event { kNone, kReaderStops, kHang, kReset };

/// What a seed stands for.
struct Schedule {
  const char* kind = "";
  FaultRates to_board{};
  FaultRates to_host{};
  Event event = Event::kNone;
  std::uint64_t moment = kNever;  ///< calls of send() and receive() before the event
  std::uint64_t pause = 0;        ///< clocks without a reader
  bool boots = false;             ///< the image is in flash
  bool other_version = false;
  bool recovers = true;  ///< nothing lasting happens: there is no excuse
  std::size_t batch = 8;
  int in_flight = 4;
};

Schedule make_schedule(std::uint64_t seed) {
  std::mt19937_64 random(seed * 6151 + 17);
  const auto chance = [&](double most) {
    return most * static_cast<double>(1 + random() % 1000) / 1000.0;
  };
  Schedule s;
  s.batch = 1 + random() % 60;
  s.in_flight = 1 + static_cast<int>(random() % 6);
  s.boots = random() % 2 == 0;
  s.moment = 1 + random() % (kSurelySent / s.batch + 1);
  s.to_board.limit = s.to_host.limit = 1 + random() % 4;
  switch (seed % kKinds) {
    case 0:
      s.kind = "bad CRCs";
      s.to_board.flip = s.to_host.flip = chance(0.6);
      break;
    case 1:
      s.kind = "garbage between frames";
      s.to_board.garbage = s.to_host.garbage = chance(0.8);
      break;
    case 2:
      s.kind = "cut frames";
      s.to_board.truncate = s.to_host.truncate = chance(0.5);
      break;
    case 3:
      s.kind = "lost frames";
      s.to_board.drop = s.to_host.drop = chance(0.5);
      break;
    case 4:
      s.kind = "doubled and reordered frames";
      s.to_board.duplicate = s.to_host.duplicate = chance(0.5);
      s.to_board.reorder = s.to_host.reorder = chance(0.4);
      break;
    case 5:
      s.kind = "a reader that stops";
      s.event = Event::kReaderStops;
      s.pause = 1 + random() % (3 * GRIDRT_RTL_HANG_CLOCKS);
      break;
    case 6:
      s.kind = "a hung engine, image in flash";
      s.event = Event::kHang;
      s.boots = true;
      s.recovers = false;
      break;
    case 7:
      s.kind = "reset in flight";
      s.event = Event::kReset;
      s.recovers = false;
      break;
    case 8:
      s.kind = "another version";
      s.other_version = true;
      s.recovers = false;
      break;
    default:
      s.kind = "everything at once";
      s.to_board = {.drop = chance(0.1),
                    .flip = chance(0.1),
                    .truncate = chance(0.1),
                    .duplicate = chance(0.1),
                    .reorder = chance(0.1),
                    .garbage = chance(0.2),
                    .limit = 5};
      s.to_host = s.to_board;
      s.event = random() % 2 == 0 ? Event::kReaderStops : Event::kHang;
      s.pause = 1 + random() % GRIDRT_RTL_HANG_CLOCKS;
      s.recovers = s.event == Event::kReaderStops;
  }
  return s;
}

/// A cable with a schedule between a session and a simulated board, which outlives it.
class BadCable final : public Transport {
 public:
  BadCable(SimTransport& link, SimBoard& board, const Schedule& schedule, std::uint64_t seed)
      : link_(link),
        board_(board),
        schedule_(schedule),
        to_board_(schedule.to_board, 2 * seed),
        to_host_(schedule.to_host, 2 * seed + 1) {}

  Result<void> send(std::span<const std::byte> bytes) override {
    if (auto happened = count(); !happened) return happened;
    std::vector<std::byte> arrives;
    to_board_.apply(bytes, arrives);
    return link_.send(arrives);
  }

  Result<std::size_t> receive(std::span<std::byte> out,
                              std::chrono::milliseconds timeout) override {
    if (auto happened = count(); !happened) return std::unexpected(happened.error());
    while (waiting_.empty()) {
      std::array<std::byte, 512> piece{};
      const auto got = link_.receive(piece, timeout);
      if (!got || *got == 0) return got;
      to_host_.apply(std::span(piece).first(*got), waiting_);
    }
    const std::size_t bytes = std::min(out.size(), waiting_.size());
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(bytes);
    std::copy(waiting_.begin(), end, out.begin());
    waiting_.erase(waiting_.begin(), end);
    return bytes;
  }

  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    auto done = link_.get_feature(id, body);
    if (done && schedule_.other_version && id == protocol::IdentityReport::kId) {
      protocol::IdentityReport identity;
      protocol::load(body.first<protocol::IdentityReport::kBytes>(), identity);
      ++identity.protocol_version;
      protocol::store(identity, body.first<protocol::IdentityReport::kBytes>());
    }
    return done;
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return link_.set_feature(id, body);
  }

  [[nodiscard]] std::chrono::milliseconds now() const override { return link_.now(); }

  [[nodiscard]] bool happened() const { return happened_; }
  [[nodiscard]] std::uint64_t faults() const {
    return to_board_.faults() + to_host_.faults() + (happened_ ? 1 : 0);
  }

 private:
  Result<void> count() {
    if (schedule_.event == Event::kNone || ++calls_ != schedule_.moment) return {};
    happened_ = true;
    switch (schedule_.event) {
      case Event::kReaderStops: {
        // Reading a report hands over what has been sent; nothing is on offer in the pause.
        const auto status = get_report<protocol::StatusReport>(link_);
        if (!status) return std::unexpected(status.error());
        board_.run({}, {}, {.quiet = schedule_.pause, .gap = 1});
        return {};
      }
      case Event::kHang:
        return link_.send(trace_frame(kHangs));
      case Event::kReset:
        return set_report(link_, protocol::ResetReport{.key = protocol::kResetKey});
      case Event::kNone:
        break;
    }
    return {};
  }

  SimTransport& link_;
  SimBoard& board_;
  Schedule schedule_;
  FaultInjector to_board_;
  FaultInjector to_host_;
  std::vector<std::byte> waiting_;  // for the host
  std::uint64_t calls_ = 0;
  bool happened_ = false;
};

bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

struct Outcome {
  Result<void> done;
  std::uint64_t faults = 0;
  std::uint64_t retries = 0;
};

/// Opens, loads and traces over a cable; every answer that is given is compared.
Outcome run(SimTransport& link, SimBoard& board, const Schedule& s, std::uint64_t seed) {
  auto made = std::make_unique<BadCable>(link, board, s, seed);
  const BadCable& cable = *made;
  auto session = Session::open(
      std::move(made), {.name = "sim", .rays_per_frame = s.batch, .frames_in_flight = s.in_flight});
  Outcome out;
  if (!session) {
    out.done = std::unexpected(session.error());
    return out;
  }
  const auto work = [&]() -> Result<void> {
    if (auto loaded = (*session)->load(image()); !loaded) return loaded;
    const auto rays = segments();
    std::vector<Hit> hits(rays.size());
    if (auto traced = (*session)->trace(rays, Query::kClosestHit, hits); !traced) return traced;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      EXPECT_TRUE(same(hits[i], expected()[i])) << "seed " << seed << ": wrong answer to ray " << i;
    }
    const auto counters = (*session)->counters();
    if (!counters) return std::unexpected(counters.error());
    out.retries = counters->frames_retried;
    return {};
  };
  out.done = work();
  out.faults = cable.faults();
  // Else the schedule has tested nothing.
  EXPECT_EQ(cable.happened(), s.event != Event::kNone) << "seed " << seed << ", " << s.kind;
  return out;
}

struct Sum {
  std::uint64_t runs = 0, right = 0, faults = 0, retries = 0, longest = 0;
  std::map<ErrorKind, std::uint64_t> errors;
};

void print(const std::map<std::string, Sum>& sums) {
  std::printf("%-30s %5s %6s %7s %8s %8s %7s %6s %9s\n", "schedule", "runs", "right", "faults",
              "retries", "timeout", "device", "other", "clocks");
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  for (const auto& [kind, sum] : sums) {
    std::uint64_t timeouts = 0, refusals = 0, others = 0;
    for (const auto& [error, count] : sum.errors) {
      (error == ErrorKind::kTimeout  ? timeouts
       : error == ErrorKind::kDevice ? refusals
                                     : others) += count;
    }
    std::printf("%-30s %5llu %6llu %7llu %8llu %8llu %7llu %6llu %9llu\n", kind.c_str(),
                number(sum.runs), number(sum.right), number(sum.faults), number(sum.retries),
                number(timeouts), number(refusals), number(others), number(sum.longest));
  }
}

TEST(BoardFaults, EveryScheduleEndsWithTheRightAnswersOrOneClearErrorInTime) {
  std::map<std::string, Sum> sums;
  const auto content = flash();
  for (std::uint64_t seed = 0; seed < schedules(); ++seed) {
    const Schedule s = make_schedule(seed);
    auto made = std::make_unique<VerilatedBoard<Vgridrt_board>>();
    if (s.boots) made->set_flash(content);
    made->power_up();
    SimBoard& board = *made;
    SimTransport link(
        std::move(made),
        {.silent_clocks = s.event == Event::kHang ? kReboot : kSilence, .most_silences = 20});
    const auto control = get_report<protocol::ControlReport>(link);
    ASSERT_TRUE(control) << "seed " << seed << ": " << control.error().message;
    auto idle = *control;
    idle.idle_clocks = kIdleClocks;
    ASSERT_TRUE(set_report(link, idle)) << "seed " << seed;
    const Outcome out = run(link, board, s, seed);
    Sum& sum = sums[s.kind];
    ++sum.runs;
    sum.faults += out.faults;
    sum.retries += out.retries;
    if (out.done) {
      ++sum.right;
      EXPECT_FALSE(s.other_version) << "seed " << seed;
    } else {
      const Error& error = out.done.error();
      ++sum.errors[error.kind];
      EXPECT_FALSE(s.recovers) << "seed " << seed << ", " << s.kind << ": " << error.message;
      EXPECT_FALSE(error.message.empty());
      EXPECT_EQ(error.kind == ErrorKind::kUnsupported, s.other_version) << error.message;
      EXPECT_TRUE(error.kind == ErrorKind::kTimeout || error.kind == ErrorKind::kDevice ||
                  s.other_version)
          << "seed " << seed << ": " << error.message;
    }
    // Whatever happened: a Reset, and the board is as good as new.
    const auto reset = set_report(link, protocol::ResetReport{.key = protocol::kResetKey});
    ASSERT_TRUE(reset) << "seed " << seed << ": " << reset.error().message;
    const Outcome after = run(link, board, {}, seed);
    EXPECT_TRUE(after.done) << "seed " << seed << ", " << s.kind << ": "
                            << after.done.error().message;
    sum.longest = std::max(sum.longest, board.clocks());
    EXPECT_LT(board.clocks(), kMostClocks) << "seed " << seed;
  }
  print(sums);
}

}  // namespace
}  // namespace gridrt
