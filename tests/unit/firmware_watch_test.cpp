// The watchdog: an engine that hangs, a shell that does not answer.
#include "tests/unit/firmware_support.hpp"

namespace gridrt {
namespace {

using protocol::JournalCode;

TEST(FirmwareWatch, AHungEngineIsResetAndTheHostIsTold) {
  const auto board = make_board();
  board->poll();
  while (board->take_input()) {
  }
  read_journal(*board);
  board->hang_engine();
  board->poll();
  EXPECT_EQ(board->core_resets(), 1);
  const auto event = board->take_input();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->id, protocol::EventReport::kId);
  EXPECT_EQ(event->body[0], static_cast<std::byte>(JournalCode::kEngineHung));
  const auto journal = read_journal(*board);
  ASSERT_EQ(journal.size(), 1U);
  EXPECT_EQ(journal[0].first, JournalCode::kEngineHung);
  EXPECT_GE(journal[0].second, 1U << 20U);
  board->poll();
  EXPECT_EQ(board->core_resets(), 1);  // once
}

TEST(FirmwareWatch, TheImageInFlashIsLoadedAgainButNotInPlaceOfAHosts) {
  const auto board = make_board(board_options(must_flash(board_image())));
  board->hang_engine();
  board->poll();
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kReady);
  EXPECT_EQ(report<protocol::BootReport>(*board).resident, 1U);

  ASSERT_TRUE(set(*board, protocol::ResetReport{.key = protocol::kResetKey}));  // the host's wish
  board->hang_engine();
  board->poll();
  EXPECT_EQ(board->core_resets(), 2);
  EXPECT_EQ(state_of(*board), protocol::DeviceState::kEmpty);
}

TEST(FirmwareWatch, AShellThatDoesNotAnswerIsResetAndNothingMadeUpIsTold) {
  const auto board = make_board(board_options(must_flash(board_image())));
  read_journal(*board);
  while (board->take_input()) {
  }
  board->break_bus();
  std::array<std::byte, protocol::CountersReport::kBytes> body{};
  EXPECT_FALSE(board->get_feature(protocol::CountersReport::kId, body));
  EXPECT_TRUE(board->get_feature(protocol::CountersReport::kId, body));
  EXPECT_EQ(board->core_resets(), 1);
  const auto journal = read_journal(*board);
  ASSERT_EQ(journal.size(), 2U);
  EXPECT_EQ(journal[0].first, JournalCode::kBusTimeout);
  EXPECT_EQ(journal[1].first, JournalCode::kBooted);
  // No Status that says "empty", which is what a register that is not served reads as.
  while (const auto input = board->take_input()) {
    EXPECT_NE(input->id, protocol::StatusReport::kId);
  }
}

}  // namespace
}  // namespace gridrt
