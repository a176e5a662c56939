// The link to a board over stand-ins for libusb and hidapi: opening, both streams, reports,
// messages.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "hal/usb/messages.hpp"
#include "hal/usb/usb_transport.hpp"
#include "tests/unit/usb_board.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;

/// Gives back every byte that it takes, and more if it is asked to.
class Echo final : public Endpoint {
 public:
  Result<void> consume(std::span<const std::byte> bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return {};
  }
  Result<std::size_t> produce(std::span<std::byte> out, milliseconds /*timeout*/) override {
    if (endless) return out.size();
    const std::size_t size = std::min(out.size(), bytes_.size() - taken_);
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(taken_), size, out.begin());
    taken_ += size;
    return size;
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    if (id != 7) return fail(ErrorKind::kUnsupported, "no such report");
    std::ranges::fill(body, std::byte{0x55});
    return {};
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> /*body*/) override {
    return fail(ErrorKind::kProtocol, "refuses " + std::to_string(id));
  }
  bool endless = false;

 private:
  std::vector<std::byte> bytes_;
  std::size_t taken_ = 0;
};

class UsbLink : public testing::Test {
 protected:
  void SetUp() override { fake::bus().plug_in(function, 5); }
  void TearDown() override { EXPECT_EQ(fake::bus().counts.open, 0U); }

  static Error refusal(const UsbOptions& options = {}) {
    const auto link = open_usb(options);
    EXPECT_FALSE(link);
    return link ? Error{} : link.error();
  }

  Echo echo;
  UsbFunction function{echo};
};

std::vector<std::byte> pattern(std::size_t size) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 7 + i / 251);
  return out;
}

TEST_F(UsbLink, EveryByteComesBackInOrderWhateverTransfersHold) {
  for (const std::size_t most_in : {0, 1, 511, 512, 513, 5000}) {
    for (const std::size_t size : {1, 511, 512, 513, 65536, 300001}) {
      fake::bus().plug_in(function, most_in + size);
      fake::bus().faults.most_in = most_in;
      fake::bus().faults.empty = most_in == 0 ? 0.0 : 0.3;
      if (most_in == 1 && size > 1000) continue;
      auto link = open_usb({.transfers = 3, .transfer_bytes = 1024});
      ASSERT_TRUE(link) << link.error().message;
      const auto sent = pattern(size);
      ASSERT_TRUE((*link)->send(sent));
      std::vector<std::byte> got(size + 100);
      std::size_t at = 0;
      for (int calls = 0; at < size && calls < 100000; ++calls) {
        const std::size_t room = std::min<std::size_t>(got.size() - at, 1 + calls * 37 % 9000);
        const auto n = (*link)->receive(std::span(got).subspan(at, room), milliseconds(100));
        ASSERT_TRUE(n) << n.error().message;
        at += *n;
      }
      got.resize(at);
      ASSERT_EQ(got, sent) << most_in << ", " << size;
      EXPECT_EQ((*link)->receive(std::span(got).first(1), milliseconds(1)).value_or(9), 0U);
    }
  }
}

TEST_F(UsbLink, ABoardThatWantsToBeHeardIsHeardWhileItIsToldMore) {
  // The board keeps all that it was told: more than the transfers to the host hold in all.
  auto link = open_usb({.transfers = 2, .transfer_bytes = 512});
  ASSERT_TRUE(link);
  const auto sent = pattern(100000);
  ASSERT_TRUE((*link)->send(sent));
  std::vector<std::byte> got(sent.size());
  for (std::size_t at = 0; at < got.size();) {
    const auto n = (*link)->receive(std::span(got).subspan(at), milliseconds(100));
    ASSERT_TRUE(n && *n > 0);
    at += *n;
  }
  EXPECT_EQ(got, sent);
}

TEST_F(UsbLink, ABoardThatTakesNothingEndsInAnErrorInTime) {
  fake::bus().faults.stop_taking = 1;
  auto link = open_usb({.transfers = 2, .transfer_bytes = 512, .patience = milliseconds(30)});
  ASSERT_TRUE(link);
  const auto sent = (*link)->send(pattern(4096));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().kind, ErrorKind::kTimeout);
  EXPECT_NE(sent.error().message.find("has taken none of 512 bytes for 30 ms"), std::string::npos);
}

TEST_F(UsbLink, AnEndlessBoardDoesNotFillTheMemory) {
  echo.endless = true;
  fake::bus().faults.nak = 0.9;
  auto link = open_usb({.transfers = 2, .transfer_bytes = 512, .most_early_bytes = 4096});
  ASSERT_TRUE(link);
  Result<void> sent;
  for (int i = 0; i < 100000 && sent; ++i) sent = (*link)->send(pattern(512));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().kind, ErrorKind::kProtocol) << sent.error().message;
}

TEST_F(UsbLink, StallsAreClearedAndManyInARowAreAnError) {
  fake::bus().faults.stall = 0.5;
  fake::bus().faults.most = 3;
  {
    auto link = open_usb({.transfers = 2, .transfer_bytes = 512});
    ASSERT_TRUE(link);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE((*link)->send(pattern(512)));
  }
  fake::bus().plug_in(function);
  fake::bus().faults.lost = 1.0;
  auto link = open_usb({.transfers = 2, .transfer_bytes = 512});
  ASSERT_TRUE(link);
  Result<void> sent;
  int times = 0;
  for (; times < 100 && sent; ++times) sent = (*link)->send(pattern(512));
  ASSERT_FALSE(sent);
  EXPECT_LT(times, 20);
  EXPECT_EQ(sent.error().kind, ErrorKind::kTransport);
  EXPECT_NE(sent.error().message.find("8 times in a row"), std::string::npos);
}

