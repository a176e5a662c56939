// The firmware's logic under a hostile host and registers that lie. Every wait is bounded, nothing
// is written but registers that can be; and once the registers tell the truth again, a Reset is
// served, the status is a valid one, the image in flash and a host's image load and answer right.
#include <map>

#include "firmware/model/board_model.hpp"
#include "firmware/self_test_vectors.hpp"
#include "hal/crc32c.hpp"
#include "host/driver/flash_image.hpp"
#include "tests/fuzz/fuzz_case.hpp"

namespace {

using gridrt::Hit;
using gridrt::Query;
using gridrt::Session;
using gridrt::firmware::BoardModel;
using gridrt::fuzz::Case;
using gridrt::fuzz::Input;
using gridrt::fuzz::require;
namespace firmware = gridrt::firmware;
namespace protocol = gridrt::protocol;
namespace reg = gridrt::wire::registers;
namespace wire = gridrt::wire;

/// A flash image of the test is at most so long, for the time that an input takes.
constexpr std::uint64_t kMostFlash = std::uint64_t{1} << 17U;

/// Register accesses of what a host asks for once: the rounds of BoardModel::poll(), in each a boot
/// from the longest flash image (a word takes six) and waits that last to their ends.
constexpr std::uint64_t kMostAccesses = 16 * (6 * kMostFlash / 4 + (std::uint64_t{1} << 20U));

/// The registers as the input wants them.
class Registers {
 public:
  explicit Registers(Input& input) : input_(input) {}

  std::uint32_t read(std::uint32_t address, std::uint32_t value) {
    count(address);
    if (honest_) return value;
    const auto fixed = fixed_.find(address);
    if (fixed != fixed_.end()) return fixed->second;
    if (until_lie_-- > 0 || input_.empty()) return value;
    until_lie_ = 8 * input_.byte();
    switch (input_.byte() % 4) {
      case 0:
        return value ^ (1U << input_.byte() % 32);
      case 1:
        return ~0U;
      case 2:
        return 0;
      default:
        return input_.word();
    }
  }

  void write(std::uint32_t address, std::uint32_t /*data*/) {
    count(address);
    const auto within = [&](std::uint32_t base, std::uint32_t words) {
      return address >= base && address < base + 4 * words;
    };
    const bool is_window = std::ranges::any_of(wire::kWindows, [&](const wire::Window& window) {
      return window.writable && within(window.base, window.words);
    });
    const auto registers = {reg::Mailbox::kAnswer, reg::Mailbox::kEvent, reg::Feed::kSource,
                            reg::Feed::kData,      reg::Flash::kAddress, reg::Watch::kImage,
                            reg::Watch::kReset,    reg::Watch::kAlive,   reg::Watch::kBus};
    require(is_window || within(reg::MailboxBody::kWords, 16) ||
            within(reg::EventBody::kWords, 16) || std::ranges::count(registers, address) == 1);
  }

  /// One address reads as one value from now on.
  void fix() {
    if (fixed_.size() >= 4) fixed_.clear();
    constexpr std::uint32_t kKinds[] = {
        reg::Flash::kStatus,  reg::Flash::kData,   reg::Feed::kRoom,     reg::Feed::kAnswer,
        reg::Feed::kSource,   reg::Watch::kStuck,  reg::Watch::kBus,     reg::Mailbox::kRequest,
        reg::Mailbox::kEvent, wire::kStatusWindow, reg::Watch::kReports, reg::Watch::kLimit};
    const std::uint32_t address = kKinds[input_.byte() % std::size(kKinds)];
    fixed_[address] = input_.byte() % 2 == 0 ? ~0U : input_.word();
  }

  void begin() { accesses_ = 0; }
  void tell_the_truth() { honest_ = true; }

 private:
  void count(std::uint32_t address) {
    require(address % 4 == 0 && address < 0x1000);
    require(++accesses_ < kMostAccesses);
  }

