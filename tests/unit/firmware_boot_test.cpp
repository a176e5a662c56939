// Images in flash: loaded, refused with the right code, told apart from a host's.
#include <cstring>
#include <stdexcept>

#include "hal/crc32c.hpp"
#include "host/image/image_frames.hpp"
#include "tests/unit/firmware_support.hpp"

namespace gridrt {
namespace {

using protocol::BootError;
using protocol::BootState;
using protocol::JournalCode;

constexpr std::size_t kHeader = protocol::FlashHeader::kBytes;

protocol::FlashHeader header_of(const std::vector<std::byte>& flash) {
  return protocol::load_flash_header(std::span(flash).first<kHeader>());
}

/// `flash` with another header, its CRC right.
std::vector<std::byte> with_header(std::vector<std::byte> flash, protocol::FlashHeader header) {
  std::array<std::byte, kHeader> head{};
  protocol::store(header, head);
  header.header_crc = crc32c(std::span(head).first(kHeader - 4));
  protocol::store(header, head);
  std::ranges::copy(head, flash.begin());
  return flash;
}

TEST(FirmwareBoot, AnErasedFlashIsNoError) {
  const auto board = make_board();
  const auto boot = report<protocol::BootReport>(*board);
  EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kAbsent);
  EXPECT_EQ(boot.error, 0);
  EXPECT_EQ(boot.resident, 0U);
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kEmpty);
}

TEST(FirmwareBoot, AnImageInFlashIsReadyWithoutAHost) {
  const Image image = board_image();
  const auto flash = must_flash(image);
  const auto board = make_board(board_options(flash));
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kReady);
  const auto boot = report<protocol::BootReport>(*board);
  EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kBooted);
  EXPECT_EQ(boot.length, flash.size() - kHeader);
  EXPECT_EQ(boot.resident, 1U);
  EXPECT_EQ(boot.fingerprint, fingerprint(image));
  EXPECT_NE(boot.fingerprint, fingerprint(board_image(4)));
  EXPECT_EQ(read_journal(*board),
            (Entries{{JournalCode::kStarted, 0},
                     {JournalCode::kBooted, static_cast<std::uint32_t>(flash.size() - kHeader)}}));
  EXPECT_EQ(board->core_resets(), 0);
}

TEST(FirmwareBoot, AHostsImageIsNotTakenForTheOneInFlash) {
  const auto board = make_board(board_options(must_flash(board_image())));
  ASSERT_EQ(report<protocol::BootReport>(*board).resident, 1U);
  std::uint32_t sequence = 100;
  const auto frames = image_frames(board_image(4), board_capabilities().max_payload, sequence);
  ASSERT_TRUE(frames);
  ASSERT_TRUE(board->consume(*frames));
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kReady);
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 0U);
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kBoot));
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 1U);
  ASSERT_TRUE(set(*board, protocol::ResetReport{.key = protocol::kResetKey}));
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 0U);
}

TEST(FirmwareBoot, TheImageInFlashIsBackAfterASelfTest) {
  const auto board = make_board(board_options(must_flash(board_image())));
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kSelfTest));
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 1U);
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kReady);
}

struct Refusal {
  const char* name;
  std::vector<std::byte> (*spoil)(std::vector<std::byte>);
  BootError error;
};

const Refusal kRefusals[] = {
    {"a bit of the header",
     [](std::vector<std::byte> flash) {
       flash[14] ^= std::byte{1};
       return flash;
     },
     BootError::kBadHeader},
    {"another version",
     [](std::vector<std::byte> flash) {
       auto header = header_of(flash);
       header.version = 9;
       return with_header(std::move(flash), header);
     },
     BootError::kBadVersion},
    {"no frames",
     [](std::vector<std::byte> flash) {
       auto header = header_of(flash);
       header.bytes = 0;
       return with_header(std::move(flash), header);
     },
     BootError::kBadLength},
    {"half a word",
     [](std::vector<std::byte> flash) {
       auto header = header_of(flash);
       header.bytes -= 2;
       return with_header(std::move(flash), header);
     },
     BootError::kBadLength},
    {"more than fits",
     [](std::vector<std::byte> flash) {
       auto header = header_of(flash);
       header.bytes = protocol::kFlashMaxBytes + 4;
       return with_header(std::move(flash), header);
     },
     BootError::kBadLength},
    {"Commit is missing",
     [](std::vector<std::byte> flash) {
       auto header = header_of(flash);
       header.bytes -= 32;
       return with_header(std::move(flash), header);
     },
     BootError::kShellSilent},
    {"a bit of a section",
     [](std::vector<std::byte> flash) {
       flash[flash.size() / 2] ^= std::byte{4};
       return flash;
     },
     BootError::kRefused},
    {"a bit of the image's header",
     [](std::vector<std::byte> flash) {
       flash[kHeader + 60] ^= std::byte{4};
       return flash;
     },
     BootError::kRefused},
};

