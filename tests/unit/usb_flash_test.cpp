// The virtual board that starts from a flash image, seen by the device usb: rays without an upload,
// and what a damaged or foreign image leads to.
#include <bit>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "host/driver/device.hpp"
#include "host/driver/flash_image.hpp"
#include "host/image/image.hpp"
#include "host/pe/capabilities.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/unit/usb_fake_bus.hpp"
#include "tools/virtual/board.hpp"

namespace gridrt {
namespace {

using protocol::BootError;
using protocol::BootState;
using protocol::DeviceState;
using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kSeed = 31;  ///< of the scene that is in flash
constexpr std::uint64_t kOtherSeed = 32;

Scene scene(std::uint64_t seed) { return contract::awkward_scene(seed); }

Image build(std::uint64_t seed, ImageOptions options = {.layout = protocol::Layout::kCompact}) {
  options.grid = glm::ivec3{6};
  options.with_scene = false;
  auto built = build_image(scene(seed), options);
  EXPECT_TRUE(built) << built.error().message;
  return *built;
}

const Bytes& flash() {
  static const Bytes only = flash_image(build(kSeed), board_capabilities()).value();
  return only;
}

/// A flash image of a board with other limits.
Bytes foreign(const ImageOptions& options) {
  return flash_image(build(kSeed, options), software_capabilities()).value();
}

class Board {
 public:
  explicit Board(Bytes content, std::string core = "seq")
      : board_(make_virtual_board({.core = std::move(core), .flash = std::move(content)}).value()),
        function_(*board_.endpoint, {.input = board_.input}) {
    fake::bus().plug_in(function_);
  }

  template <class Report>
  Report report() {
    std::array<std::byte, Report::kBytes> body{};
    const auto done = board_.endpoint->get_feature(Report::kId, body);
    EXPECT_TRUE(done) << done.error().message;
    Report out;
    protocol::load(body, out);
    return out;
  }
  DeviceState state() { return static_cast<DeviceState>(report<protocol::StatusReport>().state); }

  /// Opens it as the device usb, loads an image and compares all answers with seq's; returns how
  /// often an image was sent.
  std::uint64_t right_answers(std::uint64_t seed, const Image& image) {
    static const auto rays = [](std::uint64_t of) {
      return contract::awkward_segments(scene(of), kDefaultBits, of);
    };
    static const std::vector<Segment> all[] = {rays(kSeed), rays(kOtherSeed)};
    static const std::vector<Hit> right[] = {
        contract::reference(scene(kSeed), kDefaultBits, all[0], Query::kClosestHit),
        contract::reference(scene(kOtherSeed), kDefaultBits, all[1], Query::kClosestHit)};
    auto device = open_device({.name = "usb"});
    EXPECT_TRUE(device) << device.error().message;
    if (!device) return ~std::uint64_t{0};
    const auto loaded = (*device)->load(image);
    EXPECT_TRUE(loaded) << loaded.error().message;
    const std::vector<Hit> hits = contract::trace(**device, all[seed - kSeed], Query::kClosestHit);
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Hit& expected = right[seed - kSeed][i];
      EXPECT_EQ(hits[i].id, expected.id) << "ray " << i;
      EXPECT_EQ(bits(hits[i].t), bits(expected.t)) << "ray " << i;
      EXPECT_EQ(bits(hits[i].u), bits(expected.u)) << "ray " << i;
      EXPECT_EQ(bits(hits[i].v), bits(expected.v)) << "ray " << i;
      if (testing::Test::HasFailure()) break;
    }
    return (*device)->counters()->uploads;
  }

  /// Empty, with this reason, and as good as a board with an erased flash.
  void expect_refused(BootError why) {
    const auto boot = report<protocol::BootReport>();
    EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kFailed);
    EXPECT_EQ(static_cast<BootError>(boot.error), why);
    EXPECT_EQ(boot.refusal != 0, why == BootError::kRefused);
    EXPECT_EQ(boot.resident, 0U);
    EXPECT_EQ(state(), DeviceState::kEmpty);
    EXPECT_EQ(right_answers(kSeed, build(kSeed)), 1U);
  }