  Input& input_;
  std::map<std::uint32_t, std::uint32_t> fixed_;
  int until_lie_ = 0;
  bool honest_ = false;
  std::uint64_t accesses_ = 0;
};

/// The flash: none, good, or changed, the CRC of its header right again.
std::vector<std::byte> make_flash(const std::vector<std::byte>& good, unsigned kind, Input& input) {
  if (kind == 0) return {};
  std::vector<std::byte> flash = good;
  if (kind == 1) return flash;
  constexpr std::size_t kHeader = protocol::FlashHeader::kBytes;
  for (int changes = 1 + input.byte() % 4; changes > 0; --changes) {
    const std::size_t bound = input.byte() % 2 == 0 ? kHeader : flash.size();
    flash[(input.byte() + 256U * input.byte()) % bound] = std::byte{input.byte()};
  }
  // Bits 17 to 23 of its length; those above make one that is refused.
  flash[wire::FlashHeader::kBytesAt + 2] &= std::byte{1};
  const auto head = std::span<const std::byte>(flash).first(kHeader - 4);
  if (kind == 2) protocol::detail::put32(flash.data() + kHeader - 4, gridrt::crc32c(head));
  return flash;
}

void act(BoardModel& board, Registers& registers, Input& input) {
  registers.begin();
  std::array<std::byte, 63> body{};
  switch (input.byte() % 12) {
    case 0:
      std::ignore = board.consume(input.take(input.byte()));
      break;
    case 1: {
      std::vector<std::byte> frame;
      const auto type = static_cast<protocol::FrameType>(input.byte() % 8);
      const auto payload = input.take(input.byte());
      require(gridrt::append_frame(frame, type, protocol::Layout::kCompact, input.byte(), payload)
                  .has_value());
      std::ignore = board.consume(frame);
      break;
    }
    case 2:
    case 3:
      std::ignore =
          board.get_feature(input.byte() % 16, std::span(body).first(1 + input.byte() % 63));
      break;
    case 4:
    case 5: {
      const std::uint8_t id = input.byte() % 16;
      std::ignore = board.set_feature(id, input.take(input.byte() % 65));
      break;
    }
    case 6: {
      const auto command = protocol::BoardCommand{static_cast<std::uint8_t>(1 + input.byte() % 2)};
      body[0] = static_cast<std::byte>(command);
      std::ignore = board.set_feature(protocol::CommandReport::kId,
                                      std::span(body).first(protocol::CommandReport::kBytes));
      break;
    }
    case 7:
      std::ignore = board.produce(body, std::chrono::milliseconds(0));
      break;
    case 8:
      std::ignore = board.take_input();
      break;
    case 9:
      switch (input.byte() % 4) {
        case 0:
          board.hang_engine();
          break;
        case 1:
          board.break_bus();
          break;
        case 2:
          board.stop_loader();
          break;
        default:
          board.silence_flash(input.byte() * 4U);
          break;
      }
      break;
    case 10:
      registers.fix();
      break;
    default:
      board.poll();
      break;
  }
}

template <class Report>
Report report(BoardModel& board) {
  std::array<std::byte, Report::kBytes> body{};
  require(board.get_feature(Report::kId, body).has_value());
  Report out;
  protocol::load(body, out);
  return out;
}

/// Whatever has happened: the board of a host in order is in order.
void recover(std::unique_ptr<BoardModel> owned, Registers& registers, const Case& c,
             bool good_flash) {
  BoardModel& board = *owned;
  registers.tell_the_truth();
  registers.begin();
  board.silence_flash(~std::size_t{0});
  board.poll();  // the watch sees what is hung
  std::array<std::byte, protocol::ResetReport::kBytes> reset{};
  protocol::store(protocol::ResetReport{.key = protocol::kResetKey}, reset);
  std::array<std::byte, protocol::CommandReport::kBytes> boot{};
  boot[0] = static_cast<std::byte>(protocol::BoardCommand::kBoot);
  // A loader that takes nothing is found out by the first boot, which resets it.
  for (int i = 0; i < 2; ++i) {
    require(board.set_feature(protocol::ResetReport::kId, reset).has_value());
    require(report<protocol::StatusReport>(board).state ==
            static_cast<std::uint8_t>(protocol::DeviceState::kEmpty));
    require(board.set_feature(protocol::CommandReport::kId, boot).has_value());
  }
  const auto status = report<protocol::StatusReport>(board);
  require(!protocol::name(static_cast<protocol::DeviceState>(status.state)).empty());
  const auto booted = report<protocol::BootReport>(board);
  require(!protocol::name(static_cast<protocol::BootState>(booted.state)).empty());
  require(!protocol::name(static_cast<protocol::BootError>(booted.error)).empty());
  if (good_flash) require(booted.resident == 1 && booted.error == 0);
  const auto test = report<protocol::SelfTestReport>(board);
  require(!protocol::name(static_cast<protocol::SelfTestState>(test.state)).empty());
  while (report<protocol::JournalReport>(board).count > 0) {
  }
  registers.begin();
  auto session = Session::open(std::make_unique<gridrt::LoopbackTransport>(std::move(owned)),
                               gridrt::fuzz::options());
  require(session.has_value());
  if (auto loaded = (*session)->load(c.image); !loaded) require(false);
  std::vector<Hit> hits(c.segments.size());
  require((*session)->trace(c.segments, Query::kClosestHit, hits).has_value());
  for (std::size_t i = 0; i < hits.size(); ++i) require(gridrt::fuzz::same(hits[i], c.closest[i]));
  if (good_flash) require((*session)->counters()->uploads == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Case c = gridrt::fuzz::make_case(protocol::Layout::kCompact);
  static const std::vector<std::byte> good =
      gridrt::flash_image(c.image, gridrt::board_capabilities()).value();
  Input input({data, size});
  const unsigned flags = input.byte();
  const unsigned kind = flags % 4;
  if ((flags & 4U) != 0) input.scatter();
  Registers registers(input);
  firmware::BoardModelOptions options{.serial = "F-1",
                                      .flash = make_flash(good, kind, input),
                                      .vectors = firmware::kSelfTestVectors};
  options.reads = [&](std::uint32_t at, std::uint32_t value) { return registers.read(at, value); };
  options.writes = [&](std::uint32_t at, std::uint32_t value) { registers.write(at, value); };
  if (input.byte() % 2 == 0) registers.fix();
  auto board = std::make_unique<BoardModel>(gridrt::fuzz::honest_device(true), options);
  for (int i = 0; i < 12 && !input.empty(); ++i) act(*board, registers, input);
  recover(std::move(board), registers, c, kind == 1);
  return 0;
}
