// Control reports through the firmware: what is copied, what is refused, self-test and journal.
#include "tests/unit/firmware_support.hpp"

namespace gridrt {
namespace {

using protocol::BoardCommand;
using protocol::JournalCode;
using protocol::SelfTestState;

TEST(FirmwareReports, AreTheCoresOwnAndTheBoardsSerialNumber) {
  const auto board = make_board();
  const auto identity = report<protocol::IdentityReport>(*board);
  EXPECT_EQ(identity.protocol_version, protocol::kVersion);
  EXPECT_EQ(std::string(identity.name.begin(), identity.name.begin() + 4), std::string("seq\0", 4));
  EXPECT_EQ(std::string(identity.serial.begin(), identity.serial.begin() + 5),
            std::string("T-42\0", 5));
  EXPECT_EQ(report<protocol::CapabilitiesReport>(*board), board_capabilities());
  EXPECT_EQ(report<protocol::CountersReport>(*board).rays, 0U);
}

TEST(FirmwareReports, WhatIsNotThereIsRefused) {
  const auto board = make_board();
  std::array<std::byte, 63> body{};
  for (const int id : {0, 5, 6, 7, 8, 16, 32, 33, 200}) {  // software PEs have neither 6, 7 nor 8
    const auto got = board->get_feature(static_cast<std::uint8_t>(id), body);
    ASSERT_FALSE(got) << id;
    EXPECT_EQ(got.error().kind, ErrorKind::kUnsupported);
  }
  for (const int id : {0, 1, 2, 3, 4, 9, 10, 11, 32}) {
    EXPECT_FALSE(board->set_feature(static_cast<std::uint8_t>(id), body)) << id;
  }
}

TEST(FirmwareReports, ASetWithWrongContentIsRefusedAndDoesNothing) {
  const auto board = make_board(board_options(must_flash(board_image())));
  ASSERT_EQ(state_of(*board), protocol::DeviceState::kReady);
  EXPECT_FALSE(set(*board, protocol::ResetReport{.key = 1}));
  std::array<std::byte, 4> key{};
  protocol::store(protocol::ResetReport{.key = protocol::kResetKey}, key);
  EXPECT_FALSE(board->set_feature(protocol::ResetReport::kId, std::span(key).first(3)));
  EXPECT_FALSE(command(*board, BoardCommand::kNone));
  EXPECT_FALSE(command(*board, static_cast<BoardCommand>(99)));
  EXPECT_FALSE(board->set_feature(protocol::CommandReport::kId, {}));
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kReady);
  EXPECT_EQ(report<protocol::SelfTestReport>(*board).runs, 0U);
  ASSERT_TRUE(set(*board, protocol::ResetReport{.key = protocol::kResetKey}));
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kEmpty);
  EXPECT_EQ(read_journal(*board).back(), std::pair(JournalCode::kHostReset, 0U));
}

TEST(FirmwareReports, TheSelfTestComparesEveryByte) {
  const auto board = make_board();
  const auto before = report<protocol::SelfTestReport>(*board);
  EXPECT_EQ(static_cast<SelfTestState>(before.state), SelfTestState::kNever);
  ASSERT_TRUE(command(*board, BoardCommand::kSelfTest));
  const auto after = report<protocol::SelfTestReport>(*board);
  EXPECT_EQ(static_cast<SelfTestState>(after.state), SelfTestState::kPassed);
  EXPECT_EQ(after.runs, 1U);
  EXPECT_EQ(after.rays, 48U);
  EXPECT_GT(after.total, 4U * after.rays);
  EXPECT_EQ(after.right, after.total);
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kEmpty);
  EXPECT_EQ(read_journal(*board).back(), std::pair(JournalCode::kSelfTestPassed, 48U));

  // One wrong byte anywhere, one that is missing or one too many is a failure at that place.
  std::vector<std::uint8_t> answers(
      firmware::kSelfTestVectors.answers,
      firmware::kSelfTestVectors.answers + firmware::kSelfTestVectors.answer_bytes);
  const auto fails_at = [&](std::uint32_t place, std::uint32_t bytes) {
    firmware::BoardModelOptions options = board_options();
    options.vectors.answers = answers.data();
    options.vectors.answer_bytes = bytes;
    const auto wrong = make_board(options);
    ASSERT_TRUE(command(*wrong, BoardCommand::kSelfTest));
    const auto result = report<protocol::SelfTestReport>(*wrong);
    EXPECT_EQ(static_cast<SelfTestState>(result.state), SelfTestState::kFailed) << place;
    EXPECT_EQ(result.right, place);
    EXPECT_EQ(read_journal(*wrong).back(), std::pair(JournalCode::kSelfTestFailed, place));
  };
  const auto all = static_cast<std::uint32_t>(answers.size());
  for (std::uint32_t i = 0; i < all; i += 23) {
    answers[i] ^= 0x10;
    fails_at(i, all);
    answers[i] ^= 0x10;
  }
  fails_at(all - 1, all - 1);
  answers.push_back(0);
  fails_at(all, all + 1);
}

