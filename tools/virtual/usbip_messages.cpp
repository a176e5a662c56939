#include "tools/virtual/usbip_messages.hpp"

#include <algorithm>

#include "gridrt_usb.hpp"

namespace gridrt::usbip {
namespace {

constexpr std::uint16_t kVersion = 0x0111;
constexpr std::uint16_t kListAnswer = 0x0005;
constexpr std::uint16_t kImportAnswer = 0x0003;
constexpr std::uint32_t kSubmit = 1;
constexpr std::uint32_t kUnlink = 2;
constexpr std::uint32_t kSubmitAnswer = 3;
constexpr std::uint32_t kUnlinkAnswer = 4;
constexpr std::uint32_t kNoIso = 0xFFFFFFFF;
constexpr std::size_t kPathBytes = 256;
constexpr std::uint32_t kFull = 2;
constexpr std::uint32_t kHigh = 3;
// Linux's errno values, negative.
constexpr std::int32_t kStalled = -32;
constexpr std::int32_t kShutDown = -108;
constexpr std::int32_t kUnlinked = -104;

template <class Integer>
Integer get(std::span<const std::byte> bytes, std::size_t at) {
  Integer value = 0;
  for (std::size_t i = 0; i < sizeof(Integer); ++i) {
    value = static_cast<Integer>(static_cast<std::uint64_t>(value) << 8U |
                                 std::to_integer<std::uint64_t>(bytes[at + i]));
  }
  return value;
}

template <class Integer>
void put(std::span<std::byte> bytes, std::size_t at, Integer value) {
  for (std::size_t i = sizeof(Integer); i-- > 0;) {
    bytes[at + i] = static_cast<std::byte>(value & 0xFFU);
    value = static_cast<Integer>(static_cast<std::uint64_t>(value) >> 8U);
  }
}

class Writer {
 public:
  template <class Integer>
  Writer& add(Integer value) {
    bytes_.resize(bytes_.size() + sizeof(Integer));
    put(bytes_, bytes_.size() - sizeof(Integer), value);
    return *this;
  }
  Writer& add_text(std::string_view text, std::size_t bytes) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + bytes);
    for (std::size_t i = 0; i < std::min(text.size(), bytes - 1); ++i) {
      bytes_[at + i] = static_cast<std::byte>(text[i]);
    }
    return *this;
  }
  Writer& head(std::uint16_t code, std::uint32_t status) {
    return add(kVersion).add(code).add(status);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

void add_device(Writer& out, const DeviceText& device) {
  out.add_text("/sys/devices/gridrt/" + device.bus_id, kPathBytes)
      .add_text(device.bus_id, kBusIdBytes)
      .add(std::uint32_t{1})
      .add(std::uint32_t{1})
      .add(device.high_speed ? kHigh : kFull)
      .add(usb::kVendorId)
      .add(usb::kProductId)
      .add(usb::kDeviceRelease)
      .add(std::uint8_t{0})
      .add(std::uint8_t{0})
      .add(std::uint8_t{0})
      .add(static_cast<std::uint8_t>(device.configured ? usb::kConfiguration : 0))
      .add(std::uint8_t{1})
      .add(std::uint8_t{2});
}

std::array<std::byte, kUrbBytes> answer_head(std::uint32_t command, std::uint32_t sequence,
                                             std::int32_t status) {
  std::array<std::byte, kUrbBytes> out{};
  put(out, 0, command);
  put(out, 4, sequence);
  put(out, 20, static_cast<std::uint32_t>(status));
  return out;
}

}  // namespace

std::optional<Operation> read_operation(std::span<const std::byte, kOperationBytes> head) {
  if (get<std::uint16_t>(head, 0) != kVersion) return std::nullopt;
  const auto operation = static_cast<Operation>(get<std::uint16_t>(head, 2));
  if (operation != Operation::kListDevices && operation != Operation::kImport) return std::nullopt;
  return operation;
}

std::vector<std::byte> device_list(const DeviceText& device) {
  Writer out;
  out.head(kListAnswer, 0).add(std::uint32_t{1});
  add_device(out, device);
  for (const std::uint8_t kind : {std::uint8_t{0xFF}, std::uint8_t{3}}) {
    out.add(kind).add(std::uint8_t{0}).add(std::uint8_t{0}).add(std::uint8_t{0});
  }
  return out.take();
}

std::vector<std::byte> import_answer(const DeviceText& device,
                                     std::span<const std::byte, kBusIdBytes> bus_id, bool& taken) {
  std::string wanted;
  for (const std::byte b : bus_id) {
    if (b == std::byte{0}) break;
    wanted += static_cast<char>(b);
  }
  taken = wanted == device.bus_id;
  Writer out;
  out.head(kImportAnswer, taken ? 0 : 1);
  if (taken) add_device(out, device);
  return out.take();
}

std::optional<Urb> read_urb(std::span<const std::byte, kUrbBytes> head) {
  Urb urb;
  const auto command = get<std::uint32_t>(head, 0);
  urb.sequence = get<std::uint32_t>(head, 4);
  if (command == kUnlink) {
    urb.kind = Urb::Kind::kUnlink;
    urb.length = get<std::uint32_t>(head, 20);
    return urb;
  }
  const auto direction = get<std::uint32_t>(head, 12);
  const auto endpoint = get<std::uint32_t>(head, 16);
  const auto packets = get<std::uint32_t>(head, 32);
  urb.length = get<std::uint32_t>(head, 24);
  if (command != kSubmit || direction > 1 || endpoint > 15 || urb.length > kMostTransfer ||
      (packets != 0 && packets != kNoIso)) {
    return std::nullopt;
  }
  urb.in = direction == 1;
  urb.endpoint = static_cast<std::uint8_t>(endpoint);
  // The setup packet alone is little endian, as on the wire.
  const auto u8 = [&](std::size_t at) { return std::to_integer<std::uint8_t>(head[at]); };
  const auto u16 = [&](std::size_t at) {
    return static_cast<std::uint16_t>(u8(at) | u8(at + 1) << 8U);
  };
  urb.setup = {u8(40), u8(41), u16(42), u16(44), u16(46)};
  return urb;
}

std::array<std::byte, kUrbBytes> submit_answer(const Urb& urb, TransferState state,
                                               std::size_t moved) {
  const std::int32_t status = state == TransferState::kDone      ? 0
                              : state == TransferState::kStalled ? kStalled
                                                                 : kShutDown;
  auto out = answer_head(kSubmitAnswer, urb.sequence, status);
  put(out, 24, static_cast<std::uint32_t>(moved));
  return out;
}

std::array<std::byte, kUrbBytes> unlink_answer(const Urb& urb, bool was_waiting) {
  return answer_head(kUnlinkAnswer, urb.sequence, was_waiting ? kUnlinked : 0);
}

}  // namespace gridrt::usbip
