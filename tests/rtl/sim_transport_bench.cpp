// The link to a simulated board, against a board that says what it hears and may fall silent.
#include <array>
#include <filesystem>
#include <random>
#include <vector>

#include <Vgridrt_sim_probe.h>
#include <gtest/gtest.h>

#include "hal/sim/sim_transport.hpp"
#include "hal/sim/verilated_board.hpp"

namespace gridrt {
namespace {

using Board = VerilatedBoard<Vgridrt_sim_probe>;
constexpr std::chrono::milliseconds kAnyTime{1};

SimTransport open(SimTransportOptions options = {.silent_clocks = 1000, .most_silences = 2}) {
  auto board = std::make_unique<Board>();
  board->power_up();
  return SimTransport(std::move(board), options);
}

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int v : values) out.push_back(static_cast<std::byte>(v));
  return out;
}

std::vector<std::byte> receive_all(SimTransport& link, std::size_t piece = 1000) {
  std::vector<std::byte> all;
  std::vector<std::byte> buffer(piece);
  for (;;) {
    const auto got = link.receive(buffer, kAnyTime);
    EXPECT_TRUE(got) << got.error().message;
    if (!got || *got == 0) return all;
    all.insert(all.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*got));
  }
}

TEST(SimTransport, BytesComeBackInOrderHoweverTheyAreCut) {
  SimTransport link = open();
  std::mt19937 random(1);
  std::vector<std::byte> sent;
  std::vector<std::byte> received;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::byte> piece(random() % 300);
    for (std::byte& b : piece) b = static_cast<std::byte>(random() % 0xFE);
    ASSERT_TRUE(link.send(piece));
    sent.insert(sent.end(), piece.begin(), piece.end());
    if (random() % 3 == 0) {
      const auto read = get_report<protocol::StatusReport>(link);  // bytes come meanwhile
      ASSERT_TRUE(read) << read.error().message;
      EXPECT_EQ(read->state + 256U * read->reserved, sent.size() & 0xFFFFU);
    }
    std::vector<std::byte> out(1 + random() % 100);
    const auto got = link.receive(out, kAnyTime);
    ASSERT_TRUE(got);
    received.insert(received.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  const std::vector<std::byte> rest = receive_all(link);
  received.insert(received.end(), rest.begin(), rest.end());
  EXPECT_EQ(received, sent);
  // A byte a clock, but for the silence that ends each wait.
  EXPECT_LT(link.clocks(), 3 * sent.size() + 200 * 300);
}

TEST(SimTransport, ABoardThatTakesNoByteIsATimeoutInClocks) {
  SimTransport link = open();
  ASSERT_TRUE(link.send(bytes({1, 2, 0xFF, 3, 4})));
  std::vector<std::byte> out(10);
  EXPECT_EQ(link.receive(out, kAnyTime).value_or(0), 3U);
  const auto got = link.receive(out, kAnyTime);
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().kind, ErrorKind::kTimeout);
  EXPECT_NE(got.error().message.find("2 bytes"), std::string::npos) << got.error().message;
  EXPECT_NE(got.error().message.find("1000 clocks"), std::string::npos) << got.error().message;
  EXPECT_LT(link.clocks(), 5000U);
}

TEST(SimTransport, ABoardThatSaysNothingIsSilentThenATimeout) {
  SimTransport link = open();
  ASSERT_TRUE(link.send(bytes({0xFE})));
  std::vector<std::byte> out(10);
  EXPECT_EQ(link.receive(out, kAnyTime).value_or(0), 1U);  // its last word
  for (int attempt = 0; attempt < 2; ++attempt) {
    ASSERT_TRUE(link.send(bytes({1, 2, 3})));
    const auto got = link.receive(out, kAnyTime);
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(*got, 0U);
  }
  const auto got = link.receive(out, kAnyTime);
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().kind, ErrorKind::kTimeout);
  EXPECT_NE(got.error().message.find("1000 clocks"), std::string::npos) << got.error().message;
}

TEST(SimTransport, ResetBringsADeafBoardBack) {
  SimTransport link = open();
  ASSERT_TRUE(link.send(bytes({0xFF, 3, 4})));
  EXPECT_FALSE(get_report<protocol::StatusReport>(link));
  EXPECT_FALSE(set_report(link, protocol::ResetReport{.key = 1}));
  ASSERT_TRUE(set_report(link, protocol::ResetReport{.key = protocol::kResetKey}));
  ASSERT_TRUE(link.send(bytes({5})));
  EXPECT_EQ(receive_all(link), bytes({5}));  // what was on its way is gone
}