TEST(FirmwareReports, TheSelfTestWaitsForAFrameOfTheLinkButNotForEver) {
  const auto board = make_board();
  std::vector<std::byte> frame;
  ASSERT_TRUE(append_frame(frame, protocol::FrameType::kNoOp, protocol::Layout::kNone, 7, {}));
  ASSERT_TRUE(board->consume(std::span(frame).first(22)));
  ASSERT_TRUE(command(*board, BoardCommand::kSelfTest));
  const auto busy = report<protocol::SelfTestReport>(*board);
  EXPECT_EQ(static_cast<SelfTestState>(busy.state), SelfTestState::kBusy);
  ASSERT_TRUE(board->consume(std::span(frame).subspan(22)));
  std::array<std::byte, 64> out{};
  EXPECT_EQ(board->produce(out, std::chrono::milliseconds(0)).value_or(0), frame.size());
  ASSERT_TRUE(command(*board, BoardCommand::kSelfTest));
  EXPECT_EQ(static_cast<SelfTestState>(report<protocol::SelfTestReport>(*board).state),
            SelfTestState::kPassed);
}

TEST(FirmwareReports, TheJournalKeepsTheLatestEntriesAndSaysWhatItLost) {
  const auto board = make_board();
  EXPECT_EQ(read_journal(*board), (Entries{{JournalCode::kStarted, 0}}));
  EXPECT_TRUE(read_journal(*board).empty());
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(set(*board, protocol::ResetReport{.key = protocol::kResetKey}));
  }
  const auto first = report<protocol::JournalReport>(*board);
  EXPECT_EQ(first.count, 4);
  EXPECT_EQ(first.lost, 1);
  EXPECT_LT(first.clocks[0], first.clocks[3]);
  EXPECT_EQ(report<protocol::JournalReport>(*board).count, 4);
  EXPECT_EQ(report<protocol::JournalReport>(*board).count, 0);
}

TEST(FirmwareReports, InputReportsTellWhatHappensAndChangesOfState) {
  const auto board = make_board(board_options(must_flash(board_image())));
  const auto take = [&] { return board->take_input(); };
  auto first = take();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->id, protocol::EventReport::kId);
  EXPECT_EQ(first->body[0], static_cast<std::byte>(JournalCode::kStarted));
  // What happened before that was fetched is in the journal; the state goes out when there is room.
  auto second = take();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->id, protocol::StatusReport::kId);
  EXPECT_EQ(second->body[0], static_cast<std::byte>(protocol::DeviceState::kReady));
  EXPECT_FALSE(take());
  ASSERT_TRUE(set(*board, protocol::ResetReport{.key = protocol::kResetKey}));
  auto third = take();
  ASSERT_TRUE(third);
  EXPECT_EQ(third->id, protocol::EventReport::kId);
  EXPECT_EQ(third->body[0], static_cast<std::byte>(JournalCode::kHostReset));
  auto fourth = take();
  ASSERT_TRUE(fourth);
  EXPECT_EQ(fourth->id, protocol::StatusReport::kId);
  EXPECT_EQ(fourth->body[0], static_cast<std::byte>(protocol::DeviceState::kEmpty));
  EXPECT_FALSE(take());
}

}  // namespace
}  // namespace gridrt
