// gridrt_shell moves a byte a clock, in and out.
#include <gtest/gtest.h>

#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::FrameType;

TEST(ShellPace, ImagesComeAByteAClock) {
  ShellBench bench;
  send_image(bench, small_image(GRIDRT_RTL_B, GRIDRT_RTL_PES), 1);
  const auto bytes = static_cast<long>(bench.to_device.size());
  const long start = bench.clocks();
  while (!bench.to_device.empty()) bench.tick();
  // Three clocks a frame, and what its head takes to check.
  EXPECT_LE(bench.clocks() - start, bytes + bytes / 200);
}

// 16 bytes a ray are the limit on the way in, 4 bytes a hit on the way out.
TEST(ShellPace, RaysAndHitsMoveAByteAClock) {
  ShellBench bench;
  const Image image = small_image(12, GRIDRT_RTL_PES);
  send_image(bench, image, 1);
  bench.run_until_quiet();
  take_answers(bench);
  const auto rays = rays_in(image, 1000, 3);
  bench.send(FrameType::kTrace, 20, trace_payload(rays, 1), protocol::Layout::kCompact);
  long start = bench.clocks();
  while (!bench.to_device.empty()) bench.tick();
  EXPECT_LE(bench.clocks() - start, 16 * 1000 + 60);
  bench.run_until_quiet();
  EXPECT_EQ(take_answers(bench).size(), 1U);
  bench.pace.hit = 0;
  bench.send(FrameType::kTrace, 21, trace_payload(rays, 1), protocol::Layout::kCompact);
  while (!bench.to_device.empty()) bench.tick();
  bench.pace.hit = 100;
  start = bench.clocks();
  while (bench.from_device.size() < 4000) bench.tick();
  EXPECT_LE(bench.clocks() - start, 4 * 1000 + 10);
  bench.run_until_quiet();
  EXPECT_EQ(take_answers(bench).size(), 1U);
}

}  // namespace
}  // namespace gridrt::rtl
