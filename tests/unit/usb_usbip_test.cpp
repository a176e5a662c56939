// USB/IP: messages byte by byte, and a server that is told nonsense.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/unit/usb_board.hpp"
#include "tools/virtual/listen.hpp"
#include "tools/virtual/redirection.hpp"
#include "tools/virtual/usbip.hpp"
#include "tools/virtual/usbip_messages.hpp"

namespace gridrt {
namespace {

using usbip::Urb;
using Bytes = std::vector<std::byte>;

template <std::size_t N>
std::array<std::byte, N> head(std::initializer_list<int> values) {
  std::array<std::byte, N> out{};
  std::ranges::transform(values, out.begin(), [](int v) { return static_cast<std::byte>(v); });
  return out;
}

std::array<std::byte, 48> submit(int direction, int endpoint, std::uint32_t length) {
  auto out = head<48>({0, 0, 0, 1, 0, 0, 1, 2, 0, 1, 0, 1, 0, 0, 0, direction, 0, 0, 0, endpoint});
  for (std::size_t i = 0; i < 4; ++i) out[24 + i] = static_cast<std::byte>(length >> (24 - 8 * i));
  return out;
}

TEST(UsbIpMessages, RequestsAreReadBigEndianAndTheSetupPacketLittle) {
  auto bytes = submit(1, 0, 18);
  const int setup[] = {0x80, 6, 0x00, 0x01, 0x34, 0x12, 18, 0};
  for (std::size_t i = 0; i < 8; ++i) bytes[40 + i] = static_cast<std::byte>(setup[i]);
  const auto urb = usbip::read_urb(bytes);
  ASSERT_TRUE(urb);
  EXPECT_EQ(urb->sequence, 0x102U);
  EXPECT_EQ(urb->address(), 0x80);
  EXPECT_EQ(urb->length, 18U);
  EXPECT_EQ(urb->setup.value, 0x0100);
  EXPECT_EQ(urb->setup.index, 0x1234);
  EXPECT_EQ(urb->setup.length, 18);
  EXPECT_FALSE(usbip::read_urb(submit(2, 1, 0)));
  EXPECT_FALSE(usbip::read_urb(submit(0, 16, 0)));
  EXPECT_FALSE(usbip::read_urb(submit(0, 1, usbip::kMostTransfer + 1)));
  auto unknown = submit(0, 1, 0);
  unknown[3] = std::byte{5};
  EXPECT_FALSE(usbip::read_urb(unknown));
  EXPECT_TRUE(usbip::read_operation(head<8>({1, 0x11, 0x80, 5})));
  EXPECT_FALSE(usbip::read_operation(head<8>({1, 0x10, 0x80, 5})));
  EXPECT_FALSE(usbip::read_operation(head<8>({1, 0x11, 0x80, 6})));
}

TEST(UsbIpMessages, AnswersAreAsLinuxReadsThem) {
  const Bytes list = usbip::device_list({});
  ASSERT_EQ(list.size(), 12U + 312 + 2 * 4);
  EXPECT_EQ(list[3], std::byte{5});
  EXPECT_EQ(list[11], std::byte{1});
  EXPECT_EQ(list[12 + 256], std::byte{'1'});   // bus id
  EXPECT_EQ(list[12 + 299], std::byte{3});     // high speed
  EXPECT_EQ(list[12 + 300], std::byte{0x12});  // vendor
  EXPECT_EQ(list[12 + 311], std::byte{2});     // interfaces
  bool taken = false;
  EXPECT_EQ(usbip::import_answer({}, head<32>({'1', '-', '1'}), taken).size(), 8U + 312);
  EXPECT_TRUE(taken);
  EXPECT_EQ(usbip::import_answer({}, head<32>({'1', '-', '2'}), taken).size(), 8U);
  EXPECT_FALSE(taken);
  const Urb urb{.sequence = 0x01020304, .in = true, .endpoint = 1, .length = 512};
  const auto done = usbip::submit_answer(urb, TransferState::kDone, 5);
  EXPECT_EQ(done[3], std::byte{3});
  EXPECT_EQ(done[4], std::byte{1});
  EXPECT_EQ(done[23], std::byte{0});
  EXPECT_EQ(done[27], std::byte{5});
  EXPECT_EQ(usbip::submit_answer(urb, TransferState::kStalled, 0)[23], std::byte{0xE0});  // -32
  EXPECT_EQ(usbip::unlink_answer(urb, true)[23], std::byte{0x98});                        // -104
}

/// A server on one end of a pair of sockets.
template <class Bus>
struct Served {
  Served() {
    std::array<int, 2> pair{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair.data()), 0);
    here = Socket(pair[0]);
    there = Socket(pair[1]);
    bus = std::make_unique<Bus>(function, there.file());
  }
  void write(std::span<const std::byte> bytes) {
    EXPECT_EQ(::write(here.file(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  Bytes read() {
    Bytes out(1U << 16U);
    const ssize_t got = ::read(here.file(), out.data(), out.size());
    out.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return out;
  }
  std::unique_ptr<Endpoint> board = fake::software_board(std::chrono::milliseconds(0));
  UsbFunction function{*board};
  Socket here, there;
  std::unique_ptr<Bus> bus;
};

TEST(UsbIpServer, ImportsAndServesTransfersPieceByPiece) {
  Served<UsbIp> s;
  Bytes request(40);
  std::ranges::copy(head<8>({1, 0x11, 0x80, 3}), request.begin());
  std::ranges::copy(head<3>({'1', '-', '1'}), request.begin() + 8);
  for (const std::byte b : request) {
    s.write(std::span(&b, 1));
    ASSERT_TRUE(s.bus->step({}).value_or(false));
  }
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(s.bus->step({}).value_or(false));
  EXPECT_EQ(s.read().size(), 320U);
  auto get = submit(1, 0, 18);
  const int setup[] = {0x80, 6, 0, 1, 0, 0, 18, 0};
  for (std::size_t i = 0; i < 8; ++i) get[40 + i] = static_cast<std::byte>(setup[i]);
  s.write(get);
  auto wanted = submit(1, 1, 512);  // nothing to say yet
  s.write(wanted);
  auto forget = submit(0, 0, 0);
  forget[3] = std::byte{2};
  forget[22] = std::byte{1};
  forget[23] = std::byte{2};
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(s.bus->step({}).value_or(false));
  const Bytes device = s.read();
  // The descriptor, and a stall of the pipe of a device that is not configured.
  ASSERT_EQ(device.size(), 48U + 18 + 48);
  EXPECT_EQ(device[48], std::byte{18});
  EXPECT_EQ(device[66 + 23], std::byte{0xE0});
  s.write(forget);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(s.bus->step({}).value_or(false));
  const Bytes unlinked = s.read();
  ASSERT_EQ(unlinked.size(), 48U);
  EXPECT_EQ(unlinked[3], std::byte{4});
}

template <class Bus>
void feed_noise(std::uint64_t seeds, std::span<const std::byte> beginning) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    std::mt19937_64 random(seed);
    Served<Bus> s;
    s.write(beginning);
    for (int piece = 0; piece < 20; ++piece) {
      Bytes noise(random() % 200);
      // Small numbers, so that some of it makes sense.
      for (std::byte& b : noise) b = static_cast<std::byte>(random() % (piece % 2 == 0 ? 4 : 256));
      if (::write(s.here.file(), noise.data(), noise.size()) < 0) break;
      const auto going = s.bus->step({});
      s.read();
      if (!going || !*going) break;
    }
  }
}

TEST(UsbIpServer, NoiseIsNoDanger) {
  feed_noise<UsbIp>(2000, {});
  Bytes import(40);
  std::ranges::copy(head<8>({1, 0x11, 0x80, 3}), import.begin());
  std::ranges::copy(head<3>({'1', '-', '1'}), import.begin() + 8);
  feed_noise<UsbIp>(2000, import);
}

TEST(RedirectionServer, NoiseIsNoDanger) { feed_noise<Redirection>(1000, {}); }

}  // namespace
}  // namespace gridrt
