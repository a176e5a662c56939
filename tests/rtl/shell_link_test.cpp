// The host's driver against gridrt_shell over links that lose, damage, cut, double and reorder
// frames; behind the shell the software engine answers. Whatever happens, the hits are those of
// seq.
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "host/driver/device.hpp"
#include "host/driver/session.hpp"
#include "host/image/image_file.hpp"
#include "host/pe/image_store.hpp"
#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::SectionKind;

constexpr int kIdleClocks = 2000;

/// The bench as the device's end of a link.
class ShellEndpoint final : public Endpoint {
 public:
  explicit ShellEndpoint(ShellBench& bench) : bench_(bench) {}

  Result<void> consume(std::span<const std::byte> bytes) override {
    bench_.send(bytes);
    return {};
  }
  Result<std::size_t> produce(std::span<std::byte> out,
                              std::chrono::milliseconds /*timeout*/) override {
    for (int quiet = 0; bench_.from_device.empty() && quiet < 3 * kIdleClocks; ++quiet) {
      if (!bench_.to_device.empty()) quiet = 0;
      bench_.tick();
    }
    const std::size_t count = std::min(out.size(), bench_.from_device.size());
    const auto end = bench_.from_device.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(bench_.from_device.begin(), end, out.begin());
    bench_.from_device.erase(bench_.from_device.begin(), end);
    return count;
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    const std::map<int, std::uint32_t> windows{{1, 0x040}, {2, 0x080}, {3, 0x0C0}, {4, 0x100}};
    const auto window = windows.find(id);
    if (window == windows.end()) return fail(ErrorKind::kUnsupported, "no such report");
    for (std::size_t i = 0; i + 4 <= body.size(); i += 4) {
      protocol::detail::put32(body.data() + i,
                              bench_.read(window->second + static_cast<std::uint32_t>(i)));
    }
    return {};
  }
  Result<void> set_feature(std::uint8_t /*id*/, std::span<const std::byte> /*body*/) override {
    bench_.reset_report();
    return {};
  }

 private:
  ShellBench& bench_;
};

/// The image as the software engine has it.
std::unique_ptr<CommittedImage> committed(const Image& image) {
  ImageStore store;
  const auto add = [&](SectionKind kind, std::uint8_t pe, std::span<const std::byte> bytes) {
    protocol::LoadHead head;
    head.kind = static_cast<std::uint8_t>(kind);
    head.pe = pe;
    head.total = static_cast<std::uint32_t>(bytes.size());
    head.bytes = head.total;
    EXPECT_TRUE(store.add(head, bytes));
  };
  add(SectionKind::kHeader, 0, header_section(image));
  for (const ImageSection& s : image.sections) {
    if (s.kind != SectionKind::kIds && s.kind != SectionKind::kScene) add(s.kind, s.pe, s.bytes);
  }
  auto done = store.commit((std::uint64_t{1} << image.header.pes) - 1);
  EXPECT_TRUE(done);
  return std::move(*done);
}

EngineHit answer(const Engine& engine, const protocol::RayCompact& record) {
  PeRay ray;
  for (int a = 0; a < 3; ++a) {
    ray.p0[a] = static_cast<int>(record.p0[static_cast<std::size_t>(a)]);
    ray.p1[a] = static_cast<int>(record.p1[static_cast<std::size_t>(a)]);
  }
  ray.ignore = record.ignore == protocol::kNoIdCompact ? kNoTriangle : record.ignore;
  PeCounters counters;
  if (record.any_hit) {
    return engine.any_hit(ray, counters) ? EngineHit{true, 0} : EngineHit{};
  }
  const PeAnswer hit = engine.closest_hit(ray, counters);
  return hit ? EngineHit{true, hit->id} : EngineHit{};
}

struct Case {
  const char* name;
  FaultRates to_device;
  FaultRates to_host;
};

class ShellLink : public testing::TestWithParam<Case> {};

TEST_P(ShellLink, TheDriverGetsItsAnswers) {
  const FaultRates& to_device = GetParam().to_device;
  const FaultRates& to_host = GetParam().to_host;
  std::uint64_t faults = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    ShellBench bench(seed);
    bench.pace = {.rx = 95, .tx = 90, .ray = 80, .hit = 80};
    bench.write(0x1C0, kIdleClocks);
    DeviceOptions options;
    options.rays_per_frame = 20;
    options.frames_in_flight = 5;
    auto transport = std::make_unique<LoopbackTransport>(
        std::make_unique<ShellEndpoint>(bench),
        LoopbackOptions{.to_device = to_device, .to_host = to_host, .seed = seed});
    const LoopbackTransport& link = *transport;
    auto session = Session::open(std::move(transport), options);
    ASSERT_TRUE(session) << session.error().message;
    DeviceOptions software;
    software.name = "seq";
    auto reference = open_device(software);
    ASSERT_TRUE(reference);
    for (const int bits : {12, 17}) {
      const Image image = small_image(bits, 4);
      const auto engine = committed(image);
      bench.engine = [&](const protocol::RayCompact& ray) { return answer(engine->engine, ray); };
      const auto loaded = (*session)->load(image);
      ASSERT_TRUE(loaded) << loaded.error().message;
      ASSERT_TRUE((*reference)->load(image));
      std::vector<Segment> segments;
      for (const protocol::RayCompact& ray : rays_in(image, 1000, seed)) {
        Segment s;
        for (int a = 0; a < 3; ++a) {
          s.p0[a] = static_cast<int>(ray.p0[static_cast<std::size_t>(a)]);
          s.p1[a] = static_cast<int>(ray.p1[static_cast<std::size_t>(a)]);
        }
        s.t1 = 1.0;
        segments.push_back(s);
      }
      for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
        std::vector<Hit> hits(segments.size());
        std::vector<Hit> expected(segments.size());
        const auto done = (*session)->trace(segments, query, hits);
        ASSERT_TRUE(done) << done.error().message;
        ASSERT_TRUE((*reference)->trace(segments, query, expected));
        for (std::size_t i = 0; i < hits.size(); ++i) {
          ASSERT_EQ(hits[i].id, expected[i].id) << "ray " << i;
        }
      }
    }
    faults += link.faults();
  }
  EXPECT_EQ(faults > 20, to_device.any() || to_host.any()) << faults;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, ShellLink,
    testing::Values(Case{"none", {}, {}}, Case{"drop", {.drop = 0.05}, {.drop = 0.05}},
                    Case{"flip", {.flip = 0.05}, {.flip = 0.05}},
                    Case{"truncate", {.truncate = 0.05}, {.truncate = 0.05}},
                    Case{"duplicate", {.duplicate = 0.2}, {.duplicate = 0.2}},
                    Case{"reorder", {.reorder = 0.1}, {.reorder = 0.1}},
                    Case{"garbage", {.garbage = 0.2}, {.garbage = 0.2}},
                    Case{"all",
                         {.drop = 0.01,
                          .flip = 0.02,
                          .truncate = 0.01,
                          .duplicate = 0.02,
                          .reorder = 0.02,
                          .garbage = 0.05},
                         {.drop = 0.01, .flip = 0.02, .duplicate = 0.02, .garbage = 0.05}}),
    [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace gridrt::rtl