TEST_F(UsbLink, WhatPreventsOpeningIsSaid) {
  fake::bus().claimed_elsewhere = true;
  EXPECT_NE(refusal().message.find("another program is using the board"), std::string::npos);
  {
    const auto reports = open_usb({.frames = false});  // work meanwhile
    ASSERT_TRUE(reports);
    std::array<std::byte, 8> body{};
    EXPECT_TRUE((*reports)->get_feature(7, body));
    EXPECT_FALSE((*reports)->send(body));
  }
  fake::bus().claimed_elsewhere = false;
  fake::bus().no_permission = true;
  EXPECT_NE(refusal().advice.find("70-gridrt.rules"), std::string::npos);
  fake::bus().no_permission = false;
  fake::bus().descriptor_fault = "it has no interface for frames";
  EXPECT_EQ(refusal().kind, ErrorKind::kUnsupported);
  fake::bus().descriptor_fault.clear();
  EXPECT_NE(refusal({.serial = "other"}).message.find("'other'"), std::string::npos);
  EXPECT_EQ(refusal({.transfer_bytes = 100}).kind, ErrorKind::kUsage);
  fake::bus().plugged_in = false;
  EXPECT_NE(refusal().message.find("no GridRT board is plugged in"), std::string::npos);
}

TEST_F(UsbLink, ReportsTellWhyTheyFail) {
  auto link = open_usb({});
  ASSERT_TRUE(link);
  std::array<std::byte, 63> body{};
  ASSERT_TRUE((*link)->get_feature(7, body));
  EXPECT_EQ(body[62], std::byte{0x55});
  EXPECT_EQ((*link)->get_feature(9, body).error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ((*link)->set_feature(7, body).error().kind, ErrorKind::kProtocol) << "known, refused";
  EXPECT_EQ((*link)->set_feature(9, body).error().kind, ErrorKind::kUnsupported);
  fake::bus().faults.hang_reports = 0;
  EXPECT_EQ((*link)->get_feature(7, body).error().kind, ErrorKind::kTimeout);
  fake::bus().faults.unplug = 0;
  fake::bus().plugged_in = false;
  EXPECT_NE((*link)->get_feature(7, body).error().message.find("unplugged"), std::string::npos);
  EXPECT_FALSE((*link)->read_input(body, milliseconds(1)));
}

TEST_F(UsbLink, ASleepIsToldFromAnUnpluggedCable) {
  for (const bool still_there : {false, true}) {
    fake::bus().plug_in(function);
    fake::bus().faults = {.unplug = 3, .still_there = still_there};
    auto link = open_usb({.transfers = 2, .transfer_bytes = 512});
    ASSERT_TRUE(link);
    Result<void> sent;
    for (int i = 0; i < 20 && sent; ++i) sent = (*link)->send(pattern(512));
    ASSERT_FALSE(sent);
    EXPECT_NE(sent.error().message.find(still_there ? "it is there again" : "was unplugged"),
              std::string::npos)
        << sent.error().message;
    std::array<std::byte, 8> room{};
    Result<std::size_t> got = 1;
    for (int i = 0; i < 9999 && got; ++i) got = (*link)->receive(room, milliseconds(1));
    EXPECT_FALSE(got);
  }
}

TEST(UsbMessages, EachIsInTheDocumentation) {
  std::ifstream file(GRIDRT_SOURCE "/docs/usb.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string document = text.str();
  ASSERT_FALSE(document.empty());
  namespace e = usb_error;
  const Error all[] = {e::no_board(""),
                       e::several_boards("a, b"),
                       e::no_permission("N"),
                       e::no_hid_node("1-1"),
                       e::in_use("1-1"),
                       e::unplugged(),
                       e::interrupted(),
                       e::asleep("1-1"),
                       e::not_a_board("x"),
                       e::takes_no_bytes(3, {}),
                       e::endless(3),
                       e::failing("to the board", "x", 8),
                       e::cannot_open("N", "x"),
                       e::report_timeout(1),
                       e::report_refused(1),
                       e::no_report(1),
                       e::report_failed(1, "x")};
  for (const Error& error : all) {
    // A row's first cell is a piece of the message; "N" and "..." stand for what varies.
    bool found = false;
    std::istringstream lines(document);
    for (std::string line; std::getline(lines, line) && !found;) {
      if (!line.starts_with("| ")) continue;
      std::string cell = line.substr(2, line.find(" |") - 2);
      found = true;
      for (std::size_t from = 0; found && !cell.empty();) {
        std::size_t cut = std::min(cell.find(" ... "), cell.find(" N "));
        const std::string piece = cell.substr(0, cut);
        from = error.message.find(piece, from);
        found = from != std::string::npos;
        cell = cut == std::string::npos ? "" : cell.substr(cell.find(' ', cut + 1) + 1);
      }
    }
    EXPECT_TRUE(found) << "docs/usb.md has no row for: " << error.message;
  }
}

}  // namespace
}  // namespace gridrt