TEST(SimTransport, ReportsPassThroughTheMailbox) {
  SimTransport link = open();
  std::array<std::byte, 63> whole{};
  whole.fill(std::byte{9});
  ASSERT_TRUE(link.get_feature(protocol::StatusReport::kId, whole));
  EXPECT_EQ(whole[8], std::byte{8 + protocol::StatusReport::kId});
  EXPECT_EQ(whole[39], std::byte{39 + protocol::StatusReport::kId});
  EXPECT_EQ(whole[40], std::byte{0});  // behind what was answered
  std::array<std::byte, 5> part{};
  ASSERT_TRUE(link.get_feature(protocol::CapabilitiesReport::kId, part));
  EXPECT_EQ(part[4], std::byte{4 + protocol::CapabilitiesReport::kId});
  for (const int id : {0, 5, 16, 99}) {  // Reset cannot be read
    const auto none = link.get_feature(static_cast<std::uint8_t>(id), whole);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::kUnsupported);
  }
  EXPECT_EQ(link.set_feature(4, whole).error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(link.set_feature(7, std::span(whole).first(7)).error().kind, ErrorKind::kProtocol);
  EXPECT_TRUE(link.set_feature(7, std::span(whole).first(11)));
  ASSERT_TRUE(link.get_feature(protocol::StatusReport::kId, part));
  EXPECT_EQ(part[2], std::byte{11});
  EXPECT_EQ(part[3], whole[0]);
}

TEST(SimTransport, FirmwareThatDoesNotAnswerIsATimeoutInClocks) {
  SimTransport link = open({.report_clocks = 5000});
  std::array<std::byte, 4> body{};
  const auto got = link.get_feature(200, body);
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().kind, ErrorKind::kTimeout);
  EXPECT_NE(got.error().message.find("5000 clocks"), std::string::npos) << got.error().message;
  EXPECT_TRUE(link.get_feature(protocol::StatusReport::kId, body));  // the request was taken back
}

TEST(SimTransport, AnInputReportIsTakenOnce) {
  Board board;
  board.power_up();
  InputReport report;
  ASSERT_TRUE(board.take_input(report));
  EXPECT_EQ(report.id, 32);
  EXPECT_EQ(report.body[0], std::byte{100});
  EXPECT_EQ(report.body[62], std::byte{162});
  EXPECT_FALSE(board.take_input(report));
}

TEST(SimTransport, AByteOnOfferStaysWhileAReportIsTakenAndIsCountedOnce) {
  Board board;
  board.power_up();
  std::vector<std::byte> sent(40);
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::byte>(i);
  const RunLimits limits{.quiet = 100, .gap = 100};
  ReportAccess access{.id = protocol::StatusReport::kId};
  std::size_t taken = board.run(sent, {}, limits, &access).taken;
  EXPECT_EQ(taken, 16U);  // what the probe holds; the next byte is on offer
  InputReport report;
  ASSERT_TRUE(board.take_input(report));
  std::vector<std::byte> out(sent.size());
  std::size_t given = board.run({}, out, limits, nullptr).given;
  EXPECT_EQ(given, 17U);  // the probe has taken it when nobody had more to send
  while (given < out.size()) {
    const RunResult moved =
        board.run(std::span(sent).subspan(taken), std::span(out).subspan(given), limits, nullptr);
    ASSERT_GT(moved.taken + moved.given, 0U);
    taken += moved.taken;
    given += moved.given;
  }
  EXPECT_EQ(taken, sent.size());
  EXPECT_EQ(out, sent);
}

TEST(SimTransport, AnInputReportIsReadAndNoAnswerIsLostMeanwhile) {
  SimTransport link = open();
  ASSERT_TRUE(link.send(bytes({1, 2, 3})));
  std::array<std::byte, protocol::kReportBytes> body{};
  EXPECT_EQ(link.read_input(body, kAnyTime).value(), 32);
  EXPECT_EQ(body[0], std::byte{100});
  EXPECT_EQ(body[62], std::byte{162});
  EXPECT_EQ(body[63], std::byte{0});
  const std::uint64_t before = link.clocks();
  EXPECT_FALSE(link.read_input(body, kAnyTime).value());  // the board's time passes
  EXPECT_GT(link.clocks(), before);
  EXPECT_EQ(receive_all(link), bytes({1, 2, 3}));
}

TEST(SimTransport, ReportsOvertakeOnlyIfTheyMay) {
  SimTransport link = open({.silent_clocks = 1000, .most_silences = 2, .reports_wait = false});
  ASSERT_TRUE(link.send(bytes({0xFF, 3, 4})));
  EXPECT_TRUE(get_report<protocol::StatusReport>(link));  // of a deaf board
  const auto delivered = link.deliver();
  ASSERT_FALSE(delivered);
  EXPECT_EQ(delivered.error().kind, ErrorKind::kTimeout);
  EXPECT_TRUE(link.deliver(2)) << "two bytes may wait";
}

TEST(SimTransport, WavesAreWritten) {
  const auto path = std::filesystem::temp_directory_path() / "gridrt_sim_transport.fst";
  {
    auto board = std::make_unique<Board>();
    ASSERT_TRUE(board->trace_to(path.string()));
    board->power_up();
    SimTransport link(std::move(board), {.silent_clocks = 100});
    ASSERT_TRUE(link.send(bytes({1, 2, 3})));
    EXPECT_EQ(receive_all(link).size(), 3U);
  }
  EXPECT_GT(std::filesystem::file_size(path), 300U);
  std::filesystem::remove(path);
  Board board;
  EXPECT_FALSE(board.trace_to("/nowhere/at/all.fst"));
}

}  // namespace
}  // namespace gridrt