 private:
  VirtualBoard board_;
  UsbFunction function_;
};

TEST(UsbFlash, RaysAreAnsweredWithoutAnUpload) {
  for (const char* core : {"seq", "omp"}) {
    Board board(flash(), core);
    EXPECT_EQ(board.state(), DeviceState::kReady);
    EXPECT_EQ(board.right_answers(kSeed, build(kSeed)), 0U);
    EXPECT_EQ(board.right_answers(kSeed, build(kSeed)), 0U) << "the next program";
  }
}

TEST(UsbFlash, AnUploadTakesThePlaceOfTheImageInFlash) {
  Board board(flash());
  EXPECT_EQ(board.right_answers(kOtherSeed, build(kOtherSeed)), 1U);
  EXPECT_EQ(board.report<protocol::BootReport>().resident, 0U);
  EXPECT_EQ(board.right_answers(kSeed, build(kSeed)), 1U) << "it is not there any more";
}

TEST(UsbFlash, AnImageForFewerPesIsRight) {
  for (const int pes : {1, 2}) {
    const Image image = build(kSeed, {.pes = pes, .layout = protocol::Layout::kCompact});
    Board board(flash_image(image, board_capabilities()).value());
    EXPECT_EQ(board.right_answers(kSeed, image), 0U);
  }
}

TEST(UsbFlash, AnImageOfAnotherBoardIsRefused) {
  for (const ImageOptions& options :
       {ImageOptions{.pes = 8, .layout = protocol::Layout::kWide},
        ImageOptions{.pes = 4, .layout = protocol::Layout::kWide},
        ImageOptions{.bits = kDefaultBits + 3, .layout = protocol::Layout::kWide}}) {
    SCOPED_TRACE(std::to_string(options.pes) + " PEs, " + std::to_string(options.bits) + " bits");
    Board board(foreign(options));
    board.expect_refused(BootError::kRefused);
  }
}

TEST(UsbFlash, ACutImageIsRefused) {
  for (const std::size_t left : {std::size_t{64}, flash().size() / 3, flash().size() - 4}) {
    SCOPED_TRACE(left);
    Bytes content = flash();
    content.resize(left);
    Board board(std::move(content));
    board.expect_refused(BootError::kRefused);
  }
}

TEST(UsbFlash, WhatIsNoFlashImageIsABoardWithoutAScene) {
  for (const Bytes& content : {Bytes{}, Bytes(3), Bytes(5000, std::byte{0x5A})}) {
    Board board(content);
    const auto boot = board.report<protocol::BootReport>();
    EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kAbsent);
    EXPECT_EQ(board.state(), DeviceState::kEmpty);
    EXPECT_EQ(board.right_answers(kSeed, build(kSeed)), 1U);
  }
}

TEST(UsbFlash, AFlippedByteIsFoundWhereverItIs) {
  std::mt19937_64 random(9);
  constexpr int kFlips = 200;
  int refused = 0;
  for (int flip = 0; flip < kFlips; ++flip) {
    Bytes content = flash();
    // The headers are small and would hardly be met.
    const std::size_t at = random() % (flip % 4 == 0 ? 160 : content.size());
    content[at] ^= static_cast<std::byte>(1 + random() % 255);
    SCOPED_TRACE("byte " + std::to_string(at));
    Board board(std::move(content));
    const auto boot = board.report<protocol::BootReport>();
    EXPECT_EQ(boot.resident, 0U);
    EXPECT_EQ(board.state(), DeviceState::kEmpty);
    refused += static_cast<BootState>(boot.state) == BootState::kFailed ? 1 : 0;
    if (flip % 20 == 0) {
      EXPECT_EQ(board.right_answers(kSeed, build(kSeed)), 1U);
    }
    if (HasFailure()) break;
  }
  EXPECT_GT(refused, kFlips / 2);  // the others have no magic number any more
}

}  // namespace
}  // namespace gridrt
