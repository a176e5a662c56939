// `guest_faults truth FOLDER` writes an image, rays and their answers by seq; `guest_faults run
// FOLDER N` asks the board in the guest for them under N schedules of faults. Prints one line a
// schedule and the sums; ends with 1 if anything was wrong.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "hal/usb/usb.hpp"
#include "host/driver/device.hpp"
#include "host/image/image_file.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/usb/guest_schedule.hpp"

namespace gridrt {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kTimeoutMs = 300;
constexpr double kLongest = 60.0;  ///< seconds; the limits add up to less

template <class Record>
void write(const std::string& path, const std::vector<Record>& records) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(records.data()),
             static_cast<std::streamsize>(records.size() * sizeof(Record)));
}

template <class Record>
std::vector<Record> read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<Record> records(bytes.size() / sizeof(Record));
  std::copy_n(bytes.begin(), records.size() * sizeof(Record),
              reinterpret_cast<char*>(records.data()));
  return records;
}

int make_truth(const std::string& folder) {
  const Scene scene = contract::awkward_scene(81);
  const auto segments = contract::awkward_segments(scene, kDefaultBits, 82);
  ImageOptions options;
  options.layout = protocol::Layout::kCompact;
  options.grid = glm::ivec3{6};
  options.mapping = Mapping::kBoxes;
  options.with_scene = false;
  const auto image = build_image(scene, options);
  if (!image) return 1;
  write(folder + "/image.grt", serialize_image(*image));
  write(folder + "/rays", segments);
  write(folder + "/hits", contract::reference(scene, kDefaultBits, segments, Query::kClosestHit));
  return 0;
}

bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

struct Truth {
  Image image;
  std::vector<Segment> rays;
  std::vector<Hit> hits;
};

/// Goes on to the next schedule, once the board is back from the last one.
Result<void> begin() {
  const auto end = Clock::now() + std::chrono::seconds(10);
  for (;;) {
    auto link = open_usb({.frames = false});
    Result<void> done = link ? set_report(**link, protocol::ResetReport{protocol::kResetKey})
                             : Result<void>(std::unexpected(link.error()));
    if (done || Clock::now() >= end) return done;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

Result<std::uint64_t> ask(const Truth& truth, int& wrong) {
  auto device = open_device(
      {.name = "usb", .rays_per_frame = 40, .frames_in_flight = 3, .timeout_ms = kTimeoutMs});
  if (!device) return std::unexpected(device.error());
  if (auto loaded = (*device)->load(truth.image); !loaded) return std::unexpected(loaded.error());
  std::vector<Hit> hits(truth.rays.size());
  if (auto traced = (*device)->trace(truth.rays, Query::kClosestHit, hits); !traced) {
    return std::unexpected(traced.error());
  }
  for (std::size_t i = 0; i < hits.size(); ++i) wrong += same(hits[i], truth.hits[i]) ? 0 : 1;
  const auto counters = (*device)->counters();
  if (!counters) return std::unexpected(counters.error());
  return counters->frames_retried;
}

int run(const std::string& folder, std::uint64_t schedules) {
  auto image = read_image(folder + "/image.grt");
  if (!image) return 1;
  const Truth truth{std::move(*image), read<Segment>(folder + "/rays"),
                    read<Hit>(folder + "/hits")};
  if (truth.rays.empty() || truth.hits.size() != truth.rays.size()) return 1;
  int bad = 0;
  int right = 0;
  int errors = 0;
  for (std::uint64_t number = 0; number < schedules; ++number) {
    const GuestSchedule s = guest_schedule(number);
    const auto start = Clock::now();
    int wrong = 0;
    const Result<void> begun = begin();
    const auto done =
        begun ? ask(truth, wrong) : Result<std::uint64_t>(std::unexpected(begun.error()));
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const bool fine = wrong == 0 && begun && seconds < kLongest && (done || !s.recovers) &&
                      (done || !done.error().message.empty()) && !(done && s.other_version);
    (done ? right : errors) += 1;
    bad += fine ? 0 : 1;
    std::printf("schedule %2llu %-29s %s %5.2f s  %s\n", static_cast<unsigned long long>(number),
                s.kind, fine ? "fine" : "BAD ", seconds,
                done ? ("right, " + std::to_string(*done) + " retries").c_str()
                     : done.error().message.c_str());
    std::fflush(stdout);
  }
  std::printf("schedules: %d right, %d with one error, %d bad\n", right, errors, bad);
  return bad == 0 ? 0 : 1;
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) {
  const std::string mode = argc > 2 ? argv[1] : "";
  if (mode == "truth") return gridrt::make_truth(argv[2]);
  if (mode == "run" && argc == 4) return gridrt::run(argv[2], std::strtoull(argv[3], nullptr, 10));
  return 2;
}