TEST(FirmwareBoot, EachFaultOfTheFlashHasItsCodeAndLeavesTheBoardEmptyAndAlive) {
  const auto good = must_flash(board_image());
  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(refusal.name);
    const auto board = make_board(board_options(refusal.spoil(good)));
    const auto boot = report<protocol::BootReport>(*board);
    EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kFailed);
    EXPECT_EQ(static_cast<BootError>(boot.error), refusal.error);
    EXPECT_EQ(boot.refusal != 0, refusal.error == BootError::kRefused);
    EXPECT_EQ(boot.resident, 0U);
    EXPECT_EQ(state_of(*board), protocol::DeviceState::kEmpty);
    EXPECT_EQ(read_journal(*board).back(),
              std::pair(JournalCode::kBootFailed, static_cast<std::uint32_t>(refusal.error)));
    ASSERT_TRUE(command(*board, protocol::BoardCommand::kSelfTest));
    EXPECT_EQ(report<protocol::SelfTestReport>(*board).right,
              report<protocol::SelfTestReport>(*board).total);
  }
}

TEST(FirmwareBoot, ASilentFlashOrLoaderEndsTheBootInTime) {
  const auto flash = must_flash(board_image());
  const auto board = make_board(board_options(flash));
  board->silence_flash(5);
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kBoot));
  auto boot = report<protocol::BootReport>(*board);
  EXPECT_EQ(static_cast<BootError>(boot.error), BootError::kFlashSilent);
  EXPECT_EQ(boot.detail, protocol::kFlashAddress + 20);
  board->silence_flash(flash.size() / 8);
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kBoot));
  boot = report<protocol::BootReport>(*board);
  EXPECT_EQ(static_cast<BootError>(boot.error), BootError::kFlashSilent);
  EXPECT_EQ(boot.detail, protocol::kFlashAddress + flash.size() / 8 * 4);
  board->silence_flash(~std::size_t{0});
  board->stop_loader();
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kBoot));
  EXPECT_EQ(static_cast<BootError>(report<protocol::BootReport>(*board).error),
            BootError::kShellSilent);
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kBoot));
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 1U);
}

TEST(FirmwareBoot, AShellThatNeverStopsAnsweringEndsTheBootInTime) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 20U;  // reads and writes of registers
  bool endless = true;
  std::uint64_t reads = 0;
  auto options = board_options(must_flash(board_image()));
  options.reads = [&](std::uint32_t address, std::uint32_t value) -> std::uint32_t {
    namespace feed = wire::registers::Feed;
    if (++reads > kMost) throw std::runtime_error("the firmware reads for ever");
    if (!endless) return value;
    return address == feed::kAnswer ? 1U << feed::kAnswerValidBit : value;
  };
  const auto board = make_board(options);
  EXPECT_EQ(static_cast<BootError>(report<protocol::BootReport>(*board).error),
            BootError::kShellSilent);
  endless = false;
  ASSERT_TRUE(command(*board, protocol::BoardCommand::kBoot));
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 1U);
}

TEST(FirmwareBoot, WhatDoesNotFitAFlashImageIsRefusedWhenItIsMade) {
  Image wide = must_build(random_scene(60, 3), {.layout = protocol::Layout::kWide});
  EXPECT_EQ(flash_image(wide, board_capabilities()).error().kind, ErrorKind::kUnsupported);
  Image chunk = board_image();
  chunk.header.chunks = 2;
  EXPECT_EQ(flash_image(chunk, board_capabilities()).error().kind, ErrorKind::kLimit);
}

}  // namespace
}  // namespace gridrt
