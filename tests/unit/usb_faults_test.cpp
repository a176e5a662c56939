// Schedules of faults at random: the answers are the right ones after recovery, or there is one
// clear error in time. GRIDRT_USB_SCHEDULES sets how many (1000).
#include <bit>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "host/driver/device.hpp"
#include "host/image/image.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/unit/usb_board.hpp"
#include "tests/usb/frame_faults.hpp"

namespace gridrt {
namespace {

using contract::awkward_scene;
using contract::awkward_segments;
using contract::reference;

constexpr std::chrono::seconds kLongest(20);  ///< of one schedule; the limits add up to far less

std::uint64_t schedules() {
  const char* text = std::getenv("GRIDRT_USB_SCHEDULES");
  return text == nullptr ? 1000 : std::strtoull(text, nullptr, 10);
}

/// What a seed stands for.
struct Schedule {
  std::string kind;
  fake::Faults faults;
  FaultRates to_device;
  FaultRates to_host;
  bool recovers = true;  ///< nothing lasting happens: there is no excuse
  bool other_version = false;
  int in_flight = 1;
  std::size_t batch = 64;
  int timeout_ms = 10;
};

Schedule make_schedule(std::uint64_t seed) {
  std::mt19937_64 random(seed * 977 + 3);
  const auto chance = [&](double most) {
    return most * static_cast<double>(random() % 1000) / 1000.0;
  };
  Schedule s;
  s.in_flight = 1 + static_cast<int>(random() % 6);
  s.batch = 1 + random() % 200;
  const std::uint64_t moment = 2 + random() % 150;
  // A few faults: one kind of message has at most 16 attempts.
  s.faults.most = 1 + random() % 5;
  s.to_device.limit = s.to_host.limit = 1 + random() % 4;
  switch (seed % 16) {
    case 0:
      s.kind = "stalls";
      s.faults.stall = chance(0.3);
      break;
    case 1:
      s.kind = "lost transfers";
      s.faults.lost = chance(0.2);
      break;
    case 2:
      s.kind = "partial transfers";
      s.faults.partial = chance(0.2);
      break;
    case 3:
      s.kind = "short and empty transfers, NAKs";
      s.faults.most_in = 1 + random() % 600;
      s.faults.empty = chance(0.5);
      s.faults.nak = chance(0.8);
      s.timeout_ms = 500;  // slow is no fault
      break;
    case 4:
      s.kind = "overflows";
      s.faults.overflow = chance(0.3);
      break;
    case 5:
    case 6:
    case 7:
    case 8:
      s.kind = set_frame_faults(static_cast<int>(seed % 16) - 5, chance, s.to_device, s.to_host);
      break;
    case 9:
      s.kind = "unplugged";
      s.faults.unplug = moment;
      s.recovers = false;
      break;
    case 10:
      s.kind = "asleep";
      s.faults.unplug = moment;
      s.faults.still_there = true;
      s.recovers = false;
      break;
    case 11:
      s.kind = "a reader that stops";
      s.faults.stop_taking = moment;
      s.recovers = false;
      break;
    case 12:
      s.kind = "a board that falls silent";
      s.faults.stop_giving = moment;
      s.recovers = false;
      break;
    case 13:
      s.kind = "reset in flight";
      s.faults.reset = moment;
      s.recovers = false;
      break;
    case 14:
      s.kind = seed % 32 == 14 ? "hung firmware" : "another version";
      s.faults.hang_reports = seed % 32 == 14 ? moment % 40 : fake::kNever;
      s.other_version = seed % 32 != 14;
      s.recovers = false;
      break;
    default:
      s.kind = "everything at once";
      s.faults = {.stall = chance(0.1),
                  .lost = chance(0.1),
                  .partial = chance(0.1),
                  .empty = chance(0.3),
                  .nak = chance(0.5),
                  .overflow = chance(0.1),
                  .most_in = 1 + random() % 2000,
                  .most = 6,
                  .unplug = random() % 4 == 0 ? moment * 4 : fake::kNever};
      s.to_device = {.drop = 0.05,
                     .flip = 0.05,
                     .truncate = 0.05,
                     .duplicate = 0.05,
                     .reorder = 0.05,
                     .garbage = 0.1,
                     .limit = 5};
      s.to_host = s.to_device;
      s.recovers = false;
  }
  return s;
}

/// Everything that is the same in all schedules.
struct Question {
  Scene scene = awkward_scene(71);
  std::vector<Segment> segments;
  std::vector<Hit> hits;
  Image image;
};

const Question& question() {
  static const Question only = [] {
    Question q;
    ::setenv("GRIDRT_CONTRACT_RAYS", "400", 0);
    q.segments = awkward_segments(q.scene, kDefaultBits, 72);
    q.hits = reference(q.scene, kDefaultBits, q.segments, Query::kClosestHit);
    ImageOptions options;
    options.layout = protocol::Layout::kCompact;
    options.grid = glm::ivec3{6};
    options.mapping = Mapping::kBoxes;
    options.with_scene = false;
    q.image = build_image(q.scene, options).value();
    return q;
  }();
  return only;
}

bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

struct Outcome {
  Result<void> done;
  std::uint64_t retries = 0;
  std::uint64_t faults = 0;
};

/// Opens, loads and traces twice; every answer that is given is compared.
Outcome run(const Schedule& s, std::uint64_t seed) {
  const Question& q = question();
  fake::BadFrames board(fake::software_board(std::chrono::milliseconds(s.timeout_ms / 3)),
                        s.to_device, s.to_host, seed);
  if (s.other_version) board.speak_another_version();
  UsbFunction function(board);
  fake::Bus& bus = fake::bus();
  bus.plug_in(function, seed);
  bus.faults = s.faults;
  Outcome out;
  const auto work = [&]() -> Result<void> {
    auto device = open_device({.name = "usb",
                               .rays_per_frame = s.batch,
                               .frames_in_flight = s.in_flight,
                               .timeout_ms = s.timeout_ms});
    if (!device) return std::unexpected(device.error());
    if (auto loaded = (*device)->load(q.image); !loaded) return loaded;
    for (int round = 0; round < 2; ++round) {
      std::vector<Hit> hits(q.segments.size());
      if (auto traced = (*device)->trace(q.segments, Query::kClosestHit, hits); !traced) {
        return traced;
      }
      for (std::size_t i = 0; i < hits.size(); ++i) {
        EXPECT_TRUE(same(hits[i], q.hits[i])) << "seed " << seed << ": a wrong answer to ray " << i;
      }
    }
    const auto counters = (*device)->counters();
    if (!counters) return std::unexpected(counters.error());
    out.retries = counters->frames_retried;
    return {};
  };
  out.done = work();
  const fake::Counts& c = bus.counts;
  out.faults = c.stalls + c.lost + c.partial + c.overflows + board.faults();
  EXPECT_EQ(c.open, 0U) << "seed " << seed << ": something was not given back";
  return out;
}

TEST(UsbFaults, EverySchedulEndsWithTheRightAnswersOrOneClearErrorInTime) {
  struct Sum {
    std::uint64_t runs = 0, right = 0, faults = 0, retries = 0;
    std::map<ErrorKind, std::uint64_t> errors;
    double longest = 0.0;
  };
  std::map<std::string, Sum> sums;
  for (std::uint64_t seed = 0; seed < schedules(); ++seed) {
    const Schedule s = make_schedule(seed);
    const auto start = std::chrono::steady_clock::now();
    const Outcome out = run(s, seed);
    const auto time = std::chrono::steady_clock::now() - start;
    Sum& sum = sums[s.kind];
    ++sum.runs;
    sum.faults += out.faults;
    sum.retries += out.retries;
    sum.longest = std::max(sum.longest, std::chrono::duration<double>(time).count());
    EXPECT_LT(time, kLongest) << "seed " << seed;
    if (out.done) {
      ++sum.right;
      EXPECT_FALSE(s.other_version) << "seed " << seed;
      continue;
    }
    const Error& error = out.done.error();
    ++sum.errors[error.kind];
    EXPECT_FALSE(s.recovers) << "seed " << seed << ", " << s.kind << ": " << error.message;
    EXPECT_FALSE(error.message.empty());
    EXPECT_TRUE(error.kind == ErrorKind::kTransport || error.kind == ErrorKind::kTimeout ||
                error.kind == ErrorKind::kDevice || error.kind == ErrorKind::kProtocol ||
                (s.other_version && error.kind == ErrorKind::kUnsupported))
        << "seed " << seed << ": " << error.message;
  }
  std::printf("%-32s %5s %6s %6s %7s %8s %9s %7s %6s %8s\n", "schedule", "runs", "right", "faults",
              "retries", "transport", "timeout", "device", "other", "longest");
  std::uint64_t runs = 0;
  for (const auto& [kind, sum] : sums) {
    const auto of = [&](ErrorKind k) {
      const auto found = sum.errors.find(k);
      return static_cast<unsigned long long>(found == sum.errors.end() ? 0 : found->second);
    };
    runs += sum.runs;
    std::printf(
        "%-32s %5llu %6llu %6llu %7llu %9llu %8llu %7llu %6llu %6.2f s\n", kind.c_str(),
        static_cast<unsigned long long>(sum.runs), static_cast<unsigned long long>(sum.right),
        static_cast<unsigned long long>(sum.faults), static_cast<unsigned long long>(sum.retries),
        of(ErrorKind::kTransport), of(ErrorKind::kTimeout), of(ErrorKind::kDevice),
        of(ErrorKind::kProtocol) + of(ErrorKind::kUnsupported), sum.longest);
  }
  EXPECT_EQ(runs, schedules());
}

}  // namespace
}  // namespace gridrt
